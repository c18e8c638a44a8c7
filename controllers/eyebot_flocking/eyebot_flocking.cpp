#include "controllers/eyebot_flocking/eyebot_flocking.hpp"

#include <algorithm>
#include <cmath>

#include "controllers/flight/calls.hpp"
#include "hal/elementary.hpp"

namespace tandem::controllers {
namespace {

constexpr double kToldSteps_m_s = 0.02;  // of the velocities that are told
constexpr double kBack_1_s = 1.0;        // speed back to where it is to be, a metre that it is off

}  // namespace

EyebotFlocking::EyebotFlocking(hal::Robot& robot, const Params& params)
    : aloft_(robot),
      heard_(robot.sensor<hal::RangeAndBearing>()),
      speed_(robot.actuator<hal::QuadrotorSpeed>()),
      send_(robot.actuator<hal::RangeAndBearingSend>()),
      params_(params) {}

/// What the neighbours make of it, in W.
std::array<double, 3> EyebotFlocking::pull() const noexcept {
  std::array<double, 3> force{};
  std::array<double, 3> velocity{};
  const double heading_rad = aloft_.heading_rad();
  int mates = 0;
  for (std::uint32_t i = 0; i < heard_.count; ++i) {
    const std::uint8_t* message = heard_.message(i);
    if (heard_.size[i] < 4 || message[0] != kFlockMate) continue;
    ++mates;
    for (std::size_t k = 0; k < 3; ++k) velocity[k] += kToldSteps_m_s * static_cast<std::int8_t>(message[k + 1]);
    const double range_m = std::max(0.1, static_cast<double>(heard_.range_m[i]));
    const double part = params_.distance_m / range_m;
    double near = part;
    for (std::int64_t power = 1; power < params_.exponent; ++power) near *= part;
    const double towards = params_.gain_m_s * (near - near * near) * part;
    const double bearing = heading_rad + static_cast<double>(heard_.bearing_rad[i]);
    const double elevation = static_cast<double>(heard_.elevation_rad[i]);
    force[0] += towards * hal::cos(elevation) * hal::cos(bearing);
    force[1] += towards * hal::cos(elevation) * hal::sin(bearing);
    force[2] += towards * hal::sin(elevation);
  }
  for (std::size_t k = 0; k < 3 && mates > 0; ++k) force[k] += params_.alignment * velocity[k] / mates;
  return force;
}

/// Back into the band of heights, and home.
void EyebotFlocking::add_bounds(std::array<double, 3>& v) const noexcept {
  const auto& p = aloft_.place().p_WB;
  v[2] += kBack_1_s * (std::max(0.0, params_.lowest_m - p[2]) - std::max(0.0, p[2] - params_.highest_m));
  if (params_.home_radius_m <= 0.0) return;
  const double x = p[0] - params_.home_m[0];
  const double y = p[1] - params_.home_m[1];
  const double off_m = std::sqrt(x * x + y * y);
  if (off_m <= params_.home_radius_m) return;
  const double back = kBack_1_s * (off_m - params_.home_radius_m) / off_m;
  v[0] -= back * x;
  v[1] -= back * y;
}

void EyebotFlocking::tell() noexcept {
  send_.sending = true;
  send_.size = 4;
  send_.payload[0] = kFlockMate;
  for (std::size_t k = 0; k < 3; ++k) {
    const double steps = std::clamp(std::round(aloft_.state().velocity[k] / kToldSteps_m_s), -127.0, 127.0);
    send_.payload[k + 1] = static_cast<std::uint8_t>(static_cast<std::int8_t>(steps));
  }
}

void EyebotFlocking::step() noexcept {
  speed_.set(0.0, 0.0, 0.0, 0.0);
  send_.sending = false;
  if (!aloft_.ready()) return;
  tell();
  std::array<double, 3> v{};
  if (heard_.validity == hal::Validity::Fresh) v = pull();
  for (std::size_t k = 0; k < 3; ++k) v[k] += params_.drift_m_s[k];
  add_bounds(v);
  const double size = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  const double part = size > params_.speed_m_s ? params_.speed_m_s / size : 1.0;
  speed_.set(part * v[0], part * v[1], part * v[2], 0.0);
}

}  // namespace tandem::controllers
