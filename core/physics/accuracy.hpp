// Accuracy of the physics of a run.
#pragma once
#include <algorithm>
#include <cstdint>

namespace tandem::core {

/// The largest errors that engines left since the start of the run; 0 of what they have none of.
struct PhysicsAccuracy {
  /// By which velocities were off what contacts, joints and drives ask for at the end of a sub-step.
  double constraint_error_m_s = 0.0;
  std::uint64_t unsolved_sub_steps = 0;  ///< whose error is larger than was asked for, after the most passes
  double overlap = 0.0;  ///< of two robots at the end of a tick, in parts of the narrower one's diameter

  void add(const PhysicsAccuracy& other) noexcept {
    constraint_error_m_s = std::max(constraint_error_m_s, other.constraint_error_m_s);
    unsolved_sub_steps += other.unsolved_sub_steps;
    overlap = std::max(overlap, other.overlap);
  }
};

}  // namespace tandem::core
