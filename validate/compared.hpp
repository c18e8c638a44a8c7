// Readings of simulated sensors, compared with their references.
#pragma once
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <string>

#include "validate/row.hpp"
#include "validate/standing.hpp"

namespace tandem::validate {

/// Readings that were compared.
struct Compared {
  std::size_t n = 0, edges = 0, wrong = 0;
  double largest = 0.0;
  void add(double difference, double most) {
    ++n;
    largest = std::max(largest, difference);
    if (!(difference <= most)) ++wrong;
  }
};

/// The things of a world, and those that are a little smaller and larger: where they differ, a ray passes by an edge.
struct Things {
  explicit Things(const core::Space& space, double grown_m)
      : exact(solids_of(space)), smaller(solids_of(space, -grown_m)), larger(solids_of(space, grown_m)) {}
  Solids exact, smaller, larger;
};

inline Row compared_row(const std::string& what, const Compared& c, double scale, const std::string& unit,
                        const std::string& contract) {
  return {{what, fmt::format("{} compared, {} at edges left out, {} differ", c.n, c.edges, c.wrong),
           fmt::format("{:.3g} {}", scale * c.largest, unit)},
          contract,
          verdict_of(c.wrong == 0 && c.n > 0)};
}

}  // namespace tandem::validate
