#include "bridges/eyebot_emulator/pilot.hpp"

#include <algorithm>
#include <cmath>

#include "hal/angle.hpp"

namespace tandem::bridges::eyebot_emulator {
namespace {

constexpr double kPull_per_s = 2.0;      // speed for a distance, near the target
constexpr double kTurn_per_s = 3.0;      // turn rate for an angle
constexpr double kBraking = 0.5;         // of the greatest acceleration: room for what the body is late
constexpr double kFenceMargin_m = 0.05;  // hovering at the fence is hovering inside

double norm(const Vec3& v) {
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

Vec3 scaled(const Vec3& v, double factor) {
  return {factor * v[0], factor * v[1], factor * v[2]};
}

Vec3 limited(const Vec3& v, double most) {
  return norm(v) > most ? scaled(v, most / norm(v)) : v;
}

Vec3 turned(const Vec3& v, double yaw_rad) {
  const double c = std::cos(yaw_rad);
  const double s = std::sin(yaw_rad);
  return {c * v[0] - s * v[1], s * v[0] + c * v[1], v[2]};
}

bool is_frame(std::int8_t frame) {
  return frame == static_cast<std::int8_t>(Frame::World) || frame == static_cast<std::int8_t>(Frame::Body);
}

Answer no_frame(std::int8_t frame) {
  return {Verdict::RejectedRange, "there is no frame " + std::to_string(frame)};
}

}  // namespace

bool Fence::contains(const Vec3& p_W) const noexcept {
  return std::fabs(p_W[0]) <= half_x_m && std::fabs(p_W[1]) <= half_y_m && p_W[2] <= top_m;
}

Vec3 Fence::nearest_inside(const Vec3& p_W, double margin_m) const noexcept {
  const double x_m = std::max(0.0, half_x_m - margin_m);
  const double y_m = std::max(0.0, half_y_m - margin_m);
  return {std::clamp(p_W[0], -x_m, x_m), std::clamp(p_W[1], -y_m, y_m), std::min(p_W[2], top_m - margin_m)};
}

Answer Pilot::go_to(const PositionCommand& command, const BodySenses& here) {
  if (!is_frame(command.frame)) return no_frame(command.frame);
  Vec3 target = command.pos;
  double yaw_rad = command.yaw;
  if (command.frame == static_cast<std::int8_t>(Frame::Body)) {
    target = turned(command.pos, here.yaw_rad());
    for (std::size_t i = 0; i < 3; ++i) target[i] += here.p_WB[i];
    yaw_rad += here.yaw_rad();
  }
  if (!fence_.contains(target)) return {Verdict::RejectedRange, "the place is outside of the fence"};
  target_ = target;
  yaw_rad_ = command.use_yaw ? std::optional(yaw_rad) : std::nullopt;
  most_m_s_ = robot_part<hal::Quadrotor>().max_speed_m_s;
  if (command.max_speed > 0.0F) most_m_s_ = std::min(most_m_s_, static_cast<double>(command.max_speed));
  return {};
}

Answer Pilot::fly(const VelocityCommand& command) {
  if (!is_frame(command.frame)) return no_frame(command.frame);
  velocity_ = command;
  return {};
}

void Pilot::stay(const BodySenses& here) {
  Vec3 rest = here.p_WB;
  const double stopping_s = 0.5 * norm(here.v_WB) / (kBraking * robot_part<hal::Quadrotor>().max_acceleration_m_s2);
  for (std::size_t i = 0; i < 3; ++i) rest[i] += stopping_s * here.v_WB[i];
  target_ = fence_.nearest_inside(rest, kFenceMargin_m);
  yaw_rad_.reset();
  most_m_s_ = robot_part<hal::Quadrotor>().max_speed_m_s;
}

Guidance Pilot::towards_target(const BodySenses& here) const {
  Guidance guidance;
  Vec3 way{};
  for (std::size_t i = 0; i < 3; ++i) way[i] = target_[i] - here.p_WB[i];
  const double distance_m = norm(way);
  const double can_stop_m_s =
      std::sqrt(2.0 * kBraking * robot_part<hal::Quadrotor>().max_acceleration_m_s2 * distance_m);
  const double speed_m_s = std::min({kPull_per_s * distance_m, can_stop_m_s, most_m_s_});
  if (distance_m > 0.0) guidance.velocity_m_s = scaled(way, speed_m_s / distance_m);
  if (yaw_rad_) {
    const double turn_rad = hal::turn_between(here.yaw_rad(), *yaw_rad_);
    guidance.yaw_rad_s = std::clamp(kTurn_per_s * turn_rad, -robot_part<hal::Quadrotor>().max_turn_rad_s,
                                    robot_part<hal::Quadrotor>().max_turn_rad_s);
  }
  return guidance;
}

Guidance Pilot::guide(const Supervisor& supervisor, const BodySenses& here) const {
  const double vertical_m_s = std::min(supervisor.speed_m_s(), robot_part<hal::Quadrotor>().max_speed_m_s);
  switch (supervisor.mode()) {
    case Mode::TakeOff:
    case Mode::Attaching:
      return {{0.0, 0.0, vertical_m_s}, 0.0};
    case Mode::Land:
    case Mode::Detaching:
      return {{0.0, 0.0, -vertical_m_s}, 0.0};
    case Mode::Hover:
    case Mode::Position:
      return towards_target(here);
    case Mode::Velocity: {
      const bool body = velocity_.frame == static_cast<std::int8_t>(Frame::Body);
      const Vec3 v = body ? turned(velocity_.vel, here.yaw_rad()) : velocity_.vel;
      return {limited(v, robot_part<hal::Quadrotor>().max_speed_m_s),
              std::clamp(velocity_.yaw_rate, -robot_part<hal::Quadrotor>().max_turn_rad_s,
                         robot_part<hal::Quadrotor>().max_turn_rad_s)};
    }
    case Mode::Off:
    case Mode::Idle:
    case Mode::Attached:
    case Mode::Estop:
      break;
  }
  return {};
}

}  // namespace tandem::bridges::eyebot_emulator
