#include "mixed_reality/session/mixed_session.hpp"

#include <algorithm>
#include <system_error>
#include <thread>

#include "hal/unit.hpp"
#include "mixed_reality/settings/timeouts.hpp"
#include "mixed_reality/settings/tracker_check.hpp"
#include "mixed_reality/tracking/fused_pose.hpp"
#include "mixed_reality/tracking/odometry.hpp"
#include "mixed_reality/tracking/positioned.hpp"

namespace tandem::mixed_reality {
namespace {

// Two ticks that lie farther apart than a tick and this: guardians have stopped the robots meanwhile.
constexpr hal::TimeNs kFrozenAfter_ns = 500 * hal::kNsPerMs;
constexpr hal::TimeNs kLookEvery_ns = 10 * hal::kNsPerMs;  // for an emergency stop
constexpr hal::TimeNs kPollEvery_ns = 20 * hal::kNsPerMs;  // while waiting for robots

const std::atomic<bool> kNever{false};

hal::Error about(const core::RobotItem& item, const std::string& file, const std::string& what) {
  return hal::Error{file + ":" + std::to_string(item.bridge->line) + ": error: robot '" + item.id + "': " + what};
}

Trackers::Arena arena_of(const core::Space& space) {
  const double x_m = 0.5 * space.arena_size_x_m(), y_m = 0.5 * space.arena_size_y_m();
  return {space.arena_center_x_m() - x_m, space.arena_center_y_m() - y_m, space.arena_center_x_m() + x_m,
          space.arena_center_y_m() + y_m};
}

template <class Port>
const Port* port_of(bridges::RobotBridge& real) {
  return static_cast<const Port*>(real.port(hal::port_type<Port>()));
}

}  // namespace

// --- making one ---

hal::Result<std::unique_ptr<MixedSession>> MixedSession::make(std::unique_ptr<core::World> world,
                                                              const BridgeMaker& make_bridge, TimeSource& time,
                                                              const MixedOptions& options) {
  std::unique_ptr<MixedSession> session(new MixedSession(std::move(world), time, options));
  session->make_bridge_ = make_bridge;
  session->paused_ = options.hold;
  if (const hal::Status added = session->add_trackers(); !added.ok()) return added.error();
  for (const core::RobotItem& item : session->world_->scenario().robots) {
    if (!item.bridge) continue;
    if (const hal::Status added = session->add_twin(item); !added.ok()) return added.error();
  }
  const std::size_t count = session->twins_.size();
  for (std::size_t i = 0; i < count; ++i) {
    session->last_.emplace_back();
    session->last_.back().device = session->twins_[i]->id();
  }
  session->confirmed_.assign(count, 0);
  session->inputs_.rows.push_back({{}, &hal::row_type<ClockRow>(), &session->clock_, "time"});
  for (const auto& twin : session->twins_) twin->list(session->inputs_);
  session->times_.resize(count);
  session->ledger_rows_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    session->times_[i].row = i;
    session->ledger_robots_.push_back(session->twins_[i]->robot());
  }
  session->world_->set_external(session.get());
  return session;
}

MixedSession::MixedSession(std::unique_ptr<core::World> world, TimeSource& time, const MixedOptions& options)
    : world_(std::move(world)),
      time_(time),
      options_(options),
      pacer_(time, world_->ticks_per_second()),
      trackers_(arena_of(world_->space()), options.unix_clock),
      barrier_(world_->scenario().safety, hal::time_of_tick(1, world_->ticks_per_second())) {}

hal::Status MixedSession::add_trackers() {
  const core::Scenario& scenario = world_->scenario();
  for (const core::TrackerItem& item : scenario.trackers) {
    bridges::MadeTracker made = options_.make_tracker ? options_.make_tracker(item)
                                                      : bridges::MadeTracker(hal::Error{"nobody makes trackers here"});
    if (!made.ok())
      return hal::Error{scenario.file + ":" + std::to_string(item.line) + ": error: tracker '" + item.id +
                        "': " + made.error().message};
    trackers_.add(item, std::move(made).value());
  }
  return {};
}

