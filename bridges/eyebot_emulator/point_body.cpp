#include "bridges/eyebot_emulator/point_body.hpp"

#include <algorithm>
#include <cmath>

#include "bridges/emulation/wheeled_body.hpp"
#include "hal/angle.hpp"
#include "hal/device/distance_scanner.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/pan_tilt.hpp"
#include "hal/device/ring_sensors.hpp"

namespace tandem::bridges::eyebot_emulator {
namespace {

using std::numbers::pi;

constexpr hal::TimeNs kStepNs = 10 * hal::kNsPerMs;
constexpr double kGravity_m_s2 = 9.81;
constexpr double kContact_m = 1e-3;  // nearer is touching

double norm(const Vec3& v) {
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/// Turned by `yaw_rad` about z, then leaned so that the body's z axis points along gravity + acceleration.
std::array<double, 4> leaning(double yaw_rad, const Vec3& a_m_s2) {
  const double c = std::cos(yaw_rad);
  const double s = std::sin(yaw_rad);
  const double lift = kGravity_m_s2 + a_m_s2[2];
  if (lift < 1.0) return {std::cos(0.5 * yaw_rad), 0.0, 0.0, std::sin(0.5 * yaw_rad)};
  const double pitch = std::atan2(c * a_m_s2[0] + s * a_m_s2[1], lift);
  const double roll = std::atan2(s * a_m_s2[0] - c * a_m_s2[1], std::hypot(lift, c * a_m_s2[0] + s * a_m_s2[1]));
  const double cy = std::cos(0.5 * yaw_rad), sy = std::sin(0.5 * yaw_rad);
  const double cp = std::cos(0.5 * pitch), sp = std::sin(0.5 * pitch);
  const double cr = std::cos(0.5 * roll), sr = std::sin(0.5 * roll);
  return {cy * cp * cr + sy * sp * sr, cy * cp * sr - sy * sp * cr, cy * sp * cr + sy * cp * sr,
          sy * cp * cr - cy * sp * sr};
}

/// A wall at `limit` takes away what is left of the motion along one axis.
bool stopped_by(double& p, double& v, double least, double most) {
  const double free = std::clamp(p, least, most);
  const bool stopped = free != p || (p == least && v < 0.0) || (p == most && v > 0.0);
  if (stopped) v = 0.0;
  p = free;
  return stopped;
}

}  // namespace

double BodySenses::yaw_rad() const noexcept {
  const auto [w, x, y, z] = q_WB;
  return std::atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z));
}

PointBody::PointBody(const Start& start, const std::optional<Room>& room)
    : room_(room), p_(start.p_WB), yaw_rad_(start.yaw_rad) {}

void PointBody::advance(hal::TimeNs now) {
  if (!at_) at_ = now;
  while (*at_ < now) {
    const hal::TimeNs until = std::min(now, *at_ + kStepNs);
    const double dt_s = hal::to_seconds(until - *at_);
    move(dt_s);
    turn_devices(dt_s);
    at_ = until;
  }
}

bool PointBody::held() const {
  return command_.magnet && room_ && top_m() >= room_->height_m - kContact_m;
}

void PointBody::move(double dt_s) {
  if (dt_s <= 0.0) return;
  const Vec3 before = v_;
  const bool was_up = p_[2] > 0.0;
  if (held()) {
    v_ = {};
  } else if (command_.motors) {
    Vec3 dv{};
    for (std::size_t i = 0; i < 3; ++i) dv[i] = command_.velocity_m_s[i] - v_[i];
    const double most = robot_part<hal::Quadrotor>().max_acceleration_m_s2 * dt_s;
    const double scale = norm(dv) > most ? most / norm(dv) : 1.0;
    for (std::size_t i = 0; i < 3; ++i) v_[i] += scale * dv[i];
    yaw_rad_ = hal::wrapped(yaw_rad_ + command_.yaw_rad_s * dt_s);
  } else {
    v_[2] -= kGravity_m_s2 * dt_s;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    p_[i] += 0.5 * (before[i] + v_[i]) * dt_s;
    a_[i] = (v_[i] - before[i]) / dt_s;
  }
  if (p_[2] <= 0.0) {
    if (was_up && v_[2] < 0.0) touched_m_s_ = -v_[2];
    p_[2] = 0.0;
    v_ = {v_[0], v_[1], std::max(0.0, v_[2])};
    if (!command_.motors || command_.velocity_m_s[2] < 0.0) v_ = {};  // it stands
    a_ = {};
  }
  if (!room_) return;
  const double free_x_m = std::max(0.0, 0.5 * room_->length_x_m - robot_part<hal::Body>().radius_m);
  const double free_y_m = std::max(0.0, 0.5 * room_->length_y_m - robot_part<hal::Body>().radius_m);
  stopped_by(p_[0], v_[0], -free_x_m, free_x_m);
  stopped_by(p_[1], v_[1], -free_y_m, free_y_m);
  if (stopped_by(p_[2], v_[2], 0.0, std::max(0.0, room_->height_m - robot_part<hal::Body>().height_m))) a_ = {};
}

