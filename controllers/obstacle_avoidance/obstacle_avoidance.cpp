#include "controllers/obstacle_avoidance/obstacle_avoidance.hpp"

#include <algorithm>

namespace tandem::controllers {

ObstacleAvoidance::ObstacleAvoidance(hal::Robot& robot, const Params& params)
    : proximity_(robot.sensor<hal::Proximity>()),
      wheels_(robot.actuator<hal::WheelSpeeds>()),
      directions_(hal::ring_directions(robot.part<hal::ProximityPart>().mounts)),
      params_(params) {}

void ObstacleAvoidance::step() noexcept {
  if (proximity_.validity != hal::Validity::Fresh) {
    wheels_.set(0.0, 0.0);
    return;
  }
  double ahead = 0.0;  // the nearest thing in the way
  double side = 0.0;   // more on the left: positive
  for (std::size_t i = 0; i < proximity_.count; ++i) {
    const double closeness = static_cast<double>(proximity_.closeness(i));
    const double forward = static_cast<double>(directions_.x[i]);
    if (forward <= 0.0) continue;
    ahead = std::max(ahead, closeness * forward);
    side += closeness * static_cast<double>(directions_.y[i]);
  }
  if (ahead > params_.turn_at) {
    if (turning_ == 0.0) turning_ = side > 0.0 ? -1.0 : 1.0;
    const double spin_m_s = 0.5 * params_.cruise_m_s * turning_;
    wheels_.set(-spin_m_s, spin_m_s);
    return;
  }
  turning_ = 0.0;
  const double speed_m_s = params_.cruise_m_s * (1.0 - 0.5 * ahead);
  const double turn_m_s = std::clamp(params_.gain * side, -1.0, 1.0) * speed_m_s;
  wheels_.set(speed_m_s + turn_m_s, speed_m_s - turn_m_s);
}

}  // namespace tandem::controllers
