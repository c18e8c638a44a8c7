#include "controllers/footbot_follow/footbot_follow.hpp"

#include <algorithm>
#include <cmath>

#include "controllers/flight/calls.hpp"
#include "controllers/steering/drive.hpp"
#include "controllers/steering/nearby.hpp"
#include "hal/elementary.hpp"
#include "hal/vector2.hpp"

namespace tandem::controllers {
namespace {

constexpr double kSlowDown_1_s = 0.8;  // speed, a metre that is left
constexpr double kAvoid = 12.0;        // weight of the mean of what is near against the unit vector ahead

/// Number of the nearest message that calls, or the count of all.
std::uint32_t caller(const hal::RangeAndBearing& heard) noexcept {
  for (std::uint32_t i = 0; i < heard.count; ++i) {
    if (heard.size[i] > 0 && heard.message(i)[0] == kFollowMe) return i;
  }
  return heard.count;
}

}  // namespace

FootbotFollow::FootbotFollow(hal::Robot& robot, const Params& params)
    : heard_(robot.sensor<hal::RangeAndBearing>()),
      proximity_(robot.sensor<hal::Proximity>()),
      wheels_(robot.actuator<hal::WheelSpeeds>()),
      leds_(robot.actuator<hal::RingLeds>()),
      mounts_(robot.part<hal::ProximityPart>().mounts),
      beacon_(robot.part<hal::LedsPart>().beacon_led()),
      params_(params) {}

void FootbotFollow::step() noexcept {
  wheels_.set(0.0, 0.0);
  leds_.set_all(hal::kBlack);
  if (heard_.validity != hal::Validity::Fresh || proximity_.validity != hal::Validity::Fresh) return;
  const std::uint32_t who = caller(heard_);
  if (who == heard_.count) return;
  leds_.set(beacon_, hal::kGreen);
  const double range_m = static_cast<double>(heard_.range_m[who]);
  const double along_m = range_m * hal::cos(static_cast<double>(heard_.elevation_rad[who])) - params_.keep_m;
  if (along_m <= 0.0) return;
  const double bearing_rad = static_cast<double>(heard_.bearing_rad[who]);
  const hal::Vector2 way = hal::polar(1.0, bearing_rad) + kAvoid * push_away(proximity_, mounts_);
  drive_towards(wheels_, hal::bearing_of(way), std::min(params_.speed_m_s, kSlowDown_1_s * along_m + 0.01));
}

}  // namespace tandem::controllers
