#include "controllers/epuck_diffusion/epuck_diffusion.hpp"

#include <cmath>

#include "hal/elementary.hpp"

namespace tandem::controllers {

EpuckDiffusion::EpuckDiffusion(hal::Robot& robot, const Params& params)
    : proximity_(robot.sensor<hal::Proximity>()),
      wheels_(robot.actuator<hal::WheelSpeeds>()),
      directions_(hal::ring_directions(robot.part<hal::ProximityPart>().mounts)),
      delta_(static_cast<float>(params.delta)),
      tan_alpha_(static_cast<float>(hal::tan(params.alpha_rad))),
      velocity_m_s_(params.velocity_m_s) {
  if (!params.talk) return;
  heard_ = &robot.sensor<hal::RangeAndBearing>();
  said_ = &robot.actuator<hal::RangeAndBearingSend>();
}

void EpuckDiffusion::step() noexcept {
  if (said_ != nullptr) said_->say(static_cast<std::uint8_t>(heard_->count));
  if (proximity_.validity != hal::Validity::Fresh) {  // blind: stand still
    wheels_.set(0.0, 0.0);
    return;
  }
  // Closeness is (range - distance) / range; the division is done once, on the sum.
  const float range_m = proximity_.range_m;
  float x = 0.0F;
  float y = 0.0F;
  for (std::size_t i = 0; i < proximity_.count; ++i) {
    const float nearness_m = range_m - proximity_.distance_m[i];
    x += nearness_m * directions_.x[i];
    y += nearness_m * directions_.y[i];
  }
  const float short_m = delta_ * range_m;
  const bool free = x * x + y * y <= short_m * short_m;  // nothing in sight is free, also with delta 0
  const bool behind = x < 0.0F && std::fabs(y) <= -x * tan_alpha_;
  if (free || behind) {
    wheels_.set(velocity_m_s_, velocity_m_s_);
  } else if (y > 0.0F) {
    wheels_.set(velocity_m_s_, 0.0);  // obstacle on the left: turn right
  } else {
    wheels_.set(0.0, velocity_m_s_);
  }
}

}  // namespace tandem::controllers
