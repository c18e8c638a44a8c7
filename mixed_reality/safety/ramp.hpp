// The ramp: how fast a robot may move that gets under way again.
#pragma once
#include <array>
#include <limits>

#include "hal/device/flight.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::mixed_reality {

/// One law for all that moves a robot: nothing is faster than `limit_m_s`, which grows evenly from 0. The curve driven
/// and the direction flown stay as wanted.
struct Ramp {
  double limit_m_s = std::numeric_limits<double>::infinity();

  /// The limit `since_s` after the robot was let go.
  static Ramp after(double since_s, double ramp_m_s2) noexcept;

  hal::WheelSpeeds held_back(const hal::WheelSpeeds& wanted) const noexcept;
  hal::QuadrotorSpeed held_back(const hal::QuadrotorSpeed& wanted) const noexcept;
  /// A target that is farther from `p_WB`, where the robot is, than it may come within `kStep_s` is drawn near along
  /// the line to it.
  hal::QuadrotorPosition held_back(const hal::QuadrotorPosition& wanted,
                                   const std::array<double, 3>& p_WB) const noexcept;

  /// A flying robot goes to a target about so fast that it would be there after this time (the eye-bot's controller of
  /// position closes 0.8 to 1.2 of the distance a second).
  static constexpr double kStep_s = 1.0;
};

}  // namespace tandem::mixed_reality
