#include "controllers/footbot_synchronization/footbot_synchronization.hpp"

#include "controllers/steering/colors.hpp"

namespace tandem::controllers {

FootbotSynchronization::FootbotSynchronization(hal::Robot& robot, const Params& params)
    : camera_(robot.sensor<hal::OmnidirectionalCamera>()),
      clock_(robot.sensor<hal::Clock>()),
      leds_(robot.actuator<hal::RingLeds>()),
      params_(params),
      count_(robot.random().uniform()) {}

void FootbotSynchronization::step() noexcept {
  const bool flashes = clock_.now_ns < dark_from_ns_;
  if (!flashes) leds_.set_all(hal::kBlack);
  count_ += clock_.tick_s / params_.period_s;
  if (!flashes && sees_flash()) count_ += params_.coupling * count_;
  if (count_ < 1.0) return;
  count_ = 0.0;
  dark_from_ns_ = clock_.now_ns + static_cast<hal::TimeNs>(params_.flash_s * 1e9);
  leds_.set_all(hal::kRed);
}

bool FootbotSynchronization::sees_flash() const noexcept {
  if (camera_.validity != hal::Validity::Fresh) return false;
  for (std::size_t i = 0; i < camera_.count; ++i) {
    if (is_red(camera_.color(i))) return true;
  }
  return false;
}

}  // namespace tandem::controllers