void PointBody::turn_devices(double dt_s) {
  if (command_.scanner == ScannerMode::Speed) {
    const double most_rad_s = robot_part<hal::ScannerPart>().turn_rad_s;
    const double rate = std::clamp(command_.scanner_rad_s, -most_rad_s, most_rad_s);
    scanner_rad_ = hal::wrapped(scanner_rad_ + rate * dt_s);
  }
  if (command_.scanner == ScannerMode::Position) {
    scanner_rad_ = turned_towards(scanner_rad_, command_.scanner_rad, robot_part<hal::ScannerPart>().turn_rad_s * dt_s);
  }
  pan_rad_ = turned_towards(pan_rad_, command_.pan_rad, robot_part<hal::HeadPart>().turn_rad_s * dt_s);
  const double most = robot_part<hal::HeadPart>().turn_rad_s * dt_s;
  const double most_tilt = robot_part<hal::HeadPart>().max_tilt_rad;
  tilt_rad_ += std::clamp(std::clamp(command_.tilt_rad, -most_tilt, most_tilt) - tilt_rad_, -most, most);
}

double PointBody::distance_to_wall_m(double direction_rad, double offset_m) const {
  return Arena{room_->length_x_m, room_->length_y_m}.distance_m(
      p_[0] + offset_m * std::cos(direction_rad), p_[1] + offset_m * std::sin(direction_rad), direction_rad);
}

BodySenses PointBody::sense(hal::TimeNs now) {
  advance(now);
  BodySenses senses = surroundings;
  senses.p_WB = p_;
  senses.v_WB = v_;
  senses.q_WB = leaning(yaw_rad_, a_);
  senses.turn_rad_s = {0.0, 0.0, command_.motors ? command_.yaw_rad_s : 0.0};
  senses.on_ground = p_[2] <= kContact_m;
  senses.ground_m = p_[2] <= robot_part<hal::AltimeterPart>().range_m ? p_[2] : -1.0;
  senses.at_ceiling = held();
  senses.ceiling_m = -1.0;
  if (room_ && room_->height_m - top_m() <= robot_part<hal::AltimeterPart>().range_m)
    senses.ceiling_m = std::max(0.0, room_->height_m - top_m());
  senses.scanner_rad = scanner_rad_;
  senses.pan_rad = pan_rad_;
  senses.tilt_rad = tilt_rad_;
  const bool scans = command_.scanner != ScannerMode::Off;
  if (!scans) senses.scan_m.fill(std::numeric_limits<double>::infinity());
  if (!room_) return senses;
  for (std::size_t i = 0; i < senses.distance_m.size(); ++i) {
    const hal::Mount& mount = robot_part<hal::ProximityPart>().mounts[i];
    const double wall_m = distance_to_wall_m(yaw_rad_ + mount.bearing_rad, std::hypot(mount.x_m, mount.y_m));
    senses.distance_m[i] = std::min({senses.distance_m[i], wall_m, robot_part<hal::ProximityPart>().range_m});
  }
  for (std::size_t head = 0; head < senses.scan_m.size() && scans; ++head) {
    const double direction_rad = yaw_rad_ + scanner_rad_ + 0.5 * pi * static_cast<double>(head);
    senses.scan_m[head] = std::min(senses.scan_m[head], distance_to_wall_m(direction_rad, 0.0));
  }
  return senses;
}

void PointBody::actuate(hal::TimeNs now, const BodyCommand& command) {
  advance(now);
  command_ = command;
}

}  // namespace tandem::bridges::eyebot_emulator
