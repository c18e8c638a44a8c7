#include "mixed_reality/session/mixed_session.hpp"

#include <algorithm>
#include <system_error>
#include <thread>

#include "hal/unit.hpp"
#include "mixed_reality/settings/timeouts.hpp"
#include "mixed_reality/tracking/odometry.hpp"
#include "mixed_reality/tracking/positioned.hpp"

namespace tandem::mixed_reality {
namespace {

// Two ticks that lie farther apart than a tick and this: guardians have stopped the robots meanwhile.
constexpr hal::TimeNs kFrozenAfter_ns = 500 * hal::kNsPerMs;
constexpr hal::TimeNs kPollEvery_ns = 20 * hal::kNsPerMs;  // while waiting for robots

const std::atomic<bool> kNever{false};

hal::Error about(const core::RobotItem& item, const std::string& file, const std::string& what) {
  return hal::Error{file + ":" + std::to_string(item.bridge->line) + ": error: robot '" + item.id + "': " + what};
}

/// Whoever tells where the robot is: its wheels, or its own word.
hal::Result<std::unique_ptr<PoseSource>> make_pose_source(const core::RobotItem& item, bridges::RobotBridge& real,
                                                          const core::Pose& start, const hal::RobotKind& kind) {
  const std::string source = item.tracker ? item.tracker->source : kind.flies() ? "positioning" : "odometry";
  if (source == "positioning") {
    const auto* places = static_cast<const hal::Positioning*>(real.port(hal::port_type<hal::Positioning>()));
    if (places == nullptr) return hal::Error{"it does not say itself where it is; take the tracker odometry"};
    return std::unique_ptr<PoseSource>(std::make_unique<Positioned>(start, *places, kind));
  }
  if (source != "odometry") return hal::Error{"there is no tracker '" + source + "'; there are: odometry, positioning"};
  const auto* encoders = static_cast<const hal::WheelEncoders*>(real.port(hal::port_type<hal::WheelEncoders>()));
  if (encoders == nullptr || kind.drive() == nullptr)
    return hal::Error{"it has no wheel encoders, so odometry cannot tell where it is"};
  return std::unique_ptr<PoseSource>(std::make_unique<Odometry>(start, *kind.drive(), *encoders));
}

}  // namespace

// --- making one ---

hal::Result<std::unique_ptr<MixedSession>> MixedSession::make(std::unique_ptr<core::World> world,
                                                              const BridgeMaker& make_bridge, TimeSource& time,
                                                              const MixedOptions& options) {
  std::unique_ptr<MixedSession> session(new MixedSession(std::move(world), time, options));
  for (const core::RobotItem& item : session->world_->scenario().robots) {
    if (!item.bridge) continue;
    if (const hal::Status added = session->add_twin(item, make_bridge); !added.ok()) return added.error();
  }
  const std::size_t count = session->twins_.size();
  session->last_.resize(count);
  session->confirmed_.assign(count, 0);
  session->world_->set_external(session.get());
  return session;
}

MixedSession::MixedSession(std::unique_ptr<core::World> world, TimeSource& time, const MixedOptions& options)
    : world_(std::move(world)), time_(time), options_(options), pacer_(time, world_->ticks_per_second()) {}

hal::Status MixedSession::add_twin(const core::RobotItem& item, const BridgeMaker& make_bridge) {
  const core::Scenario& scenario = world_->scenario();
  core::Space& space = world_->space();
  const core::RobotId robot = space.find_robot(item.id);
  if (item.distribute || !robot.valid())
    return about(item, scenario.file, "a <bridge> stands for one real robot; it cannot be distributed");
  bridges::BridgeRequest request = bridge_request(scenario, item, world_->seed());
  request.robot_kind = &space.kind(robot);
  auto made = make_bridge(request);
  if (!made.ok()) return about(item, scenario.file, made.error().message);
  std::unique_ptr<bridges::RobotBridge> real = std::move(made).value();

  auto poses = make_pose_source(item, *real, space.pose(robot), space.kind(robot));
  if (!poses.ok()) return about(item, scenario.file, poses.error().message);

  TwinParams params;
  params.rearm = rearm_params(*item.bridge);
  params.frozen_after_ns = hal::time_of_tick(1, scenario.ticks_per_second) + kFrozenAfter_ns;
  params.pose_timeout_ns = lost_after_ns(item, scenario.ticks_per_second);
  twins_.push_back(
      std::make_unique<Twin>(space, robot, std::move(real), std::move(poses).value(), params, options_.log));
  bridges_.push_back(*item.bridge);
  return {};
}

MixedSession::~MixedSession() {
  world_->set_external(nullptr);
  if (!stopped_) stop_robots();
  shut_down();
}

// --- before the run ---

void MixedSession::start_bridges() {
  if (started_) return;
  started_ = true;
  for (const auto& twin : twins_) twin->real().start();
}

hal::Status MixedSession::connect(const std::atomic<bool>& stop) {
  start_bridges();
  const hal::TimeNs began_ns = time_.now_ns();
  hal::TimeNs commit_ns = began_ns;  // the next; bridges learn from it when to ask
  stopped_ = false;                  // from here on robots may hear from us
  phase_ = RunPhase::Waiting;
  for (;;) {
    now_ = moment();
    const bool commits = now_.monotonic_ns >= commit_ns;
    if (commits) commit_ns = now_.monotonic_ns + hal::time_of_tick(1, world_->ticks_per_second());
    for (const auto& twin : twins_) {
      twin->latch(now_, phase_);
      if (commits) twin->after_filter(now_);  // stands still, and is asked for readings
    }
    if (all_answer()) return {};
    const hal::TimeNs waited_ns = now_.monotonic_ns - began_ns;
    if (stop.load(std::memory_order_relaxed))
      return hal::Error{"interrupted while waiting for real robots: " + missing_robots({})};
    leave_out_missing(waited_ns);
    if (const std::string missing = missing_robots(waited_ns); !missing.empty())
      return hal::Error{"real robots did not answer: " + missing};
    time_.sleep_until(now_.monotonic_ns + kPollEvery_ns, stop);
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
    const auto at = static_cast<std::ptrdiff_t>(i);
    left_out_.push_back(std::move(twins_[i]));
    twins_.erase(twins_.begin() + at);
    bridges_.erase(bridges_.begin() + at);
    last_.erase(last_.begin() + at);
    confirmed_.erase(confirmed_.begin() + at);
  }
}

// --- the run ---

hal::Status MixedSession::run(hal::Tick ticks, const std::atomic<bool>& stop,
                              const std::function<void(core::World&)>& after_tick) {
  if (const int priority = world_->scenario().priority; priority > 0) {
    const hal::Status granted = ask_for_realtime_priority(priority);
    if (!granted.ok()) options_.log.warning(granted.error().message + "; going on without");
  }
  start_bridges();
  stopped_ = false;
  phase_ = RunPhase::Running;
  world_->start();
  pacer_.start();
  while (world_->state() == core::RunState::Running && !stop.load(std::memory_order_relaxed)) {
    world_->step();
    if (after_tick) after_tick(*world_);
    if ((ticks > 0 && world_->tick() >= ticks) || world_->state() != core::RunState::Running) {
      pacer_.finish();
      break;
    }
    if (!pacer_.wait_for_next(stop)) break;
  }
  stop_robots();
  world_->finish();
  if (world_->state() == core::RunState::Failed) return hal::Error{world_->failure()};
  return {};
}

Moment MixedSession::moment() const noexcept {
  const bool running = phase_ == RunPhase::Running;
  return {running ? hal::time_of_tick(world_->tick(), world_->ticks_per_second()) : 0, time_.now_ns()};
}

void MixedSession::latch(core::World&) {
  now_ = moment();
  if (const std::uint64_t freezes = options_.freezes ? options_.freezes() : 0; freezes != freezes_) {
    freezes_ = freezes;
    for (const auto& twin : twins_) twin->hub_was_frozen();
  }
  const bool guarded = !options_.guarded || options_.guarded();
  const bool rearmed = options_.rearm_asked != nullptr && options_.rearm_asked->exchange(false);
  for (const auto& twin : twins_) {
    if (rearmed) twin->rearm();
    twin->set_guarded(guarded);
    twin->latch(now_, phase_);
  }
}

void MixedSession::after_sense(core::World&) {
  for (const auto& twin : twins_) twin->after_sense();
}

void MixedSession::after_filter(core::World&) {
  if (options_.before_commands) options_.before_commands();
  for (std::size_t i = 0; i < twins_.size(); ++i) {
    Twin& twin = *twins_[i];
    twin.after_filter({now_.run_ns, time_.now_ns()});
    last_[i].driving = twin.verdict().may_drive;
    last_[i].health = twin.real().health();
    last_[i].state = twin.verdict().reason;
  }
}

// --- the end ---

bool MixedSession::stop_robots() {
  if (phase_ == RunPhase::Running) now_ = moment();
  phase_ = RunPhase::Stopping;
  for (const auto& twin : twins_) twin->real().stop(time_.now_ns());
  const hal::TimeNs began_ns = time_.now_ns();
  bool all = false, waits = true;
  for (;;) {
    const double waited_s = hal::to_seconds(time_.now_ns() - began_ns);
    all = true;
    waits = false;
    for (std::size_t i = 0; i < twins_.size(); ++i) {
      confirmed_[i] = twins_[i]->real().at_rest() ? 1 : 0;
      all = all && confirmed_[i] != 0;
      waits = waits || (confirmed_[i] == 0 && waited_s < bridges_[i].stop_s);
    }
    if (!waits) break;
    time_.sleep_until(time_.now_ns() + kPollEvery_ns, kNever);
    for (const auto& twin : twins_) twin->real().latch(0, time_.now_ns());
  }
  for (std::size_t i = 0; i < twins_.size(); ++i) {
    if (confirmed_[i] != 0) continue;
    options_.log.error("robot '" + twins_[i]->id() + "' on " + bridges_[i].link +
                       " did not confirm its stop: switch it off by hand if it moves");
  }
  stopped_ = true;
  return all;
}

void MixedSession::shut_down() {
  std::vector<std::jthread> ends;  // each may wait for its robot
  for (const auto& twin : twins_) {
    const auto end = [&real = twin->real()] { real.shut_down(); };
    try {
      ends.emplace_back(end);
    } catch (const std::system_error&) {  // no more threads: then one after the other
      end();
    }
  }
}

MixedReport MixedSession::report() const {
  MixedReport report;
  report.pace = pacer_.ledger();
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
    robot.poses_rejected = twin.poses().rejected();
    robot.incidents = twin.incidents();
    report.robots.push_back(std::move(robot));
  }
  return report;
}

}  // namespace tandem::mixed_reality
