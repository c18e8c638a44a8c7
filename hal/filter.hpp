// The last look at a command before a robot, real or simulated, gets it.
#pragma once
#include <algorithm>
#include <cmath>

#include "hal/device/wheels.hpp"

namespace tandem::hal {

enum class FilterResult { Passed, Clamped, NotFinite };

/// Speeds beyond `limit_m_s` are clamped, both by the same factor so that the curve driven stays the same; a command
/// that is not finite becomes the safe one.
inline FilterResult filter(WheelSpeeds& command, double limit_m_s) noexcept {
  const double left = std::fabs(command.left_m_s);
  const double right = std::fabs(command.right_m_s);
  if (left <= limit_m_s && right <= limit_m_s) return FilterResult::Passed;  // false when either is NaN
  if (!std::isfinite(left) || !std::isfinite(right)) {
    command = WheelSpeeds{};
    return FilterResult::NotFinite;
  }
  const double scale = limit_m_s / std::max(left, right);
  command.left_m_s *= scale;
  command.right_m_s *= scale;
  return FilterResult::Clamped;
}

}  // namespace tandem::hal