/// Whoever tells where the robot is: its wheels, its own word, trackers.
hal::Result<std::unique_ptr<PoseSource>> MixedSession::make_pose_source(const core::RobotItem& item,
                                                                        bridges::RobotBridge& real, core::RobotId robot,
                                                                        const core::Pose& start) {
  const hal::RobotKind& kind = world_->space().kind(robot);
  const auto* const encoders = kind.drive() != nullptr ? port_of<hal::WheelEncoders>(real) : nullptr;
  std::string source = item.tracker ? item.tracker->source : "auto";
  if (source == "auto")
    source = kind.flies() ? "positioning" : encoders != nullptr && !trackers_.empty() ? "fused" : "odometry";
  if (source == "positioning") {
    const auto* places = port_of<hal::Positioning>(real);
    if (places == nullptr) return hal::Error{"it does not say itself where it is; take the tracker odometry"};
    return std::unique_ptr<PoseSource>(std::make_unique<Positioned>(start, *places, kind));
  }
  if (source != "odometry" && source != "fused")
    return hal::Error{"there is no tracker '" + source + "'; there are: odometry, positioning, fused"};
  if (encoders == nullptr) return hal::Error{"it has no wheel encoders, so " + source + " cannot tell where it is"};
  if (source == "odometry")
    return std::unique_ptr<PoseSource>(std::make_unique<Odometry>(start, *kind.drive(), *encoders));
  if (trackers_.empty()) return hal::Error{"its pose is to be fused, and the file has no <trackers>"};
  FusedPoseParams params;
  if (item.tracker) params.lost_m = item.tracker->lost_m;
  return std::unique_ptr<PoseSource>(
      std::make_unique<FusedPose>(start, *kind.drive(), *encoders, port_of<hal::Gyroscope>(real), params));
}

hal::Status MixedSession::add_twin(const core::RobotItem& item) {
  const core::Scenario& scenario = world_->scenario();
  const core::RobotId robot = world_->space().find_robot(item.id);
  if (item.distribute || !robot.valid())
    return about(item, scenario.file, "a <bridge> stands for one real robot; it cannot be distributed");
  const bridges::BridgeRequest request = bridge_request(scenario, item, world_->seed());
  auto twin = make_twin(item, robot, tracked_names(item), request, world_->space().pose(robot));
  if (!twin.ok()) return about(item, scenario.file, twin.error().message);
  MadeTwin made = std::move(twin).value();
  twins_.push_back(std::move(made.twin));
  twins_.back()->join(barrier_);
  fused_.push_back(made.fused);
  bridges_.push_back(*item.bridge);
  return {};
}

Trackers::Tag MixedSession::tag_of(const core::RobotItem& item) {
  const core::TrackerConfig tag = item.tracker.value_or(core::TrackerConfig{});
  return {tag.turn_rad, tag.p_BT[0], tag.p_BT[1]};
}

/// The twin of the real robot that `request` asks for; trackers know it by `names` from now on, where they are asked.
hal::Result<MixedSession::MadeTwin> MixedSession::make_twin(const core::RobotItem& item, core::RobotId robot,
                                                            const std::vector<std::string>& names,
                                                            const bridges::BridgeRequest& request,
                                                            const core::Pose& start) {
  const core::Scenario& scenario = world_->scenario();
  core::Space& space = world_->space();
  bridges::BridgeRequest asked = request;
  asked.robot_kind = &space.kind(robot);
  auto made = make_bridge_(asked);
  if (!made.ok()) return made.error();
  std::unique_ptr<bridges::RobotBridge> real = std::move(made).value();
  auto poses = make_pose_source(item, *real, robot, start);
  if (!poses.ok()) {
    if (options_.on_left_out) options_.on_left_out(*real);
    return poses.error();
  }
  auto* const fused = dynamic_cast<FusedPose*>(poses.value().get());
  if (fused != nullptr && !names.empty()) trackers_.add_robot(names, tag_of(item), *fused);
  TwinParams params;
  params.rearm = rearm_params(*item.bridge);
  params.frozen_after_ns = hal::time_of_tick(1, scenario.ticks_per_second) + kFrozenAfter_ns;
  params.pose_timeout_ns = lost_after_ns(item, scenario.ticks_per_second);
  params.ask_battery = options_.ask_batteries;
  return MadeTwin{std::make_unique<Twin>(space, robot, std::move(real), std::move(poses).value(), params, options_.log),
                  fused};
}

