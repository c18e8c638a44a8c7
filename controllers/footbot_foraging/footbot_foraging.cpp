#include "controllers/footbot_foraging/footbot_foraging.hpp"

#include <algorithm>
#include <cmath>

#include "controllers/steering/drive.hpp"
#include "controllers/steering/nearby.hpp"

namespace tandem::controllers {
namespace {

constexpr float kBlack = 0.25F;                       // food reflects less
constexpr float kGreyLow = 0.35F, kGreyHigh = 0.65F;  // the nest reflects between these
constexpr double kAway_s = 8.0;                       // straight away from the light after leaving
constexpr double kInside_s = 2.0;                     // on into the nest, to make room for others
constexpr double kPush = 10.0;                        // weight of what is near against where it wants to go
constexpr double kDrift_rad = 0.15;                   // most that a random course turns in a step

}  // namespace

FootbotForaging::FootbotForaging(hal::Robot& robot, const Params& params)
    : proximity_(robot.sensor<hal::Proximity>()),
      light_(robot.sensor<hal::Light>()),
      ground_(robot.sensor<hal::MotorGround>()),
      clock_(robot.sensor<hal::Clock>()),
      wheels_(robot.actuator<hal::WheelSpeeds>()),
      leds_(robot.actuator<hal::RingLeds>()),
      proximity_mounts_(robot.part<hal::ProximityPart>().mounts),
      light_mounts_(robot.part<hal::LightPart>().mounts),
      beacon_(robot.part<hal::LedsPart>().beacon_led()),
      params_(params),
      random_(robot.random()) {
  robot.publish("state", state_, {"rest", "search", "bring", "give up"}, "what it does");
}

void FootbotForaging::step() noexcept {
  if (proximity_.validity != hal::Validity::Fresh || ground_.validity != hal::Validity::Fresh) {
    wheels_.set(0.0, 0.0);
    return;
  }
  switch (state_) {
    case State::Rest:
      return rest();
    case State::Search:
      return search();
    case State::Bring:
    case State::GiveUp:
      return go_home();
  }
}

void FootbotForaging::enter(State state) noexcept {
  state_ = state;
  since_ns_ = clock_.now_ns;
  inside_ns_ = -1;
  drift_rad_ = 0.0;
  leds_.set(beacon_, state == State::Bring ? hal::kGreen : state == State::Search ? hal::kBlue : hal::kBlack);
}

void FootbotForaging::rest() noexcept {
  wheels_.set(0.0, 0.0);
  if (random_.chance(params_.leave * clock_.tick_s)) enter(State::Search);
}

void FootbotForaging::search() noexcept {
  if (all_see(-1.0F, kBlack)) return enter(State::Bring);
  if (in_state_s() > params_.search_s) return enter(State::GiveUp);
  drift_rad_ = std::clamp(drift_rad_ + random_.uniform(-kDrift_rad, kDrift_rad), -0.5, 0.5);
  const hal::Vector2 light = to_light(light_, light_mounts_);
  const double brightness = hal::length_of(light);
  const bool leaving = (in_state_s() < kAway_s || all_see(kGreyLow, kGreyHigh)) && brightness > 0.0;
  if (leaving)
    walk(-light / brightness);
  else
    walk(hal::polar(1.0, drift_rad_));
}

void FootbotForaging::go_home() noexcept {
  if (all_see(kGreyLow, kGreyHigh) && inside_ns_ < 0) inside_ns_ = clock_.now_ns;
  if (inside_ns_ >= 0 && clock_.now_ns - inside_ns_ > static_cast<hal::TimeNs>(kInside_s * 1e9)) {
    params_.leave = state_ == State::Bring ? std::min(1.0, params_.leave + params_.more)
                                           : std::max(params_.least, params_.leave - params_.less);
    return enter(State::Rest);
  }
  const hal::Vector2 light = to_light(light_, light_mounts_);
  const double brightness = hal::length_of(light);
  if (brightness > 0.0)
    walk(light / brightness);
  else
    walk({1.0, 0.0});
}

/// Along a vector of length 1, but away from what is near.
void FootbotForaging::walk(const hal::Vector2& way) noexcept {
  const hal::Vector2 push = push_away(proximity_, proximity_mounts_);
  drive_towards(wheels_, hal::bearing_of(way + kPush * push), params_.velocity_m_s);
}

bool FootbotForaging::all_see(float low, float high) const noexcept {
  for (std::size_t i = 0; i < ground_.count; ++i) {
    if (ground_.reflectance[i] < low || ground_.reflectance[i] > high) return false;
  }
  return ground_.count > 0;
}

}  // namespace tandem::controllers
