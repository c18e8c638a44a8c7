#include "mixed_reality/twin/twin.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "core/space/stores.hpp"
#include "hal/device/steppers.hpp"
#include "hal/device/turret.hpp"
#include "hal/rounded.hpp"
#include "hal/unit.hpp"
#include "mixed_reality/tracking/odometry.hpp"

namespace tandem::mixed_reality {
namespace {

constexpr std::size_t kIncidentsKept = 50;
constexpr std::uint64_t kManyAnswers = 200;

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

/// " at (x, y)", in m.
std::string place_text(const core::Pose& pose) {
  return " at " + hal::place_text(pose.x_m, pose.y_m);
}

/// What its controller writes, in the space.
std::vector<WantedCommand> commands_in(core::Space& space, core::RobotId robot) {
  std::vector<WantedCommand> all;
  for (const hal::PortType* type : space.ports(robot)) {
    if (type->role == hal::Role::Actuator) all.push_back({type, space.port(robot, *type)});
  }
  return all;
}

RealRobotParams real_params(const core::Space& space, core::RobotId robot, const TwinParams& params) {
  return {.rearm = params.rearm,
          .frozen_after_ns = params.frozen_after_ns,
          .ask_battery = params.ask_battery || space.port<hal::Battery>(robot) != nullptr};
}

/// The clock of a twin is the run's.
const void* reading_of(bridges::RobotBridge& real, const hal::PortType& type) {
  return type.name == hal::Clock::kName ? nullptr : real.port(type);
}

/// Speeds that the robot's wheels have when it is told these.
hal::WheelSpeeds turned(const hal::RobotKind& kind, const hal::WheelSpeeds& told) {
  const auto* const steppers = kind.part<hal::SteppersPart>();
  if (steppers == nullptr || kind.drive() == nullptr) return told;
  const double step_m = steppers->step_m(kind.drive()->wheel_radius_m);
  hal::WheelSpeeds speeds = told;
  speeds.set(steppers->turned_steps_s(told.left_m_s / step_m) * step_m,
             steppers->turned_steps_s(told.right_m_s / step_m) * step_m);
  return speeds;
}

}  // namespace

Twin::Twin(core::Space& space, core::RobotId robot, std::unique_ptr<bridges::RobotBridge> real,
           std::unique_ptr<PoseSource> poses, const TwinParams& params, const hal::Log& log)
    : space_(space),
      robot_(robot),
      id_(space.robot_name(robot)),
      robot_now_(std::move(real), commands_in(space, robot), real_params(space, robot, params)),
      poses_(std::move(poses)),
      params_(params),
      log_(log),
      fence_(arena_of(space)),
      inner_fence_(fence_.for_body(space.kind(robot).body.radius_m, space.kind(robot).body.height_m)),
      entity_(space, robot, [this](const hal::PortType& type) { return reading_of(robot_now_.bridge(), type); }),
      mechanisms_(space, robot, [this](const hal::PortType& type) { return reading_of(robot_now_.bridge(), type); }),
      told_place_(space.port<hal::Positioning>(robot) != nullptr),
      pose_(space.pose(robot)),
      smooth_(pose_) {
  incidents_.reserve(kIncidentsKept);
  const hal::RobotKind& kind = space.kind(robot);
  if (!poses_->by_wheels() && kind.drive() != nullptr) {
    const auto* encoders =
        static_cast<const hal::WheelEncoders*>(robot_now_.bridge().port(hal::port_type<hal::WheelEncoders>()));
    if (encoders != nullptr) slip_ = std::make_unique<SlipWatch>(*encoders, kind.drive()->wheel_base_m);
  }
  // Encoders that nobody takes are not asked for: slow lines have no room for them.
  if (kind.drive() != nullptr) {
    motion_ = std::make_unique<CommandedMotion>(kind.drive()->wheel_base_m);
    poses_->drives_by(*motion_);
  }
  for (const bridges::PortView& port : robot_now_.bridge().taken()) {
    if (kind.drive() == nullptr || port.type->layout != hal::port_type<hal::WheelEncoders>().layout) continue;
    encoders_ = static_cast<const hal::WheelEncoders*>(port.data);
    delay_ = std::make_unique<DelayWatch>(kind.drive()->wheel_base_m, motion_limits(kind).settle_s);
  }
  for (const bridges::PortView& port : robot_now_.bridge().taken()) {
    if (port.type->role == hal::Role::Sensor && port.type->name != hal::Clock::kName)
      readings_.push_back(static_cast<const hal::Reading*>(port.data));
  }
}

void Twin::latch(const Moment& now, RunPhase phase) {
  now_ = now;
  running_ = phase == RunPhase::Running;
  prepared_ = false;
  const hal::TimeNs before_ns = robot_now_.judged_ns();
  robot_now_.read(0, now.monotonic_ns - now.run_ns, now.monotonic_ns);
  Conditions conditions;
  conditions.run = phase;
  conditions.operator_holds = space_.halted_by(robot_, core::HaltOwner::Operator);
  conditions.hook_holds =
      space_.halted_by(robot_, core::HaltOwner::Hook) || space_.halted_by(robot_, core::HaltOwner::Removed);
  conditions.controller_failed = space_.halted_by(robot_, core::HaltOwner::Controller);
  mechanisms_.follow(before_ns == 0 ? 0.0 : hal::to_seconds(now.monotonic_ns - before_ns), entity_.state());
  entity_.fusion().latch();
  conditions.readings_missing = entity_.fusion().missing() != nullptr;
  conditions.links_swapped = std::exchange(swapped_, false);
  track(now, conditions);
  if (delay_ != nullptr) measure_delay(now);
  pose_validity_ = conditions.pose;
  entity_.state().held = !robot_now_.judge(conditions, now).controller_steps;
  if (told_place_) tell_place();
  entity_.latch();
  note(now);
}

void Twin::track(const Moment& now, Conditions& conditions) noexcept {
  const TrackedPose tracked = tracked_ = poses_->latch(now);
  pose_taken_ns_ = now.to_run(tracked.taken_ns);
  note_track();
  const hal::TimeNs age_ns = now.monotonic_ns - tracked.taken_ns;
  const bool fresh = tracked.known && !tracked.vague && age_ns <= params_.pose_timeout_ns;
  conditions.pose = !tracked.known ? hal::Validity::Absent : fresh ? hal::Validity::Fresh : hal::Validity::Stale;
  conditions.pose_jumped = poses_->jumps() != jumps_;
  jumps_ = poses_->jumps();
  conditions.pose_disputed = poses_->disputed();
  const SlipWatch::Found found = slip_ != nullptr ? slip_->judge(tracked) : SlipWatch::Found::Nothing;
  conditions.pose_jumped = conditions.pose_jumped || found == SlipWatch::Found::Moved;
  conditions.wheels_differ = found == SlipWatch::Found::Slip || poses_->slips() != slips_;
  slips_ = poses_->slips();

  // A pose is about a tick old when it is used, and the robot has driven on by what it was last told; in an outage much
  // longer, until something else stops it.
  const double age_s = hal::to_seconds(age_ns);
  const hal::TimeNs before_ns = robot_now_.judged_ns();
  const double tick_s = before_ns == 0 ? 0.0 : hal::to_seconds(now.monotonic_ns - before_ns);
  const core::Pose expected = carried_on(pose_, before_ns, std::min(tick_s, params_.coast_s - (age_s - tick_s)));
  pose_ = tracked.known ? carried_on(tracked.pose, tracked.taken_ns, std::min(age_s, params_.coast_s)) : tracked.pose;
  // A twin beyond the edge would end the run as an escaped body; the fence brings the real robot back.
  entity_.state().set_pose(fence_.clamped(running_ ? smooth_.follow(pose_, expected, tick_s) : smooth_.set(pose_)));
}

/// `pose`, which it had at `from_ns`, after so much more time of what the robot was told while it could hear, and obeys
/// as late as was found.
core::Pose Twin::carried_on(const core::Pose& pose, hal::TimeNs from_ns, double for_s) const noexcept {
  if (motion_ == nullptr || for_s <= 0.0) return pose;
  const auto until_ns = from_ns + static_cast<hal::TimeNs>(for_s * 1e9);
  return motion_->carried_on(pose, from_ns, until_ns, motion_->to_way_s(poses_->lag_s()));
}

/// A robot that obeys later than the barrier counts on is named, and counted on from now on.
void Twin::measure_delay(const Moment& now) {
  if (real().health() != LinkHealth::Active || encoders_->validity != hal::Validity::Fresh) {
    motion_->forget();
    return delay_->forget();
  }
  motion_->counted(now.to_monotonic(encoders_->taken_ns), encoders_->left_m, encoders_->right_m);
  delay_->rolled(now.to_monotonic(encoders_->taken_ns), encoders_->left_m, encoders_->right_m);
  if (const PoseMeasurement* const seen = poses_->newest_sighting(); seen != nullptr) delay_->seen(*seen);
  if (barrier_ == nullptr || !running_) return;
  const double counted_s = barrier_->latency_s();
  if (!delay_->judge(now.monotonic_ns, counted_s)) return;
  const auto ms = [](double s) { return hal::format_number(std::round(s * 1e3)) + " ms"; };
  note_incident(now,
                "it moves " + ms(delay_->delay_s()) + " after it is told to, by " + std::string(delay_->told_by()) +
                    ", not within " + ms(counted_s) + " as was counted on: others keep so much farther away",
                true);
}

void Twin::note_track() noexcept {
  track_.known = tracked_.known;
  track_.taken_ns = pose_taken_ns_;
  track_.x_m = tracked_.pose.x_m;
  track_.y_m = tracked_.pose.y_m;
  track_.z_m = tracked_.pose.z_m;
  track_.heading_rad = tracked_.pose.heading_rad();
  const double half_rad = 0.5 * track_.heading_rad;
  const std::array<double, 4> level = {std::cos(half_rad), 0.0, 0.0, std::sin(half_rad)};
  const std::array<double, 4>& q = tracked_.q_WB ? *tracked_.q_WB : level;
  for (std::size_t i = 0; i < q.size(); ++i) track_.q_WB[i] = static_cast<float>(q[i]);
  track_.sd_m = tracked_.sd_m ? static_cast<float>(*tracked_.sd_m) : TrackRow::kUnknown;
  track_.sd_rad = tracked_.sd_rad ? static_cast<float>(*tracked_.sd_rad) : TrackRow::kUnknown;
  for (std::size_t i = 0; i < track_.covariance.size(); ++i)
    track_.covariance[i] = tracked_.sd_m ? static_cast<float>(tracked_.covariance[i]) : TrackRow::kUnknown;
  track_.sent_ns = -1;
  poses_->note_learnt(track_);
  const DelayEstimate to_counters = motion_ != nullptr ? motion_->to_counters() : DelayEstimate{};
  track_.command_s = to_counters.told ? static_cast<float>(to_counters.value_s) : TrackRow::kUnknown;
  track_.command_sd_s = to_counters.told ? static_cast<float>(to_counters.bound_s / 1.96) : TrackRow::kUnknown;
}

const hal::Reading* Twin::newest_reading() const noexcept {
  const hal::Reading* newest = nullptr;
  for (const hal::Reading* reading : readings_) {
    if (reading->validity == hal::Validity::Absent) continue;
    if (newest == nullptr || reading->taken_ns > newest->taken_ns) newest = reading;
  }
  return newest;
}

void Twin::after_sense() noexcept {
  entity_.after_sense();
}

/// What a controller is told whose robot does not measure its place itself.
void Twin::tell_place() noexcept {
  TwinState& state = entity_.state();
  state.place_validity = pose_validity_;
  if (pose_validity_ == hal::Validity::Absent) return;
  const double half_rad = 0.5 * pose_.heading_rad();
  state.place_x_m = pose_.x_m;
  state.place_y_m = pose_.y_m;
  state.place_z_m = pose_.z_m;
  state.place_qw = std::cos(half_rad);
  state.place_qz = std::sin(half_rad);
  state.place_taken_ns = pose_taken_ns_;
}

bool Twin::may_move(const Moment& now) const noexcept {
  return robot_now_.may_move(now.monotonic_ns, params_.pose_timeout_ns) && !space_.halted(robot_);
}

/// Once a tick, in `offer` or where nobody is offered anything.
void Twin::prepare(const Moment& now) {
  if (prepared_) return;
  prepared_ = true;
  if (running_) look_for_intrusions(now);
  robot_now_.gate().prepare(robot_now_.supervisor(), may_move(now), &pose_, now.run_ns,
                            [this](const hal::PortType& type, void* command) { return confine(type, command); });
}

void Twin::offer(const Moment& now) {
  if (barrier_ == nullptr) return;
  const LinkHealth health = real().health();
  const bool hears = health == LinkHealth::Active || health == LinkHealth::Connecting;
  const bridges::LinkReport link = real().report();
  const bool many = link.answers >= kManyAnswers;  // else the slowest of the first few would be the 99th
  const double round_trip_s = hal::to_seconds(many ? link.p99_round_trip_ns : link.mean_round_trip_ns);
  barrier_->begin(tracked_, now.monotonic_ns, round_trip_s, delay_ != nullptr ? delay_->delay_s() : 0.0, hears);
  barrier_->look_around(space_, robot_, pose_);
  prepare(now);
  if (!hears && hal::to_seconds(now.monotonic_ns - heard_ns_) < params_.coast_s) barrier_->want(driven_);
  if (!hears || !may_move(now)) return;
  const CommandGate& gate = robot_now_.gate();
  gate.each<hal::WheelSpeeds>([this](const auto& c) { barrier_->want(c); });
  gate.each<hal::FlightTask>([this](const auto& c) { barrier_->want(c); });
  gate.each<hal::QuadrotorAttitude>([this](const auto& c) { barrier_->want(c, robot_now_.flight()); });
  gate.each<hal::QuadrotorPosition>([this](const auto& c) { barrier_->want(c, pose_); });
  gate.each<hal::QuadrotorSpeed>([this](const auto& c) { barrier_->want(c); });
}

void Twin::after_filter(const Moment& now) {
  const bool alive = may_move(now);
  if (running_) alive ? ++counts_.ticks_driving : ++counts_.ticks_held;
  prepare(now);
  if (running_ && barrier_ != nullptr) note_trespass(now);
  if (alive) counts_.fenced_ticks += robot_now_.gate().confined();
  robot_now_.send(alive, now.monotonic_ns,
                  [this](const hal::PortType& type, void* command) { hold_back(type, command); });
  sent_ = robot_now_.gate().wheels();
  const bool hears = real().health() == LinkHealth::Active;
  if (hears) driven_ = sent_;
  if (hears) heard_ns_ = now.monotonic_ns;
  const hal::RobotKind& kind = space_.kind(robot_);
  if (hears && motion_ != nullptr) motion_->told(now.monotonic_ns, turned(kind, sent_));
  if (hears && delay_ != nullptr) delay_->told(now.monotonic_ns, turned(kind, sent_));
  if (barrier_ != nullptr) {
    const bool drives_on = !hears && hal::to_seconds(now.monotonic_ns - heard_ns_) < params_.coast_s;
    barrier_->sent(now.monotonic_ns, turned(kind, drives_on ? driven_ : sent_), alive);
  }
  track_.sent_ns = now.run_ns + (now.monotonic_ns - robot_now_.judged_ns());
}

void Twin::note_trespass(const Moment& now) {
  barrier_->count();
  if (!barrier_->notes_trespass()) return;
  const Trespass& trespass = barrier_->trespass();
  const std::string depth = hal::format_number(std::round(trespass.depth_m * 1e3)) + " mm";
  const std::string area = "'" + trespass.area->id + "'";
  note_incident(now,
                (trespass.out_of_fence ? "it is " + depth + " out of the fence " + area
                                       : "it is " + depth + " deep in the keep-out " + area) +
                    place_text(tracked_.pose),
                true);
}

/// After engines have parted what they can part.
void Twin::look_for_intrusions(const Moment& now) {
  intrusion_ = intrusion_of(space_, robot_, pose_);
  if (smooth_.blending() && intrusion_.robot.valid()) intrusion_ = {};  // engines part them from where it is shown
  if (intrusion_.deep() && !intruding_) {
    ++counts_.intrusions;
    note_incident(now,
                  "its twin stands in '" + name_of(space_, intrusion_) + "', " +
                      hal::format_number(std::round(intrusion_.depth_m * 1e3)) + " mm deep" + place_text(pose_),
                  true);
  }
  intruding_ = intruding_ ? intrusion_.depth_m > 0.0 : intrusion_.deep();
}

/// What the arena's edge and virtual things leave of a command. @returns whether it led out of the arena.
bool Twin::confine(const hal::PortType& type, void* command) const noexcept {
  if (type.keep_inside == nullptr) return false;
  if (intrusion_.deep()) type.keep_out(command, pose_, intrusion_.out_x, intrusion_.out_y);
  return type.keep_inside(command, inner_fence_, pose_, params_.fence_ahead_s);
}

/// … and what keeps all real robots apart. It may turn the velocity of what flies: where that leads out of the arena,
/// it hovers.
void Twin::hold_back(const hal::PortType& type, void* command) const noexcept {
  if (barrier_ == nullptr || !barrier_->begun()) return;
  if (is<hal::FlightTask>(type)) return barrier_->apply(*static_cast<hal::FlightTask*>(command));
  if (!barrier_->changed()) return;
  if (is_wheels(type)) return barrier_->apply(*static_cast<hal::WheelSpeeds*>(command));
  if (is<hal::QuadrotorPosition>(type)) barrier_->apply(*static_cast<hal::QuadrotorPosition*>(command), pose_);
  if (is<hal::QuadrotorSpeed>(type)) barrier_->apply(*static_cast<hal::QuadrotorSpeed*>(command));
  if (type.keep_inside != nullptr && type.keep_inside(command, inner_fence_, pose_, params_.fence_ahead_s))
    type.reset(command);
}

void Twin::list(core::SpaceInputs& inputs) const {
  entity_.list(inputs);
  robot_now_.gate().for_each_sent([&](const hal::PortType& type, const void* sent) {
    inputs.rows.push_back({robot_, &type, sent, "sent"});
  });
  inputs.rows.push_back({robot_, &hal::row_type<TrackRow>(), &track_, "seen"});
  if (poses_->sightings() != nullptr)
    inputs.rows.push_back({robot_, &hal::row_type<SightingsRow>(), poses_->sightings(), "seen"});
}

void Twin::let_go() {
  entity_.state().takes_part = false;
  entity_.latch();
}

void Twin::note(const Moment& now) {
  const Verdict& verdict = robot_now_.verdict();
  if (!running_ || verdict.reason == noted_) return;
  noted_ = verdict.reason;
  const hal::PortType* missing = verdict.owner == StopOwner::Readings ? entity_.fusion().missing() : nullptr;
  note_incident(now, robot_now_.reason(missing != nullptr ? missing->name : std::string_view()), !verdict.may_drive);
}

void Twin::note_incident(const Moment& now, const std::string& what, bool serious) {
  std::string text = "robot '" + id_ + "' at " + hal::rounded(hal::to_seconds(now.run_ns)) + " s: " + what;
  serious ? log_.warning(text) : log_.info(text);
  if (incidents_.size() < kIncidentsKept) incidents_.push_back(std::move(text));
}

TwinCounts Twin::counts() const noexcept {
  TwinCounts counts = counts_;
  counts.stops = robot_now_.supervisor().stops();
  counts.rearms = robot_now_.supervisor().rearms();
  if (barrier_ != nullptr) counts.barrier = barrier_->counts();
  return counts;
}

}  // namespace tandem::mixed_reality