MixedSession::~MixedSession() {
  world_->set_external(nullptr);
  if (!stopped_) stop_robots();
  shut_down();
}

// --- before the run ---

hal::Status MixedSession::start_bridges() {
  if (started_) return {};
  started_ = true;
  for (const auto& twin : twins_) twin->real().start();
  system_clock_ = system_clock();
  const auto by_date = [](const core::TrackerItem& tracker) { return tracker.clock == "unix"; };
  const auto& trackers = world_->scenario().trackers;
  if (!system_clock_.synchronised && std::any_of(trackers.begin(), trackers.end(), by_date))
    options_.log.warning("this computer's clock is " + system_clock_.text() +
                         "; the poses of trackers with clock=\"unix\" may be late or early by that");
  return trackers_.start();
}

hal::Status MixedSession::connect(const std::atomic<bool>& stop) {
  const hal::TimeNs began_ns = time_.now_ns();
  std::string missing;
  const hal::Status stood = stand_by(
      [&] {
        if (all_answer()) return true;
        const hal::TimeNs waited_ns = now_.monotonic_ns - began_ns;
        if (stop.load(std::memory_order_relaxed)) return false;
        leave_out_missing(waited_ns);
        missing = missing_robots(waited_ns);
        return !missing.empty();
      },
      stop);
  if (!missing.empty()) return hal::Error{"real robots did not answer: " + missing};
  if (!stood.ok() && started_) return hal::Error{"interrupted while waiting for real robots: " + missing_robots({})};
  return stood;
}

hal::Status MixedSession::stand_by(const std::function<bool()>& enough, const std::atomic<bool>& stop) {
  if (const hal::Status started = start_bridges(); !started.ok()) return started;
  hal::TimeNs commit_ns = time_.now_ns();  // the next; bridges learn from it when to ask
  stopped_ = false;                        // from here on robots may hear from us
  phase_ = RunPhase::Waiting;
  for (;;) {
    now_ = moment();
    obey_emergency_stop();
    const bool commits = now_.monotonic_ns >= commit_ns;
    if (commits) commit_ns = now_.monotonic_ns + hal::time_of_tick(1, world_->ticks_per_second());
    trackers_.latch(now_);
    for (const auto& twin : twins_) {
      twin->latch(now_, phase_);
      if (commits) twin->after_filter(now_);  // stands still, and is asked for readings
    }
    note_states();
    if (enough()) return {};
    if (stop.load(std::memory_order_relaxed)) return hal::Error{"interrupted"};
    const hal::TimeNs wake_ns = now_.monotonic_ns + kPollEvery_ns;
    time_.sleep_until(wake_ns, stop);
    woke_late_.add(time_.now_ns() - wake_ns);
  }
}

bool MixedSession::all_answer() const noexcept {
  return std::all_of(twins_.begin(), twins_.end(),
                     [](const auto& twin) { return twin->real().health() == LinkHealth::Active; });
}

/// Robots without which the run cannot begin, after so long; no time: all that do not answer.
std::string MixedSession::missing_robots(std::optional<hal::TimeNs> waited_ns) const {
  std::string text;
  for (std::size_t i = 0; i < twins_.size(); ++i) {
    const bridges::RobotBridge& real = twins_[i]->real();
    const core::BridgeConfig& bridge = bridges_[i];
    if (real.health() == LinkHealth::Active) continue;
    const bool waits =
        waited_ns && (bridge.if_missing == core::IfMissing::Wait || hal::to_seconds(*waited_ns) < bridge.connect_s);
    if (waits && !real.mismatched()) continue;
    const std::string trouble = real.trouble();
    text += (text.empty() ? "'" : "; '") + twins_[i]->id() + "' on " + bridge.link + " within " +
            hal::format_number(bridge.connect_s) + " s (" + (trouble.empty() ? "" : trouble + "; ") + real.advice() +
            ")";
  }
  return text;
}

