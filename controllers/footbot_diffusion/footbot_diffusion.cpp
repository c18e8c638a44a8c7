#include "controllers/footbot_diffusion/footbot_diffusion.hpp"

#include <cmath>

#include "hal/elementary.hpp"

namespace tandem::controllers {
namespace {

constexpr std::size_t kLanes = 8;  // that are added up side by side; sums are then the same with and without AVX

struct Vector {
  float x = 0.0F, y = 0.0F;
};

/// Sum of what each sensor lacks to its range, as a vector along the sensor. Entries that no sensor has look nowhere.
Vector sum(const hal::Proximity& proximity, const hal::RingDirections& look) noexcept {
  static_assert(hal::RingDirections::kCapacity % kLanes == 0 &&
                hal::RingDirections::kCapacity == hal::Proximity::kCapacity);
  std::array<float, kLanes> x{}, y{};
  for (std::size_t i = 0; i < hal::RingDirections::kCapacity; i += kLanes) {
    for (std::size_t k = 0; k < kLanes; ++k) {
      const float near_m = proximity.range_m - proximity.distance_m[i + k];
      x[k] += near_m * look.x[i + k];
      y[k] += near_m * look.y[i + k];
    }
  }
  Vector all;
  for (std::size_t k = 0; k < kLanes; ++k) {
    all.x += x[k];
    all.y += y[k];
  }
  return all;
}

}  // namespace

FootbotDiffusion::FootbotDiffusion(hal::Robot& robot, const Params& params)
    : proximity_(robot.sensor<hal::Proximity>()),
      wheels_(robot.actuator<hal::WheelSpeeds>()),
      directions_(hal::ring_directions(robot.part<hal::ProximityPart>().mounts)),
      delta_(static_cast<float>(params.delta)),
      tan_alpha_(static_cast<float>(hal::tan(params.alpha_rad))),
      velocity_m_s_(params.velocity_m_s) {
  if (!params.talk && !params.look) return;
  Company company;
  if (params.talk) {
    company.heard = &robot.sensor<hal::RangeAndBearing>();
    company.said = &robot.actuator<hal::RangeAndBearingSend>();
  }
  if (params.look) {
    company.seen = &robot.sensor<hal::OmnidirectionalCamera>();
    company.leds = &robot.actuator<hal::RingLeds>();
  }
  company_.reset(new Company(company));
}

void FootbotDiffusion::Company::step() const noexcept {
  if (said != nullptr) said->say(static_cast<std::uint8_t>(heard->count));
  if (leds != nullptr) leds->set_all(seen->count == 0 ? hal::kRed : hal::kGreen);
}

void FootbotDiffusion::step() noexcept {
  if (company_ != nullptr) company_->step();
  if (proximity_.validity != hal::Validity::Fresh) {  // blind: stand still
    wheels_.set(0.0, 0.0);
    return;
  }
  const Vector near = sum(proximity_, directions_);
  const float free_m = delta_ * proximity_.range_m * static_cast<float>(proximity_.count);
  const bool free = near.x * near.x + near.y * near.y <= free_m * free_m;
  const bool behind = near.x < 0.0F && std::fabs(near.y) <= -near.x * tan_alpha_;
  if (free || behind) {
    turning_ = 0;
    wheels_.set(velocity_m_s_, velocity_m_s_);
    return;
  }
  if (turning_ == 0) turning_ = near.y > 0.0F ? -1 : 1;  // obstacle on the left: turn right
  wheels_.set(-turning_ * velocity_m_s_, turning_ * velocity_m_s_);
}

}  // namespace tandem::controllers
