#include "mixed_reality/twin/twin_barrier.hpp"

#include <algorithm>
#include <cmath>

#include "mixed_reality/fence/nearby.hpp"

namespace tandem::mixed_reality {

void TwinBarrier::begin(const TrackedPose& tracked, hal::TimeNs now_ns, double round_trip_s, double delay_s,
                        bool hears) noexcept {
  begun_ = true;
  rules_ = Rules::Nothing;
  robot_.placed = true;  // where it is said to start, if nobody knows better: it stands there
  robot_.pose = tracked.pose;
  robot_.pose_ns = tracked.known ? tracked.taken_ns : now_ns;
  robot_.error_m = kSigmas * tracked.sd_m.value_or(0.0);
  robot_.error_rad = tracked.sd_rad ? kSigmas * *tracked.sd_rad : kError_rad;
  robot_.latency_s = std::max({filter_.settings().latency_s, round_trip_s, delay_s});
  counts_.delay_s = delay_s;
  robot_.hears = hears;
  robot_.wanted = {};
}

void TwinBarrier::look_around(const core::Space& space, core::RobotId robot, const core::Pose& pose) noexcept {
  if (filter_.settings().avoid != core::Avoid::All) return;
  constexpr double kOthers_m_s = 0.5;  // how fast virtual ones may come
  const double horizon_s = 1.0 + robot_.latency_s + robot_.limits.settle_s;
  find_obstacles(space, robot, pose,
                 (kind_.top_speed_m_s() + kOthers_m_s) * horizon_s + robot_.error_m + filter_.settings().apart_m,
                 robot_.obstacles);
}

void TwinBarrier::want(const hal::WheelSpeeds& wheels) noexcept {
  if (kind_.drive() == nullptr) return;
  robot_.wanted = {{wheels.forward_m_s(), 0.0, 0.0},
                   (wheels.right_m_s - wheels.left_m_s) / kind_.drive()->wheel_base_m};
}

void TwinBarrier::want(const hal::FlightTask& task) noexcept {
  if (!kind_.flies() || task.order == hal::FlightOrder::Fly) return;
  rules_ = Rules::Task;
  const hal::Quadrotor& flight = *kind_.flight();
  const bool rises = task.order == hal::FlightOrder::TakeOff || task.order == hal::FlightOrder::Attach;
  const double own_m_s = rises ? flight.climb_m_s : flight.sink_m_s;
  const double speed_m_s = task.speed_m_s > 0.0 ? task.speed_m_s : own_m_s;
  robot_.wanted.velocity = {0.0, 0.0, rises ? speed_m_s : -speed_m_s};
}

void TwinBarrier::want(const hal::QuadrotorAttitude& attitude, const hal::FlightState* flight) noexcept {
  if (!kind_.flies() || rules_ != Rules::Nothing || !attitude.active) return;
  rules_ = Rules::Attitude;
  if (flight != nullptr && flight->validity == hal::Validity::Fresh) robot_.wanted.velocity = flight->velocity;
}

void TwinBarrier::want(const hal::QuadrotorPosition& position, const core::Pose& at) noexcept {
  if (!kind_.flies() || rules_ != Rules::Nothing || position.hold) return;
  rules_ = Rules::Position;
  std::array<double, 3> v = {position.target[0] - at.x_m, position.target[1] - at.y_m, position.target[2] - at.z_m};
  double speed_m_s = 0.0;
  for (double& c : v) {
    c /= hal::QuadrotorPosition::kStep_s;
    speed_m_s += c * c;
  }
  speed_m_s = std::sqrt(speed_m_s);
  const double most_m_s = kind_.flight()->max_speed_m_s;
  if (speed_m_s > most_m_s) {
    for (double& c : v) c *= most_m_s / speed_m_s;
  }
  robot_.wanted.velocity = v;
}

void TwinBarrier::want(const hal::QuadrotorSpeed& speed) noexcept {
  if (!kind_.flies() || rules_ != Rules::Nothing) return;
  rules_ = Rules::Speed;
  robot_.wanted.velocity = speed.velocity;
}

void TwinBarrier::apply(hal::WheelSpeeds& wheels) const noexcept {
  if (kind_.drive() == nullptr || !changed()) return;
  const double forward_m_s = robot_.allowed.velocity[0];
  const double half_m_s = 0.5 * (wheels.right_m_s - wheels.left_m_s);
  wheels.set(forward_m_s - half_m_s, forward_m_s + half_m_s);
}

void TwinBarrier::apply(hal::FlightTask& task) const noexcept {
  if (rules_ != Rules::Task || !changed()) return;
  if (task.order == hal::FlightOrder::TakeOff || task.order == hal::FlightOrder::Attach) task = {};  // it stays
}

void TwinBarrier::apply(hal::QuadrotorPosition& position, const core::Pose& at) const noexcept {
  if (rules_ != Rules::Position || !changed()) return;
  const std::array<double, 3>& v = robot_.allowed.velocity;
  constexpr double kStep_s = hal::QuadrotorPosition::kStep_s;
  position.set(at.x_m + v[0] * kStep_s, at.y_m + v[1] * kStep_s, at.z_m + v[2] * kStep_s, position.yaw_rad);
}

void TwinBarrier::apply(hal::QuadrotorSpeed& speed) const noexcept {
  if (rules_ == Rules::Speed && changed()) speed.velocity = robot_.allowed.velocity;
}

void TwinBarrier::sent(hal::TimeNs now_ns, const hal::WheelSpeeds& wheels, bool moved) noexcept {
  Motion motion;
  if (const hal::DifferentialDrive* const drive = kind_.drive(); drive != nullptr)
    motion = {{wheels.forward_m_s(), 0.0, 0.0}, (wheels.right_m_s - wheels.left_m_s) / drive->wheel_base_m};
  else if (moved && begun_)
    motion = robot_.allowed;
  robot_.note_sent(now_ns, motion);
  begun_ = false;
}

bool TwinBarrier::notes_trespass() noexcept {
  const double depth_m = robot_.trespass.depth_m;
  const bool begins = !trespassing_ && depth_m > kTouch_m;
  trespassing_ = trespassing_ ? depth_m > 0.0 : begins;
  counts_.trespasses += begins ? 1 : 0;
  return begins;
}

void TwinBarrier::count() noexcept {
  if (!changed()) return;
  ++counts_.changed_ticks;
  counts_.most_m_s = std::max(counts_.most_m_s, robot_.changed_m_s);
}

}  // namespace tandem::mixed_reality