void MixedSession::leave_out_missing(hal::TimeNs waited_ns) {
  for (std::size_t i = twins_.size(); i-- > 0;) {
    bridges::RobotBridge& real = twins_[i]->real();
    const bool in_time = hal::to_seconds(waited_ns) < bridges_[i].connect_s;
    if (bridges_[i].if_missing != core::IfMissing::Simulate || in_time || real.health() == LinkHealth::Active) continue;
    options_.log.warning("robot '" + twins_[i]->id() + "' on " + bridges_[i].link +
                         " is not there, and is simulated: " + real.trouble());
    real.shut_down();
    if (options_.on_left_out) options_.on_left_out(real);
    twins_[i]->let_go();
    twins_[i]->leave();
    const auto at = static_cast<std::ptrdiff_t>(i);
    left_out_.push_back(std::move(twins_[i]));
    twins_.erase(twins_.begin() + at);
    if (fused_[i] != nullptr) trackers_.remove_robot(*fused_[i]);
    fused_.erase(fused_.begin() + at);
    bridges_.erase(bridges_.begin() + at);
    last_.erase(last_.begin() + at);
    confirmed_.erase(confirmed_.begin() + at);
    times_.erase(times_.begin() + at);
    if (i < rests_.size()) rests_.erase(rests_.begin() + at);
  }
}

// --- the run ---

hal::Status MixedSession::begin() {
  if (const int priority = world_->scenario().priority; priority > 0) {
    const hal::Status granted = ask_for_realtime_priority(priority);
    if (!granted.ok()) options_.log.warning(granted.error().message + "; going on without");
  }
  if (const hal::Status started = start_bridges(); !started.ok()) return started;
  stopped_ = false;
  phase_ = RunPhase::Running;
  if (options_.scheduling) scheduling_ = options_.scheduling();
  if (scheduling_) pacer_.judge_by(*scheduling_);
  return {};
}

bool MixedSession::before_tick(const std::atomic<bool>& stop) {
  if (paused_ && !stand_paused(stop)) return false;
  if (!pacing_) pacer_.start();
  pacing_ = true;
  return true;
}

void MixedSession::after_tick(bool over, const std::atomic<bool>& stop) {
  if (over || paused_) {
    pacer_.finish();
    pacing_ = false;
  } else {
    (void)pacer_.wait_for_next(stop, {kLookEvery_ns, [this] { obey_emergency_stop(); }});
  }
}

hal::Status MixedSession::run(hal::Tick ticks, const std::atomic<bool>& stop,
                              const std::function<void(core::World&)>& after_tick_done) {
  if (const hal::Status begun = begin(); !begun.ok()) return begun;
  world_->start();
  bool over = false;
  while (!over && world_->state() == core::RunState::Running && !stop.load(std::memory_order_relaxed) &&
         before_tick(stop)) {
    world_->step();
    if (after_tick_done) after_tick_done(*world_);
    over = (ticks > 0 && world_->tick() >= ticks) || world_->state() != core::RunState::Running;
    after_tick(over, stop);
  }
  stop_robots();
  world_->finish();
  if (world_->state() == core::RunState::Failed) return hal::Error{world_->failure()};
  return {};
}

Moment MixedSession::moment() const noexcept {
  const bool begun = phase_ == RunPhase::Running || phase_ == RunPhase::Paused;
  return {begun ? hal::time_of_tick(world_->tick(), world_->ticks_per_second()) : 0, time_.now_ns()};
}

void MixedSession::latch(core::World&) {
  take_inputs();
}

void MixedSession::take_inputs() {
  now_ = moment();
  clock_ = {now_.monotonic_ns, options_.unix_clock != nullptr ? options_.unix_clock() : unix_now_ns(), now_.run_ns,
            static_cast<std::uint32_t>(pacer_.ledger().skipped_slots)};
  if (const std::uint64_t freezes = options_.freezes ? options_.freezes() : 0; freezes != freezes_) {
    freezes_ = freezes;
    for (const auto& twin : twins_) twin->real_robot().hub_was_frozen();
  }
  const bool guarded = !options_.guarded || options_.guarded();
  const bool rearmed = options_.rearm_asked != nullptr && options_.rearm_asked->exchange(false);
  if (!candidates_.empty() || !retired_.empty() || !given_up_.empty()) follow_candidates();
  trackers_.latch(now_);
  compare_links();
  for (std::size_t i = 0; i < twins_.size(); ++i) {
    Twin& twin = *twins_[i];
    RealRobot& real = twin.real_robot();
    if (rearmed) twins_.size() == 1 ? real.rearm() : real.rearm_if_proved();
    real.set_guarded(guarded);
    twin.latch(now_, phase_);
    if (phase_ == RunPhase::Running) times_[i].note_reading(twin.newest_reading(), now_.run_ns);
  }
}

