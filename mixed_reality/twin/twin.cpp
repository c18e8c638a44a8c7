#include "mixed_reality/twin/twin.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/space/stores.hpp"
#include "hal/device/turret.hpp"
#include "hal/unit.hpp"
#include "mixed_reality/tracking/odometry.hpp"

namespace tandem::mixed_reality {
namespace {

constexpr std::size_t kIncidentsKept = 50;

hal::Fence arena_of(const core::Space& space) {
  const double half_x_m = 0.5 * space.arena_size_x_m();
  const double half_y_m = 0.5 * space.arena_size_y_m();
  return {space.arena_center_x_m() - half_x_m, space.arena_center_y_m() - half_y_m, space.arena_center_x_m() + half_x_m,
          space.arena_center_y_m() + half_y_m, space.stores().max_z_m};
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
      inner_fence_(fence_.for_body(space.kind(robot).body.radius_m, space.kind(robot).body.height_m)),
      fusion_(space, robot, [this](const hal::PortType& type) { return reading_of(*real_, type); }),
      mechanisms_(space, robot, [this](const hal::PortType& type) { return reading_of(*real_, type); }),
      positioning_(space.port<hal::Positioning>(robot)),
      real_wheels_(real_->port(hal::port_type<hal::WheelSpeeds>())),
      real_task_(space.kind(robot).flies() ? real_->port(hal::port_type<hal::FlightTask>()) : nullptr),
      supervisor_(params.rearm),
      battery_watch_(space.kind(robot)),
      pose_(space.pose(robot)),
      smooth_(pose_) {
  std::size_t largest = 1;
  for (const hal::PortType* type : space.ports(robot)) {
    if (type->role != hal::Role::Actuator) continue;
    outputs_.push_back({type, space.port(robot, *type), real_->port(*type)});
    largest = std::max(largest, type->size);
  }
  told_ = std::make_unique<std::max_align_t[]>((largest + sizeof(std::max_align_t) - 1) / sizeof(std::max_align_t));
  incidents_.reserve(kIncidentsKept);
  space_.set_external(robot_, true);
  const hal::RobotKind& kind = space.kind(robot);
  if (!poses_->by_wheels() && kind.drive() != nullptr) {
    const auto* encoders = static_cast<const hal::WheelEncoders*>(real_->port(hal::port_type<hal::WheelEncoders>()));
    if (encoders != nullptr) slip_ = std::make_unique<SlipWatch>(*encoders, kind.drive()->wheel_base_m);
  }
  // On a slow line only what its controller reads anyway is asked for.
  const bool asks_battery =
      kind.flies() || kind.part<hal::TurretPart>() != nullptr || space.port<hal::Battery>(robot) != nullptr;
  if (kind.flies()) flight_ = static_cast<const hal::FlightState*>(real_->port(hal::port_type<hal::FlightState>()));
  if (asks_battery) battery_ = static_cast<const hal::Battery*>(real_->port(hal::port_type<hal::Battery>()));
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
  conditions.hub_was_frozen = hub_was_frozen_ || (running_ && last_latch_ns_ != 0 &&
                                                  now.monotonic_ns - last_latch_ns_ > params_.frozen_after_ns);
  hub_was_frozen_ = false;
  conditions.guardian_gone = !guarded_;
  mechanisms_.follow(last_latch_ns_ == 0 ? 0.0 : hal::to_seconds(now.monotonic_ns - last_latch_ns_));
  conditions.robot_stopped_itself = real_->stopped_itself();
  conditions.link = real_->health();
  conditions.readings_missing = fusion_.missing() != nullptr;
  conditions.battery_low = battery_ != nullptr && battery_watch_.low(*battery_, now.monotonic_ns);
  track(now, conditions);
  pose_validity_ = conditions.pose;
  last_latch_ns_ = now.monotonic_ns;
  hold(!supervisor_.judge(conditions, now.run_ns).controller_steps);
  note(now);
}

void Twin::track(const Moment& now, Conditions& conditions) noexcept {
  const TrackedPose tracked = poses_->latch(now);
  pose_taken_ns_ = now.to_run(tracked.taken_ns);
  const hal::TimeNs age_ns = now.monotonic_ns - tracked.taken_ns;
  const bool fresh = tracked.known && age_ns <= params_.pose_timeout_ns;
  conditions.pose = !tracked.known ? hal::Validity::Absent : fresh ? hal::Validity::Fresh : hal::Validity::Stale;
  conditions.pose_jumped = poses_->jumps() != jumps_;
  jumps_ = poses_->jumps();
  conditions.wheels_differ = slip_ != nullptr && slip_->differs(tracked);

  // A pose is about a tick old when it is used, and the robot has driven on by what it was last told; in an outage much
  // longer, until something else stops it.
  const double age_s = hal::to_seconds(age_ns);
  const double tick_s = last_latch_ns_ == 0 ? 0.0 : hal::to_seconds(now.monotonic_ns - last_latch_ns_);
  const core::Pose expected = carried_on(pose_, std::min(tick_s, params_.coast_s - (age_s - tick_s)));
  pose_ = tracked.known ? carried_on(tracked.pose, std::min(age_s, params_.coast_s)) : tracked.pose;
  // A twin beyond the edge would end the run as an escaped body; the fence brings the real robot back.
  space_.set_pose(robot_, fence_.clamped(running_ ? smooth_.follow(pose_, expected, tick_s) : smooth_.set(pose_)));
}

/// `pose` after so much more time of what the robot was last told while it could hear.
core::Pose Twin::carried_on(const core::Pose& pose, double for_s) const noexcept {
  const hal::DifferentialDrive* const drive = space_.kind(robot_).drive();
  if (drive == nullptr || for_s <= 0.0) return pose;
  return rolled(pose, driven_.left_m_s * for_s, driven_.right_m_s * for_s, drive->wheel_base_m);
}

void Twin::after_sense() noexcept {
  fusion_.fuse();
  tell_place();
}

/// A robot that does not measure its place itself is told the one of its twin.
void Twin::tell_place() noexcept {
  if (positioning_ == nullptr || positioning_->validity != hal::Validity::Absent) return;
  if (pose_validity_ == hal::Validity::Absent) return;
  positioning_->p_WB = {pose_.x_m, pose_.y_m, pose_.z_m};
  const double half_rad = 0.5 * pose_.heading_rad();
  positioning_->q_WB = {std::cos(half_rad), 0.0, 0.0, std::sin(half_rad)};
  positioning_->taken_ns = pose_taken_ns_;
  positioning_->validity = pose_validity_;
}

void Twin::after_filter(const Moment& now) {
  // The verdict and the command are of the latch: a loop that was kept from running since must not send them.
  const bool of_late = now.monotonic_ns - last_latch_ns_ <= params_.pose_timeout_ns;
  const bool alive = supervisor_.verdict().may_drive && !space_.halted(robot_) && of_late;
  if (running_) alive ? ++counts_.ticks_driving : ++counts_.ticks_held;
  if (running_) look_for_intrusions(now);
  send_commands(alive, now);
  if (real_->health() == LinkHealth::Active) driven_ = sent_;
  real_->commit(now.monotonic_ns);
}

/// After engines have parted what they can part.
void Twin::look_for_intrusions(const Moment& now) {
  intrusion_ = intrusion_of(space_, robot_, pose_);
  if (smooth_.blending() && intrusion_.robot.valid()) intrusion_ = {};  // engines part them from where it is shown
  if (intrusion_.deep() && !intruding_) {
    ++counts_.intrusions;
    note_incident(now, "its twin stands in '" + name_of(space_, intrusion_) + "'", true);
  }
  intruding_ = intruding_ ? intrusion_.depth_m > 0.0 : intrusion_.deep();
}

void Twin::send_commands(bool alive, const Moment& now) {
  sent_ = {};
  bool wheels_sent = false;
  for (const Output& output : outputs_) {
    void* const told = told_.get();
    std::memcpy(told, output.port, output.type->size);
    if (is<hal::FlightTask>(*output.type)) {
      auto& task = *static_cast<hal::FlightTask*>(told);
      task = orders_.pass(task, alive, says_on_ground(flight_));
    } else if (!alive) {
      output.type->reset(told);
    } else {
      confine(*output.type, told, now);
    }
    if (is_wheels(*output.type)) sent_ = *static_cast<const hal::WheelSpeeds*>(told);
    if (output.real == nullptr) continue;
    std::memcpy(output.real, told, output.type->size);
    wheels_sent = wheels_sent || is_wheels(*output.type);
  }
  // A controller without wheels leaves them where they are safe.
  if (!wheels_sent && real_wheels_ != nullptr) std::memcpy(real_wheels_, &sent_, sizeof sent_);
  if (real_task_ != nullptr && supervisor_.verdict().land && running_) {
    hal::FlightTask landing;
    landing.order = hal::FlightOrder::Land;
    std::memcpy(real_task_, &landing, sizeof landing);
    landing_ = true;
  } else if (landing_) {
    landing_ = false;
    hal::port_type<hal::FlightTask>().reset(real_task_);  // its controller may not have taken the device
  }
}

/// Leaves of a command what the safety table, the arena's edge and virtual things leave.
void Twin::confine(const hal::PortType& type, void* command, const Moment& now) noexcept {
  supervisor_.allow(type, command, &pose_, now.run_ns);
  if (type.keep_inside == nullptr) return;
  if (intrusion_.deep()) type.keep_out(command, pose_, intrusion_.out_x, intrusion_.out_y);
  if (type.keep_inside(command, inner_fence_, pose_, params_.fence_ahead_s)) ++counts_.fenced_ticks;
}

void Twin::let_go() {
  hold(false);
  space_.set_external(robot_, false);
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
  std::string what(verdict.reason);
  const hal::PortType* missing = verdict.owner == StopOwner::Readings ? fusion_.missing() : nullptr;
  std::string trouble = missing != nullptr ? std::string(missing->name) : "";
  if (const std::string more = real_->trouble(); !more.empty()) trouble += (trouble.empty() ? "" : "; ") + more;
  if (!verdict.may_drive && !trouble.empty()) what += " (" + trouble + ")";
  note_incident(now, what, !verdict.may_drive);
}

void Twin::note_incident(const Moment& now, const std::string& what, bool serious) {
  std::string text = "robot '" + id_ + "' at " + hal::format_number(hal::to_seconds(now.run_ns)) + " s: " + what;
  serious ? log_.warning(text) : log_.info(text);
  if (incidents_.size() < kIncidentsKept) incidents_.push_back(std::move(text));
}

TwinCounts Twin::counts() const noexcept {
  TwinCounts counts = counts_;
  counts.stops = supervisor_.stops();
  counts.rearms = supervisor_.rearms();
  return counts;
}

}  // namespace tandem::mixed_reality
