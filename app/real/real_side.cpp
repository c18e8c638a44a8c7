// Real robots, peers and replays of one run of the command line.
#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <utility>

#include "app/experiment/reading.hpp"
#include "app/live/command_log.hpp"
#include "app/process/signals.hpp"
#include "app/process/terminal.hpp"
#include "app/real/desks.hpp"
#include "app/real/guarded_robots.hpp"
#include "app/real/hub_faults.hpp"
#include "app/real/lockstep_peers.hpp"
#include "app/real/mixed_run.hpp"
#include "app/real/motion_memory.hpp"
#include "app/real/real_report.hpp"
#include "app/real/real_robots.hpp"
#include "app/real/register.hpp"
#include "app/real/replay_run.hpp"
#include "app/run/run_plan.hpp"
#include "core/live/live_run.hpp"
#include "core/live/repeat.hpp"

namespace tandem::app {
namespace {

/// Compares every tick of a run that is computed again with its record; changes it where it is to be.
class Replaying final : public core::RunPart {
 public:
  Replaying(RunPlan& plan, ReplayRun& replay) : plan_(plan), replay_(replay) {}
  std::string_view name() const override { return "replay"; }
  core::RunTurn turn() const override { return core::RunTurn::Compare; }
  bool before_tick(core::Run& run) override {
    if (replay_.changes_on_the_way()) run.world().begin_saving();
    return true;
  }
  bool after_tick(core::Run& run) override {
    core::World& world = run.world();
    plan_.as_before = replay_.tick_done(*plan_.repeated, world) && plan_.as_before;
    if (const std::string changes = replay_.next_tick(world); !changes.empty())
      run.tell(world.tick(), {{"kind", "what if"}, {"text", changes}});
    return true;
  }
  hal::Status close(core::Run& run) override {
    plan_.as_before = replay_.finish(run.world()) && plan_.as_before;
    plan_.result->more["replay"] = replay_.json();
    plan_.result->more_rows = replay_.rows();
    return {};
  }

 private:
  RunPlan& plan_;
  ReplayRun& replay_;
};

/// Peers of a run in lock-step.
class Lockstep final : public core::RunPart {
 public:
  Lockstep(RunPlan& plan, std::unique_ptr<mixed_reality::LockstepRun> peers) : plan_(plan), peers_(std::move(peers)) {}
  std::string_view name() const override { return "lock-step"; }
  core::RunTurn turn() const override { return core::RunTurn::Pace; }
  hal::Status close(core::Run& run) override {
    const bool finished = end_of(run, plan_.steps).finished();
    const mixed_reality::LockstepReport report = peers_->report();
    plan_.result->more["lockstep"] = lockstep_json(report);
    plan_.result->more_rows = rows_of(report);
    peers_->finish(!finished, finished ? "the run is over" : "the run ended early");
    return {};
  }

 private:
  RunPlan& plan_;
  std::unique_ptr<mixed_reality::LockstepRun> peers_;
};

/// What people command real robots.
class Desk final : public core::RunPart {
 public:
  Desk(RunPlan& plan, mixed_reality::MixedSession& session, GuardedRobots& guarded, core::Run& run)
      : plan_(plan), desks_(std::in_place, *plan.live, session, *plan.commands, *plan.stop) {
    desks_->on_done([&run](const hal::Json& action) {  // of real robots: nobody can do it again
      run.tell(run.world().tick(), {{"kind", "action"}, {"action", action}, {"repeatable", false}});
    });
    desks_->on_first_motion([&guarded](const mixed_reality::PreflightRows& rows) {
      if (const hal::Status kept = keep_motions(guarded.robots(), rows); !kept.ok()) say(kept.error().message);
    });
  }
  std::string_view name() const override { return "desk"; }
  core::RunTurn turn() const override { return core::RunTurn::Desk; }
  hal::Status listen() { return desks_->listen(plan_.scenario->desk, plan_.options.hold.desk_keys); }
  Desks* desks() noexcept { return desks_ ? &*desks_ : nullptr; }
  hal::Status close(core::Run&) override {
    desks_.reset();
    return {};
  }

 private:
  RunPlan& plan_;
  std::optional<Desks> desks_;
};

/// The robots of a mixed run: paces it, and stops them at its end.
class Robots final : public core::RunPart, public RealRobots {
 public:
  Robots(RunPlan& plan, GuardedRobots& guarded, std::unique_ptr<mixed_reality::MixedSession> session)
      : plan_(plan), guarded_(guarded), session_(std::move(session)) {}
  std::string_view name() const override { return "real robots"; }
  core::RunTurn turn() const override { return core::RunTurn::Pace; }