void MixedSession::after_sense(core::World&) {
  for (const auto& twin : twins_) twin->after_sense();
}

void MixedSession::after_filter(core::World&) {
  send_commands();
  for (std::size_t i = 0; i < twins_.size(); ++i) {
    times_[i].note_command(time_.now_ns() - pacer_.scheduled_ns(), pacer_.deadline_ns() - pacer_.scheduled_ns());
    if (world_->tick() % world_->ticks_per_second() == 0)
      ledger_rows_[times_[i].row] = LedgerRow(times_[i].ledger(twins_[i]->real().report()));
  }
}

void MixedSession::send_commands() {
  obey_emergency_stop();
  if (options_.before_commands) options_.before_commands();
  for (const auto& twin : twins_) twin->offer({now_.run_ns, time_.now_ns()});
  barrier_.solve(time_.now_ns());
  for (const auto& twin : twins_) twin->after_filter({now_.run_ns, time_.now_ns()});
  note_states();
}

void MixedSession::note_states() {
  for (std::size_t i = 0; i < twins_.size(); ++i) {
    const Twin& twin = *twins_[i];
    last_[i].driving = twin.verdict().may_drive;
    last_[i].health = twin.real().health();
    last_[i].state = twin.verdict().reason;
  }
  note_rest();
}

/// @returns whether to go on: else the run ends.
bool MixedSession::stand_paused(const std::atomic<bool>& stop) {
  phase_ = world_->tick() == 0 ? RunPhase::Waiting : RunPhase::Paused;
  hal::TimeNs commit_ns = time_.now_ns();
  while (paused_ && !stop.load(std::memory_order_relaxed)) {
    take_inputs();
    obey_emergency_stop();
    if (now_.monotonic_ns >= commit_ns) {
      commit_ns = now_.monotonic_ns + hal::time_of_tick(1, world_->ticks_per_second());
      send_commands();
    }
    if (options_.while_paused) options_.while_paused();
    if (paused_) time_.sleep_until(now_.monotonic_ns + kLookEvery_ns, stop);
  }
  phase_ = RunPhase::Running;
  return !stop.load(std::memory_order_relaxed);
}

// --- a person's word ---

void MixedSession::obey_emergency_stop() noexcept {
  if (!emergency_asked_.exchange(false, std::memory_order_relaxed)) return;
  for (const auto& twin : twins_) twin->real_robot().emergency_stop(time_.now_ns());
}

/// Error: no real robot has this name.
hal::Result<std::vector<std::size_t>> MixedSession::real_robots(std::string_view robot) const {
  std::vector<std::size_t> found;
  std::string names;
  for (std::size_t i = 0; i < twins_.size(); ++i) {
    if (robot == "*" || twins_[i]->id() == robot) found.push_back(i);
    names += (names.empty() ? "'" : ", '") + twins_[i]->id() + "'";
  }
  if (!found.empty()) return found;
  return hal::Error{"no real robot is called '" + std::string(robot) +
                    "'; there are: " + (names.empty() ? "none" : names)};
}

hal::Status MixedSession::arm(std::string_view robot) {
  auto chosen = real_robots(robot);
  if (!chosen.ok()) return chosen.error();
  bool any = false;
  for (const std::size_t i : chosen.value()) {
    RealRobot& real = twins_[i]->real_robot();
    any = any || real.awaits_arming();
    real.arm(robot != "*");
  }
  if (any) return {};
  return hal::Error{robot == "*"
                        ? std::string("no real robot waits to be armed: there was no emergency stop")
                        : "robot '" + std::string(robot) + "' does not wait to be armed: there was no emergency stop"};
}

