#include "mixed_reality/twin/twin.hpp"

#include <algorithm>
#include <cstring>

#include "hal/device/body_sensors.hpp"
#include "hal/unit.hpp"
#include "mixed_reality/tracking/odometry.hpp"

namespace tandem::mixed_reality {
namespace {

constexpr std::size_t kIncidentsKept = 50;

Fence arena_of(const core::Space& space) {
  const double half_x_m = 0.5 * space.arena_size_x_m();
  const double half_y_m = 0.5 * space.arena_size_y_m();
  return {space.arena_center_x_m() - half_x_m, space.arena_center_y_m() - half_y_m, space.arena_center_x_m() + half_x_m,
          space.arena_center_y_m() + half_y_m};
}

template <class Port>
bool is(const hal::PortType& type) {
  return type.role == hal::Role::Actuator && type.layout == hal::port_type<Port>().layout;
}
bool is_wheels(const hal::PortType& type) {
  return is<hal::WheelSpeeds>(type);
}

/// The clock of a twin is the run's.
const void* reading_of(bridges::RobotBridge& real, const hal::PortType& type) {
  return type.name == hal::Clock::kName ? nullptr : real.port(type);
}

}  // namespace

Twin::Twin(core::Space& space, core::RobotId robot, std::unique_ptr<bridges::RobotBridge> real,
           std::unique_ptr<PoseSource> poses, const TwinParams& params, const hal::Log& log)
    : space_(space),
      robot_(robot),
      id_(space.robot_name(robot)),
      real_(std::move(real)),
      poses_(std::move(poses)),
      params_(params),
      log_(log),
      fence_(arena_of(space)),
      fusion_(space, robot, [this](const hal::PortType& type) { return reading_of(*real_, type); }),
      real_wheels_(real_->port(hal::port_type<hal::WheelSpeeds>())),
      supervisor_(params.rearm) {
  std::size_t largest = 1;
  for (const hal::PortType* type : space.ports(robot)) {
    if (type->role != hal::Role::Actuator) continue;
    outputs_.push_back({type, space.port(robot, *type), real_->port(*type)});
    largest = std::max(largest, type->size);
  }
  safe_ = std::make_unique<std::max_align_t[]>((largest + sizeof(std::max_align_t) - 1) / sizeof(std::max_align_t));
  incidents_.reserve(kIncidentsKept);
  space_.set_external(robot_, true);
  pose_ = space_.pose(robot_);
}

void Twin::latch(const Moment& now, RunPhase phase) {
  running_ = phase == RunPhase::Running;
  real_->set_origin(now.monotonic_ns - now.run_ns);
  real_->latch(0, now.monotonic_ns);
  Conditions conditions;
  conditions.run = phase;
  conditions.operator_holds = space_.halted_by(robot_, core::HaltOwner::Operator);
  conditions.hook_holds =
      space_.halted_by(robot_, core::HaltOwner::Hook) || space_.halted_by(robot_, core::HaltOwner::Removed);
  conditions.controller_failed = space_.halted_by(robot_, core::HaltOwner::Controller);
  conditions.hub_was_frozen =
      running_ && last_latch_ns_ != 0 && now.monotonic_ns - last_latch_ns_ > params_.frozen_after_ns;
  last_latch_ns_ = now.monotonic_ns;
  conditions.link = real_->health();
  conditions.pose = track(now);
  hold(!supervisor_.judge(conditions, now.run_ns).controller_steps);
  note(now);
}

hal::Validity Twin::track(const Moment& now) noexcept {
  const TrackedPose tracked = poses_->latch(now);
  const hal::TimeNs age_ns = now.monotonic_ns - tracked.taken_ns;
  const bool fresh = tracked.known && age_ns <= params_.pose_timeout_ns;
  pose_ = tracked.pose;
  // A pose is about a tick old when it is used, and the robot has driven on: by the speeds that it was last given.
  if (fresh && space_.data_sheet(robot_).wheel_base_m > 0.0) {
    const double age_s = hal::to_seconds(age_ns);
    pose_ = rolled(pose_, sent_.left_m_s * age_s, sent_.right_m_s * age_s, space_.data_sheet(robot_).wheel_base_m);
  }
  // A twin beyond the edge would end the run as an escaped body; the fence brings the real robot back.
  space_.set_pose(robot_, fence_.clamped(pose_));
  return !tracked.known ? hal::Validity::Absent : fresh ? hal::Validity::Fresh : hal::Validity::Stale;
}

void Twin::after_sense() noexcept {
  fusion_.fuse();
}

void Twin::after_filter(const Moment& now) {
  const bool alive = supervisor_.verdict().may_drive && !space_.halted(robot_);
  if (running_) alive ? ++counts_.ticks_driving : ++counts_.ticks_held;
  send_commands(alive, now);
  real_->commit(now.monotonic_ns);
}

void Twin::send_commands(bool alive, const Moment& now) {
  sent_ = {};
  bool wheels_sent = false;
  for (const Output& output : outputs_) {
    const void* command = output.port;
    if (!alive) {
      output.type->reset(safe_.get());
      command = safe_.get();
    } else if (is_wheels(*output.type)) {
      sent_ = supervisor_.allowed(*static_cast<const hal::WheelSpeeds*>(command), now.run_ns);
      if (keep_inside(fence_, pose_, params_.fence_ahead_s, sent_)) ++counts_.fenced_ticks;
      command = &sent_;
    } else if (is<hal::QuadrotorSpeed>(*output.type)) {
      speed_ = supervisor_.allowed(*static_cast<const hal::QuadrotorSpeed*>(command), now.run_ns);
      if (keep_inside(fence_, pose_, params_.fence_ahead_s, speed_)) ++counts_.fenced_ticks;
      command = &speed_;
    } else if (is<hal::QuadrotorPosition>(*output.type)) {
      target_ = supervisor_.allowed(*static_cast<const hal::QuadrotorPosition*>(command),
                                    {pose_.x_m, pose_.y_m, pose_.z_m}, now.run_ns);
      if (keep_inside(fence_, target_)) ++counts_.fenced_ticks;
      command = &target_;
    }
    if (output.real == nullptr) continue;
    std::memcpy(output.real, command, output.type->size);
    wheels_sent = wheels_sent || is_wheels(*output.type);
  }
  // A controller without wheels leaves them where they are safe.
  if (!wheels_sent && real_wheels_ != nullptr) std::memcpy(real_wheels_, &sent_, sizeof sent_);
}

void Twin::hold(bool held) {
  if (held == held_) return;
  held_ = held;
  space_.set_halted(robot_, held, core::HaltOwner::Safety);
}

void Twin::note(const Moment& now) {
  const Verdict& verdict = supervisor_.verdict();
  if (!running_ || verdict.reason == noted_) return;
  noted_ = verdict.reason;
  std::string what = "robot '" + id_ + "' at " + hal::format_number(hal::to_seconds(now.run_ns)) +
                     " s: " + std::string(verdict.reason);
  const std::string trouble = real_->trouble();
  if (!verdict.may_drive && !trouble.empty()) what += " (" + trouble + ")";
  verdict.may_drive ? log_.info(what) : log_.warning(what);
  if (incidents_.size() < kIncidentsKept) incidents_.push_back(std::move(what));
}

TwinCounts Twin::counts() const noexcept {
  TwinCounts counts = counts_;
  counts.stops = supervisor_.stops();
  counts.rearms = supervisor_.rearms();
  return counts;
}

}  // namespace tandem::mixed_reality
