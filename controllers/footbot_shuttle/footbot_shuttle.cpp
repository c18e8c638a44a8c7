#include "controllers/footbot_shuttle/footbot_shuttle.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "controllers/steering/nearby.hpp"
#include "hal/angle.hpp"

namespace tandem::controllers {
namespace {

constexpr double kTurnGain_hz = 5.0;  // of what is left of a turn, a second
constexpr double kTurned_rad = 0.001;

}  // namespace

FootbotShuttle::FootbotShuttle(hal::Robot& robot, const Params& params)
    : odometry_(robot.sensor<hal::Odometry>()),
      wheels_(robot.actuator<hal::WheelSpeeds>()),
      wheel_base_m_(robot.part<hal::DifferentialDrive>().wheel_base_m),
      params_(params) {}

void FootbotShuttle::step() noexcept {
  wheels_.set(0.0, 0.0);
  if (odometry_.validity != hal::Validity::Fresh || done_ == params_.trips) return;
  if (turning_) {
    const double left_rad = hal::wrapped((home_ ? std::numbers::pi : 0.0) - odometry_.heading_rad);
    if (std::fabs(left_rad) > kTurned_rad) {
      const double most_m_s = 0.5 * params_.velocity_m_s;
      const double rim_m_s = std::clamp(0.5 * kTurnGain_hz * wheel_base_m_ * left_rad, -most_m_s, most_m_s);
      wheels_.set(-rim_m_s, rim_m_s);
      return;
    }
    turning_ = false;
    if (!home_ && ++done_ == params_.trips) return;
  }
  const bool arrived = home_ ? odometry_.x_m <= 0.0 : odometry_.x_m >= params_.distance_m;
  if (arrived) home_ = !home_;
  turning_ = arrived && !params_.reverse;
  if (arrived && params_.reverse && !home_) ++done_;
  if (arrived) return;
  const double speed_m_s = home_ && params_.reverse ? -params_.velocity_m_s : params_.velocity_m_s;
  wheels_.set(speed_m_s, speed_m_s);
}

}  // namespace tandem::controllers