hal::Status MixedSession::rearm(std::string_view robot) {
  auto chosen = real_robots(robot);
  if (!chosen.ok()) return chosen.error();
  bool any = false;
  std::string unproved;
  for (const std::size_t i : chosen.value()) {
    RealRobot& real = twins_[i]->real_robot();
    if (!real.awaits_rearm()) continue;
    robot == "*" ? real.rearm_if_proved() : real.rearm();
    any = any || !real.awaits_rearm();
    if (robot == "*" && real.unproved())
      unproved += (unproved.empty() ? "" : "; ") + ("'" + twins_[i]->id() + "': ") + real.reason();
  }
  if (!unproved.empty()) {
    const std::string which =
        "not proved to be the robots that were armed, so each is re-armed by its name: " + unproved;
    if (!any) return hal::Error{which};
    options_.log.warning(which);
  }
  if (any) return {};
  const std::string whose = robot == "*" ? "no real robot waits" : "robot '" + std::string(robot) + "' does not wait";
  return hal::Error{whose + " to be re-armed" + (robot == "*" ? "" : ": " + last_[chosen.value().front()].state) +
                    "; those with rearm=\"never\" stand"};
}

hal::Status MixedSession::go_on() {
  if (!paused_) return hal::Error{"the run goes on already"};
  paused_ = false;
  return {};
}

std::vector<RealRobotStatus> MixedSession::status() const {
  std::vector<RealRobotStatus> all;
  for (std::size_t i = 0; i < twins_.size(); ++i) {
    const Twin& twin = *twins_[i];
    RealRobotStatus status;
    status.id = twin.id();
    status.device = last_[i].device;
    status.link = bridges_[i].link;
    status.identity = bridges::to_text(twin.real().identity());
    for (const Candidate& candidate : candidates_) {
      if (candidate.robot == status.id) status.coming = candidate.by.id;
    }
    status.robot = twin.robot();
    status.health = last_[i].health;
    status.trouble = twin.real().trouble();
    status.driving = last_[i].driving && !twin.real_robot().awaits_arming();
    status.state = last_[i].state;
    if (last_[i].health != LinkHealth::Active) status.advice = twin.real().advice();
    if (const auto* const drive = world_->space().kind(twin.robot()).drive(); drive != nullptr) {
      const auto* const encoders = port_of<hal::WheelEncoders>(twins_[i]->real());
      if (encoders != nullptr && encoders->validity != hal::Validity::Absent)
        status.wheels_turned_rad = (encoders->right_m - encoders->left_m) / drive->wheel_base_m;
    }
    status.emergency_stopped = twin.real_robot().emergency_stopped();
    status.awaits_arming = twin.real_robot().awaits_arming();
    status.awaits_rearm = twin.real_robot().awaits_rearm();
    status.held_back_m_s = twin.changed_m_s();
    status.held_back_ticks = twin.counts().barrier.changed_ticks;
    const auto age_s = [&](hal::TimeNs taken_ns) { return std::max(0.0, hal::to_seconds(now_.run_ns - taken_ns)); };
    if (const hal::Reading* newest = twin.newest_reading()) status.reading_age_s = age_s(newest->taken_ns);
    const bridges::LinkReport link = twin.real().report();
    status.round_trip_s = hal::to_seconds(link.mean_round_trip_ns);
    status.ledger = times_[i].ledger(link);
    const hal::Battery* const battery = twin.real_robot().battery();
    if (battery != nullptr && battery->validity != hal::Validity::Absent) status.battery = battery->charge;
    if (status.battery && battery->supply_V > 0.0F) status.supply_V = battery->supply_V;
    const TrackedPose& tracked = twin.tracked();
    if (tracked.known)
      status.places.push_back(
          {std::string(twin.poses().name()), tracked.pose, age_s(twin.pose_taken_ns()), tracked.sd_m, tracked.sd_rad});
    if (fused_[i] != nullptr) {
      status.sightings = fused_[i]->counts();
      for (std::size_t t = 0; t < trackers_.size(); ++t) {
        const auto& seen = fused_[i]->seen()[t];
        if (!seen) continue;
        const double heading_rad = seen->heading_rad.value_or(twin.pose().heading_rad());
        status.places.push_back({trackers_.id(t), core::Pose::at(seen->x_m, seen->y_m, heading_rad, twin.pose().z_m),
                                 age_s(now_.to_run(seen->taken_ns)), seen->sd_m,
                                 seen->heading_rad ? std::optional(seen->sd_rad) : std::nullopt});
      }
    }
    status.places.push_back({"hub", twin.pose(), 0.0, {}, {}});
    all.push_back(std::move(status));
  }
  return all;
}

