// Finds the bodies that may touch within a tick: those whose bounds, seen from above, overlap.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tandem::core {

/// Sweeps along x. What it finds depends on the bounds and their numbers alone, in the same order whenever they are
/// the same. Steady use allocates nothing.
class PairFinder {
 public:
  struct Pair {
    std::uint32_t first, second;  ///< first < second
  };

  /// Things numbered from `bodies` on are immovable: no two of them make a pair. Numbers may be left out.
  void clear(std::uint32_t bodies) noexcept {
    bodies_ = bodies;
    spans_.clear();
  }
  void add(std::uint32_t number, double min_x_m, double max_x_m, double min_y_m, double max_y_m) {
    spans_.push_back({min_x_m, max_x_m, min_y_m, max_y_m, number});
  }
  const std::vector<Pair>& find();

 private:
  struct Span {
    double min_x_m, max_x_m, min_y_m, max_y_m;
    std::uint32_t number;
  };
  std::uint32_t bodies_ = 0;
  std::vector<Span> spans_;
  std::vector<Pair> pairs_;
};

}  // namespace tandem::core
