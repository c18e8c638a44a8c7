#include "bridges/epuck/conversions.hpp"

#include <algorithm>
#include <cmath>

#include "hal/spec/epuck.hpp"

namespace tandem::bridges::epuck {
namespace {

namespace spec = hal::epuck;

double clamp_unit(double v) noexcept {
  return std::clamp(v, 0.0, 1.0);
}

double charge_at(double supply_V) noexcept {
  return clamp_unit((supply_V - spec::kBatteryEmpty_V) / (spec::kBatteryFull_V - spec::kBatteryEmpty_V));
}

// e-puck2: 12-bit converter at 3 V behind a divider of 220 and 330 kOhm [e-puck2_main-processor, battery code].
constexpr double kEpuck2VoltsPerCount = 3.0 / 4096.0 * (220.0 + 330.0) / 330.0;

}  // namespace

StepsPerS to_steps_per_s(double speed_m_s) noexcept {
  if (!std::isfinite(speed_m_s)) return {};
  const double steps =
      std::clamp(speed_m_s / spec::kMetresPerStep, -double{spec::kMaxSteps_s}, double{spec::kMaxSteps_s});
  return {static_cast<std::int16_t>(std::lround(steps))};
}

double to_m_s(StepsPerS speed) noexcept {
  return speed.value * spec::kMetresPerStep;
}

double steps_to_m(std::int64_t steps) noexcept {
  return static_cast<double>(steps) * spec::kMetresPerStep;
}

double proximity_distance_m(double counts) noexcept {
  const auto& curve = spec::kInfraredCurve;
  if (!(counts > curve.back().counts)) return curve.back().distance_m;
  if (counts >= curve.front().counts) return curve.front().distance_m;
  const auto far =
      std::find_if(curve.begin(), curve.end(), [&](const spec::InfraredKnot& k) { return k.counts <= counts; });
  const auto near = far - 1;
  const double share = (counts - far->counts) / (near->counts - far->counts);
  return far->distance_m + share * (near->distance_m - far->distance_m);
}

double proximity_counts(double distance_m) noexcept {
  const auto& curve = spec::kInfraredCurve;
  if (!(distance_m < curve.back().distance_m)) return curve.back().counts;
  if (distance_m <= curve.front().distance_m) return curve.front().counts;
  const auto far =
      std::find_if(curve.begin(), curve.end(), [&](const spec::InfraredKnot& k) { return k.distance_m >= distance_m; });
  const auto near = far - 1;
  const double share = (distance_m - near->distance_m) / (far->distance_m - near->distance_m);
  return near->counts + share * (far->counts - near->counts);
}

double light_level(std::uint16_t ambient) noexcept {
  return clamp_unit(1.0 - ambient / double{spec::kAmbientDarkRaw});
}

double ground_reflectance(std::uint16_t counts) noexcept {
  return clamp_unit(counts / double{spec::kGroundWhiteRaw});
}

double sound_level(std::uint16_t volume) noexcept {
  return clamp_unit(volume / double{spec::kMicrophoneMaxRaw});
}

BatteryState battery_state(std::uint16_t raw, Firmware firmware) noexcept {
  if (firmware == Firmware::Epuck2) {
    const double supply_V = raw * kEpuck2VoltsPerCount;
    return {supply_V, charge_at(supply_V)};
  }
  if (raw == 0) return {spec::kBatteryEmpty_V, 0.0};
  if (raw == 1) return {0.5 * (spec::kBatteryEmpty_V + spec::kBatteryFull_V), 0.5};
  constexpr double kVoltsPerCount =
      (spec::kBatteryFull_V - spec::kBatteryEmpty_V) / (spec::kBatteryFullRaw - spec::kBatteryEmptyRaw);
  const double supply_V = std::max(0.0, spec::kBatteryEmpty_V + (raw - spec::kBatteryEmptyRaw) * kVoltsPerCount);
  return {supply_V, charge_at(supply_V)};
}

}  // namespace tandem::bridges::epuck
