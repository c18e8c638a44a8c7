#include "controllers/footbot_flocking/footbot_flocking.hpp"

#include <algorithm>
#include <cmath>

#include "controllers/steering/colors.hpp"
#include "hal/elementary.hpp"
#include "hal/spec/footbot.hpp"

namespace tandem::controllers {
namespace {

constexpr double kFarthest = 1.8;  // wanted distances: beyond the second ring of a hexagonal pattern, sqrt(3)

}  // namespace

FootbotFlocking::FootbotFlocking(hal::Robot& robot, const Params& params)
    : camera_(robot.sensor<hal::OmnidirectionalCamera>()),
      light_(robot.sensor<hal::Light>()),
      wheels_(robot.actuator<hal::WheelSpeeds>()),
      leds_(robot.actuator<hal::RingLeds>()),
      light_mounts_(robot.data_sheet().light),
      params_(params) {}

void FootbotFlocking::step() noexcept {
  leds_.set(hal::footbot::kBeacon, hal::kRed);
  if (camera_.validity != hal::Validity::Fresh || light_.validity != hal::Validity::Fresh) {
    wheels_.set(0.0, 0.0);
    return;
  }
  const Vector others = flock();
  const Vector lamp = light();
  const Vector sum = {others.x + lamp.x, others.y + lamp.y};
  const double ahead = std::clamp(sum.x, 0.0, 1.0);  // in reverse it would not see its way
  const double turn = std::clamp(0.5 * sum.y, -0.5, 0.5) * (sum.x < 0.0 ? 2.0 : 1.0);
  const double most = std::max(1.0, ahead + std::fabs(turn));
  wheels_.set(params_.velocity_m_s * (ahead - turn) / most, params_.velocity_m_s * (ahead + turn) / most);
}

/// Mean push and pull of the beacons in sight.
Vector FootbotFlocking::flock() const noexcept {
  Vector sum;
  int beacons = 0;
  for (std::size_t i = 0; i < camera_.count; ++i) {
    const double distance_m = static_cast<double>(camera_.distance_m[i]);
    if (distance_m > kFarthest * params_.distance_m) break;  // the nearest come first
    if (!is_red(camera_.color(i)) || distance_m <= 0.0) continue;
    const double bearing_rad = static_cast<double>(camera_.bearing_rad[i]);
    const double square = params_.distance_m * params_.distance_m / (distance_m * distance_m);
    const double fourth = square * square;
    const double pull = -params_.gain * (fourth * fourth - fourth);
    sum.x += pull * hal::cos(bearing_rad);
    sum.y += pull * hal::sin(bearing_rad);
    ++beacons;
  }
  return beacons == 0 ? Vector{} : Vector{sum.x / beacons, sum.y / beacons};
}

/// The same pull however bright the light is.
Vector FootbotFlocking::light() const noexcept {
  const Vector way = to_light(light_, light_mounts_);
  const double brightness = way.length();
  if (brightness <= 0.0) return {};
  return {params_.light * way.x / brightness, params_.light * way.y / brightness};
}

}  // namespace tandem::controllers
