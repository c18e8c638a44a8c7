// Solvers of dynamics2d by hand.
#pragma once
#include "core/physics/dynamics2d/dynamics2d.hpp"
#include "tests/core/physics/solvers_by_hand.hpp"

namespace tandem::core {

struct FlatByHand : SolversByHand {
  explicit FlatByHand(const std::vector<Element::Attribute>& options = {}, double half_m = 20.0)
      : SolversByHand(dynamics2d_type(), options, half_m) {}
};

}  // namespace tandem::core
