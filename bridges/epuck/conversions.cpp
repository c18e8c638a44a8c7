#include "bridges/epuck/conversions.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bridges/epuck/wire.hpp"
#include "hal/device/infrared_response.hpp"

namespace tandem::bridges::epuck {
namespace {

double clamp_unit(double v) noexcept {
  return std::clamp(v, 0.0, 1.0);
}

template <class Part>
Part part_of(const hal::RobotKind& kind) {
  const Part* const part = kind.part<Part>();
  return part != nullptr ? *part : Part{};
}

}  // namespace

Conversions::Conversions(const hal::RobotKind& kind)
    : metres_per_step_(2.0 * std::numbers::pi * part_of<hal::DifferentialDrive>(kind).wheel_radius_m /
                       wire::kStepsPerTurn),
      most_steps_s_(std::round(part_of<hal::DifferentialDrive>(kind).max_speed_m_s / metres_per_step_)),
      infrared_(part_of<hal::ProximityPart>(kind)),
      battery_(part_of<hal::BatteryPart>(kind)) {
  if (infrared_.response.empty()) infrared_.response = {{0.0, 1.0}, {infrared_.range_m, 0.0}};
}

StepsPerS Conversions::to_steps_per_s(double speed_m_s) const noexcept {
  if (!std::isfinite(speed_m_s)) return {};
  const double steps = std::clamp(speed_m_s / metres_per_step_, -most_steps_s_, most_steps_s_);
  return {static_cast<std::int16_t>(std::lround(steps))};
}

double light_level(std::uint16_t ambient) noexcept {
  return clamp_unit(1.0 - ambient / double{wire::kAmbientDarkRaw});
}

double ground_reflectance(std::uint16_t counts) noexcept {
  return clamp_unit(counts / double{wire::kGroundWhiteRaw});
}

double sound_level(std::uint16_t volume) noexcept {
  return clamp_unit(volume / double{wire::kMicrophoneMaxRaw});
}

std::array<double, 3> turn_rad_s(const std::array<std::int16_t, 3>& raw) noexcept {
  return {raw[1] * wire::kGyroRad_s, -raw[0] * wire::kGyroRad_s, raw[2] * wire::kGyroRad_s};
}

double time_of_flight_m(std::uint16_t mm, double range_m) noexcept {
  return std::min(mm * 1e-3, range_m);
}

double Conversions::charge_at(double supply_V) const noexcept {
  const double span_V = battery_.full_V - battery_.empty_V;
  return span_V > 0.0 ? clamp_unit((supply_V - battery_.empty_V) / span_V) : 0.0;
}

BatteryState Conversions::battery_state(std::uint16_t raw, Firmware firmware) const noexcept {
  if (firmware == Firmware::Epuck2) {
    const double supply_V = raw * wire::kEpuck2VoltsPerCount;
    return {supply_V, charge_at(supply_V)};
  }
  if (raw == 0) return {battery_.empty_V, 0.0};
  if (raw == 1) return {0.5 * (battery_.empty_V + battery_.full_V), 0.5};
  constexpr double kVoltsPerCount = (4.2 - 3.4) / (wire::kBatteryRawAt4_2V - wire::kBatteryRawAt3_4V);
  const double supply_V = std::max(0.0, 3.4 + (raw - wire::kBatteryRawAt3_4V) * kVoltsPerCount);
  return {supply_V, charge_at(supply_V)};
}

}  // namespace tandem::bridges::epuck
