#include "mixed_reality/safety/ramp.hpp"

#include <algorithm>
#include <cmath>

#include "hal/filter.hpp"

namespace tandem::mixed_reality {

Ramp Ramp::after(double since_s, double ramp_m_s2) noexcept {
  return {std::max(0.0, since_s) * ramp_m_s2};
}

hal::WheelSpeeds Ramp::held_back(const hal::WheelSpeeds& wanted) const noexcept {
  const double fastest_m_s = std::max(std::fabs(wanted.left_m_s), std::fabs(wanted.right_m_s));
  const double scale = fastest_m_s > limit_m_s ? limit_m_s / fastest_m_s : 1.0;
  hal::WheelSpeeds out;
  out.set(wanted.left_m_s * scale, wanted.right_m_s * scale);
  return out;
}

hal::QuadrotorSpeed Ramp::held_back(const hal::QuadrotorSpeed& wanted) const noexcept {
  hal::QuadrotorSpeed out = wanted;
  hal::filter(out, limit_m_s, std::numeric_limits<double>::max());
  return out;
}

hal::QuadrotorPosition Ramp::held_back(const hal::QuadrotorPosition& wanted,
                                       const std::array<double, 3>& p_WB) const noexcept {
  hal::QuadrotorPosition out = wanted;
  if (wanted.hold) return out;
  double way2 = 0.0;
  for (std::size_t i = 0; i < 3; ++i) way2 += (wanted.target[i] - p_WB[i]) * (wanted.target[i] - p_WB[i]);
  const double most_m = limit_m_s * kStep_s;
  if (!(way2 > most_m * most_m)) return out;
  const double part = most_m / std::sqrt(way2);
  for (std::size_t i = 0; i < 3; ++i) out.target[i] = p_WB[i] + part * (wanted.target[i] - p_WB[i]);
  return out;
}

}  // namespace tandem::mixed_reality