  hal::Status join(core::Run&) override { return session_->begin(); }
  bool before_tick(core::Run&) override { return session_->before_tick(*plan_.stop); }
  bool after_tick(core::Run& run) override {
    const core::World& world = run.world();
    const bool over = plan_.steps > 0 && world.tick() >= plan_.steps;
    session_->after_tick(over || world.state() != core::RunState::Running, *plan_.stop);
    return true;
  }
  hal::Status finish(core::Run&) override {
    plan_.look = {};
    session_->stop_robots();
    return {};
  }
  hal::Status close(core::Run&) override {
    guarded_to_the_end_ = guarded_.guarded();
    session_->shut_down();
    plan_.log.end_robots();
    const mixed_reality::MixedReport report = session_->report();
    plan_.result->more = report_json(report);
    plan_.result->more_rows = rows_of(report);
    plan_.result->figures.deadline_misses = report.pace.deadline_misses;
    plan_.result->figures.misses_by_machine = report.pace.misses_by_machine;
    left_ = guarded_.release_rested();
    return {};
  }

  bool paused() const override { return session_->paused(); }
  void pause() override { session_->pause(); }
  hal::Status go_on() override { return session_->go_on(); }
  std::vector<core::RollRow> roll_call() const override { return session_->roll_call(); }
  std::vector<Line> lines() const override { return lines_of(session_->status()); }
  std::vector<std::pair<core::RobotId, std::string>> troubles() const override {
    std::vector<std::pair<core::RobotId, std::string>> all;
    for (const mixed_reality::RealRobotReport& r : session_->report().robots) {
      if (!r.driving) all.emplace_back(r.robot, r.state);
    }
    return all;
  }
  hal::Json report() const override { return report_json(session_->report()); }
  std::optional<hal::Json> skipped() override { return skipped_event(session_->clock(), skipped_told_); }
  hal::Json message() const override { return desk_ != nullptr ? desk_->desks()->real_message() : hal::Json(); }
  void post(hal::Json command, core::LiveReply reply, std::string_view from) override {
    desk_->desks()->post(std::move(command), std::move(reply), from);
  }

  mixed_reality::MixedSession& session() noexcept { return *session_; }
  void set_desk(Desk& desk) noexcept { desk_ = &desk; }
  /// Why the run has failed at its end; empty: it has not.
  std::string failure() const {
    if (!left_.empty()) return fmt::format("the stop of {} is not confirmed", fmt::join(left_, ", "));
    return guarded_to_the_end_ ? "" : "no guardian looked after its robots at the end";
  }

 private:
  RunPlan& plan_;
  GuardedRobots& guarded_;
  std::unique_ptr<mixed_reality::MixedSession> session_;
  Desk* desk_ = nullptr;
  std::uint32_t skipped_told_ = 0;
  std::vector<std::string> left_;  // whose stop nobody has confirmed
  bool guarded_to_the_end_ = true;
};

class Side final : public RealSide {
 public:
  Side(RunPlan& plan, HubFaults faults) : plan_(plan), hub_faults_(std::move(faults)), replay_(plan.options) {}

