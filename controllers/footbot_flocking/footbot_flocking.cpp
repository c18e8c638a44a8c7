#include "controllers/footbot_flocking/footbot_flocking.hpp"

#include <algorithm>
#include <cmath>

#include "controllers/steering/colors.hpp"
#include "hal/vector2.hpp"

namespace tandem::controllers {
namespace {

constexpr double kFarthest = 1.8;  // wanted distances: beyond the second ring of a hexagonal pattern, sqrt(3)

}  // namespace

FootbotFlocking::FootbotFlocking(hal::Robot& robot, const Params& params)
    : camera_(robot.sensor<hal::OmnidirectionalCamera>()),
      light_(robot.sensor<hal::Light>()),
      wheels_(robot.actuator<hal::WheelSpeeds>()),
      leds_(robot.actuator<hal::RingLeds>()),
      light_mounts_(robot.part<hal::LightPart>().mounts),
      beacon_(robot.part<hal::LedsPart>().beacon_led()),
      params_(params) {}

void FootbotFlocking::step() noexcept {
  leds_.set(beacon_, hal::kRed);
  if (camera_.validity != hal::Validity::Fresh || light_.validity != hal::Validity::Fresh) {
    wheels_.set(0.0, 0.0);
    return;
  }
  const hal::Vector2 sum = flock() + light();
  const double ahead = std::clamp(sum.x(), 0.0, 1.0);  // in reverse it would not see its way
  const double turn = std::clamp(0.5 * sum.y(), -0.5, 0.5) * (sum.x() < 0.0 ? 2.0 : 1.0);
  const double most = std::max(1.0, ahead + std::fabs(turn));
  wheels_.set(params_.velocity_m_s * (ahead - turn) / most, params_.velocity_m_s * (ahead + turn) / most);
}

/// Mean push and pull of the beacons in sight.
hal::Vector2 FootbotFlocking::flock() const noexcept {
  hal::Vector2 sum = hal::Vector2::Zero();
  int beacons = 0;
  for (std::size_t i = 0; i < camera_.count; ++i) {
    const double distance_m = static_cast<double>(camera_.distance_m[i]);
    if (distance_m > kFarthest * params_.distance_m) break;  // the nearest come first
    if (!is_red(camera_.color(i)) || distance_m <= 0.0) continue;
    const double bearing_rad = static_cast<double>(camera_.bearing_rad[i]);
    const double square = params_.distance_m * params_.distance_m / (distance_m * distance_m);
    const double fourth = square * square;
    const double pull = -params_.gain * (fourth * fourth - fourth);
    sum += hal::polar(pull, bearing_rad);
    ++beacons;
  }
  return beacons == 0 ? sum : hal::Vector2(sum / static_cast<double>(beacons));
}

/// The same pull however bright the light is.
hal::Vector2 FootbotFlocking::light() const noexcept {
  const hal::Vector2 way = to_light(light_, light_mounts_);
  const double brightness = hal::length_of(way);
  if (brightness <= 0.0) return hal::Vector2::Zero();
  return params_.light * way / brightness;
}

}  // namespace tandem::controllers
