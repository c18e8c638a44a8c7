#include "controllers/eyebot_circle/eyebot_circle.hpp"

#include <algorithm>
#include <cmath>

#include "controllers/flight/calls.hpp"

namespace tandem::controllers {
namespace {

constexpr double kBack_1_s = 0.8;  // speed towards the circle, a metre that it is off
constexpr double kFastestBack_m_s = 0.5;

}  // namespace

EyebotCircle::EyebotCircle(hal::Robot& robot, const Params& params)
    : aloft_(robot),
      speed_(robot.actuator<hal::QuadrotorSpeed>()),
      leds_(robot.actuator<hal::RingLeds>()),
      call_(robot.actuator<hal::RangeAndBearingSend>()),
      params_(params) {}

void EyebotCircle::step() noexcept {
  speed_.set(0.0, 0.0, 0.0, 0.0);
  const bool ready = aloft_.ready();
  leds_.set_all(ready ? hal::kGreen : hal::kBlack);
  call_.sending = ready;
  call_.size = 1;
  call_.payload[0] = kFollowMe;
  if (!ready) return;
  const auto& p = aloft_.place().p_WB;
  const double x = p[0] - params_.center_m[0];
  const double y = p[1] - params_.center_m[1];
  const double distance_m = std::sqrt(x * x + y * y);
  const double out_x = distance_m > 1e-6 ? x / distance_m : 1.0;
  const double out_y = distance_m > 1e-6 ? y / distance_m : 0.0;
  const auto back = [](double off_m) { return std::clamp(kBack_1_s * off_m, -kFastestBack_m_s, kFastestBack_m_s); };
  // What keeps it on the circle is aimed at, too: an even speed inwards bends nothing.
  const double inwards = back(distance_m - params_.radius_m);
  const double along = params_.speed_m_s;
  speed_.set(-along * out_y - inwards * out_x, along * out_x - inwards * out_y, back(params_.center_m[2] - p[2]), 0.0);
}

}  // namespace tandem::controllers
