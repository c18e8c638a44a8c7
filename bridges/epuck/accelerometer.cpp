#include "bridges/epuck/accelerometer.hpp"

#include <cmath>

#include "bridges/epuck/wire.hpp"

namespace tandem::bridges::epuck {
namespace {

constexpr double kGravity_m_s2 = 9.81;
constexpr int kMiddle = 2048;  // of the 12-bit converter
constexpr double kTolerance = 0.2;
constexpr int kReadings = 3;

double length_m_s2(const std::array<std::int16_t, 3>& raw, int zero) noexcept {
  const auto [x, y, z] = force_m_s2(raw, zero);
  return std::hypot(x, y, z);
}

bool is_gravity(double length_m_s2) noexcept {
  return std::fabs(length_m_s2 - kGravity_m_s2) <= kTolerance * kGravity_m_s2;
}

}  // namespace

int accelerometer_zero(Firmware firmware) noexcept {
  return firmware == Firmware::BTcom ? 0 : kMiddle;
}

std::array<double, 3> force_m_s2(const std::array<std::int16_t, 3>& raw, int zero) noexcept {
  constexpr double kScale = kGravity_m_s2 / wire::kCountsPerG;
  return {(raw[1] - zero) * kScale, (raw[0] - zero) * kScale, (raw[2] - zero) * kScale};
}

void AccelerometerCheck::reset(Firmware firmware) noexcept {
  *this = AccelerometerCheck{};
  zero_ = accelerometer_zero(firmware);
  zero_known_ = firmware != Firmware::Unknown;
}

void AccelerometerCheck::at_rest(const std::array<std::int16_t, 3>& raw) noexcept {
  at_rest_m_s2_ = length_m_s2(raw, zero_);
  if (!zero_known_ && !is_gravity(at_rest_m_s2_) && is_gravity(length_m_s2(raw, kMiddle - zero_))) {
    zero_ = kMiddle - zero_;
    at_rest_m_s2_ = length_m_s2(raw, zero_);
  }
  const Verdict seen = is_gravity(at_rest_m_s2_) ? Verdict::Believed : Verdict::Refused;
  if (seen == verdict_) {
    against_ = 0;
    return;
  }
  const bool first_good = verdict_ == Verdict::Unchecked && seen == Verdict::Believed;
  if (!first_good && ++against_ < kReadings) return;
  verdict_ = seen;
  against_ = 0;
}

}  // namespace tandem::bridges::epuck