// --- the end ---

template <class Visit>
void MixedSession::for_each_bridge(Visit&& visit) const {
  for (const auto& twin : twins_) visit(twin->real());
  for (const Candidate& candidate : candidates_) visit(candidate.made.twin->real());
  for (const Retired& retired : retired_) visit(retired.twin->real());
}

bool MixedSession::stop_robots() {
  if (phase_ == RunPhase::Running) now_ = moment();
  phase_ = RunPhase::Stopping;
  for_each_bridge([this](bridges::RobotBridge& real) { real.stop(time_.now_ns()); });
  const hal::TimeNs began_ns = time_.now_ns();
  bool all = false, waits = true;
  for (;;) {
    const double waited_s = hal::to_seconds(time_.now_ns() - began_ns);
    all = true;
    waits = false;
    const auto look = [&](const bridges::RobotBridge& real, double stop_s) {
      const bool confirmed = real.at_rest();
      all = all && confirmed;
      waits = waits || (!confirmed && waited_s < stop_s);
      return confirmed;
    };
    for (std::size_t i = 0; i < twins_.size(); ++i) confirmed_[i] = look(twins_[i]->real(), bridges_[i].stop_s) ? 1 : 0;
    for (Retired& retired : retired_) retired.confirmed = look(retired.twin->real(), retired.stop_s);
    note_rest();
    if (!waits) break;
    time_.sleep_until(time_.now_ns() + kPollEvery_ns, kNever);
    for_each_bridge([this](bridges::RobotBridge& real) { real.latch(0, time_.now_ns()); });
  }
  const auto complain = [this](const std::string& robot, const std::string& link) {
    options_.log.error("robot '" + robot + "' on " + link +
                       " did not confirm its stop: switch it off by hand if it moves");
  };
  for (std::size_t i = 0; i < twins_.size(); ++i) {
    if (confirmed_[i] == 0) complain(last_[i].device, bridges_[i].link);
  }
  for (const Retired& retired : retired_) {
    if (!retired.confirmed) complain(retired.device, retired.link);
  }
  stopped_ = true;
  return all;
}

void MixedSession::shut_down() {
  std::vector<std::jthread> ends;  // each may wait for its robot
  for_each_bridge([&ends](bridges::RobotBridge& real) {
    const auto end = [&real] { real.shut_down(); };
    try {
      ends.emplace_back(end);
    } catch (const std::system_error&) {  // no more threads: then one after the other
      end();
    }
  });
  ends.clear();
  for (std::size_t i = 0; i < twins_.size(); ++i) confirmed_[i] = twins_[i]->real().at_rest() ? 1 : 0;
  for (GivenUp& one : given_up_) {
    if (one.closing.valid()) one.closing.wait();
  }
  leave_out_closed();
  if (!options_.on_left_out) return;
  for (const Candidate& candidate : candidates_) options_.on_left_out(candidate.made.twin->real());  // never driven
}

MixedReport MixedSession::report() const {
  MixedReport report;
  report.pace = pacer_.ledger();
  report.clock = system_clock_;
  report.trackers = trackers_.status(now_.monotonic_ns);
  for (std::size_t i = 0; i < twins_.size(); ++i) {
    const Twin& twin = *twins_[i];
    RealRobotReport robot;
    robot.id = twin.id();
    robot.link = bridges_[i].link;
    robot.robot = twin.robot();
    robot.pose = twin.pose();
    robot.health = last_[i].health;
    robot.driving = last_[i].driving;
    robot.state = last_[i].state;
    robot.stop_confirmed = confirmed_[i] != 0;
    robot.counts = twin.counts();
    robot.conversation = twin.real().report();
    robot.ledger = times_[i].ledger(robot.conversation);
    robot.poses_rejected = twin.poses().rejected();
    robot.pose_source = twin.poses().name();
    if (fused_[i] != nullptr) {
      robot.sightings = fused_[i]->counts();
      robot.learnt = fused_[i]->learnt();
    }
    robot.incidents = last_[i].incidents;
    robot.incidents.insert(robot.incidents.end(), twin.incidents().begin(), twin.incidents().end());
    report.robots.push_back(std::move(robot));
  }
  report.replacements = replaced_;
  return report;
}

}  // namespace tandem::mixed_reality