  bool open(ExperimentReading& reading) override { return replay_.open(reading); }
  void guard() override {
    guarded_.emplace(!replay_.wanted() && plan_.reading.has_real_robots(plan_.options.without), plan_.loader.catalog(),
                     hal::Log([](hal::Severity, std::string_view text) { say(text); }));
  }
  int prepare(core::Scenario& scenario) override {
    if (replay_.wanted() && !replay_.prepare(scenario, plan_.loader)) return kBadInput;
    if (!plan_.options.hub_faults.empty() && !has_real_robots(scenario))
      return complain(kBadInput, "--hub-fault needs a real robot: no robot of this experiment has a <bridge>");
    return told(guarded_->started(), kFailedRunning);
  }
  bool changes_scripts() const override { return replay_.wanted() && replay_.changed_from_start(); }
  int join() override {
    if (!replay_.wanted()) return kDone;
    hal::Status joined = replay_.check_files(plan_.inputs);
    if (joined.ok()) joined = replay_.join(*plan_.world, plan_.world_log);
    if (joined.ok()) plan_.steps = replay_.steps();
    return told(joined);
  }
  int add_robots(core::Run& run) override {
    if (has_real_robots(*plan_.scenario)) return add_real(run);
    int code = kDone;
    auto peers = join_peers(*plan_.world, plan_.loader, *plan_.stop, plan_.world_log, code);
    if (code != kDone) return plan_.stop->load() ? interrupted_code() : code;
    if (peers == nullptr) return kDone;
    plan_.peers = true;
    run.add(std::make_unique<Lockstep>(plan_, std::move(peers)));
    return kDone;
  }
  hal::Status record_inputs(core::Recorder& record) override {
    const core::Space& space = plan_.world->space();
    if (robots_ != nullptr) {
      if (const hal::Status added = record_ledgers(record, robots_->session()); !added.ok()) return added;
      return record.set_inputs(space, robots_->session().inputs());
    }
    const core::SpaceInputs* const inputs = replay_.wanted() ? replay_.inputs() : nullptr;
    return inputs != nullptr ? record.set_inputs(space, *inputs) : hal::Status();
  }
  int add_parts(core::Run& run) override {
    if (replay_.wanted()) run.add(std::make_unique<Replaying>(plan_, replay_));
    if (robots_ == nullptr) return kDone;
    plan_.look = [&live = *plan_.live] { live.look(); };
    auto desk = std::make_unique<Desk>(plan_, robots_->session(), *guarded_, run);
    robots_->set_desk(*desk);
    const hal::Status listens = desk->listen();
    run.add(std::move(desk));
    return told(listens, kFailedRunning);
  }
  std::string failure() const override { return robots_ != nullptr ? robots_->failure() : ""; }

 private:
  int add_real(core::Run& run);
  mixed_reality::MixedOptions options();
  hal::Status connect(mixed_reality::MixedSession& session);

  RunPlan& plan_;
  HubFaults hub_faults_;
  ReplayRun replay_;
  std::optional<GuardedRobots> guarded_;
  Robots* robots_ = nullptr;  // of the run
};

mixed_reality::MixedOptions Side::options() {
  RunPlan& plan = plan_;
  mixed_reality::MixedOptions options;
  options.log = plan.log.robots();
  options.on_roll = [&log = plan.log, shown_s = 0.0](const mixed_reality::MixedSession& session) mutable {
    if (wall_seconds() - shown_s < 0.1) return;
    shown_s = wall_seconds();
    log.show_robots(session.roll_call());
  };
  options.hold = plan.options.hold.paused || plan.scenario->desk.hold;
  options.while_paused = [&plan] {
    if (plan.look) plan.look();
  };
  options.scheduling = [] { return std::make_unique<mixed_reality::SystemScheduling>(); };
  options.before_commands = [this] {
    guarded_->update();
    hub_faults_.apply(plan_.clock.now_ns());
  };
  return options;
}

/// Links are opened by who claims the robots and knows of no failed motion of theirs.
hal::Status Side::connect(mixed_reality::MixedSession& session) {
  if (!plan_.options.anyway) {
    if (const hal::Status moved = check_motions(guarded_->robots()); !moved.ok()) return moved;
  }
  if (const hal::Status claimed = guarded_->claim(); !claimed.ok()) return claimed;
  return session.connect(*plan_.stop);
}

int Side::add_real(core::Run& run) {
  const RunOptions& asked = plan_.options;
  const mixed_reality::MixedOptions mixed = options();
  if (mixed.hold && !asked.view.on && !asked.watch.watch && plan_.scenario->desk.lcm.empty())
    return complain(kBadInput,
                    "nobody could start this run, which is to wait for that: add --view or --watch, or "
                    "<desk lcm=…> in the file");
  auto made = make_session(plan_.loader.catalog(), plan_.made, *guarded_, plan_.clock, mixed);
  if (!made.ok()) return complain(kBadInput, made.error().message);
  auto session = std::move(made).value();
  if (const int code = told(connect(*session), kFailedRunning); code != kDone)
    return plan_.stop->load() ? interrupted_code() : code;
  auto robots = std::make_unique<Robots>(plan_, *guarded_, std::move(session));
  robots_ = robots.get();
  plan_.real = robots_;
  run.add(std::move(robots));
  return kDone;
}

hal::Result<std::unique_ptr<RealSide>> make_side(RunPlan& plan) {
  auto faults = HubFaults::make(plan.options.hub_faults);
  if (!faults.ok()) return faults.error();
  return std::unique_ptr<RealSide>(std::make_unique<Side>(plan, std::move(faults).value()));
}

constexpr RealSideType kReal = {"real", &check_real, &outlooks_of_trackers, &inputs_of_bridges, &make_side};

}  // namespace

void register_real_side(hal::Registrar& registrar) {
  registrar.add(kReal);
}

}  // namespace tandem::app
