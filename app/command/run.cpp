#include <algorithm>
#include <csignal>
#include <cstdio>
#include <fmt/format.h>

#include "app/command/command.hpp"
#include "app/emergency_outputs.hpp"
#include "app/guarded_robots.hpp"
#include "app/hub_faults.hpp"
#include "app/measure.hpp"
#include "app/plugins.hpp"
#include "app/progress.hpp"
#include "app/run_log.hpp"
#include "app/run_outputs.hpp"
#include "app/run_report.hpp"
#include "app/signals.hpp"
#include "app/terminal.hpp"
#include "app/watchdog.hpp"
#include "core/sim/world.hpp"
#include "core/view/picture.hpp"
#include "mixed_reality/session/mixed_session.hpp"
#include "mixed_reality/time/pacer.hpp"

namespace tandem::app {
namespace {

/// What a picture of the world says besides where everything is.
core::PictureOptions picture_options(const core::World& world, const mixed_reality::MixedReport* real,
                                     const core::PictureLook& look) {
  core::PictureOptions picture;
  picture.experiment = world.scenario().name;
  picture.seed = world.seed();
  picture.time_ns = hal::time_of_tick(world.tick(), world.ticks_per_second());
  picture.look = look;
  picture.ticks_done = world.tick();
  for (const auto& r : real != nullptr ? real->robots : std::vector<mixed_reality::RealRobotReport>{}) {
    if (!r.driving) picture.trouble.push_back({r.robot, r.state});
  }
  return picture;
}

/// What is kept of a run while it goes on, so that little is lost however it ends: records, which the system gets twice
/// a second, and a report for the emergency. Lives from the first tick to the last.
class Recording {
 public:
  /// `now.figures` is brought up to date here. All must outlive this.
  Recording(RunOutputs& outputs, RunResult& now, const mixed_reality::MixedSession* mixed, Watchdog& watchdog)
      : outputs_(outputs),
        now_(now),
        mixed_(mixed),
        watchdog_(watchdog),
        emergency_(outputs),
        began_s_(wall_seconds()),
        began_cpu_s_(cpu_seconds()),
        save_(watchdog, [this] {
          if (outputs_.trajectory != nullptr) (void)outputs_.trajectory->flush();
          set_report();
        }) {
    prepare_report();
    draw();
  }

  void tick_done() {
    const std::lock_guard hold(watchdog_.lock());
    core::TrajectoryRecorder* const trajectory = outputs_.trajectory.get();
    const bool records = trajectory != nullptr && recorded_.ok();
    if (records && now_.world.tick() > 0)                                         // 0: a hook went back to the start
      recorded_ = trajectory->record(now_.world.space(), now_.world.tick() - 1);  // the tick that was just done
    if (emergency_.due()) {
      if (records && recorded_.ok()) recorded_ = trajectory->flush();
      outputs_.observers.flush();
      prepare_report();
    }
    if (records && !recorded_.ok()) complain(kFailedRunning, recorded_.error().message + "; the run goes on");
    record();
    outputs_.observers.tick_done(now_.world);
    if (now_.world.tick() > 0) draw();
    if (!outputs_.dump) return;
    if (const hal::Status dumped = outputs_.dump->tick_done(now_.world); !dumped.ok())
      complain(kFailedRunning, dumped.error().message + "; the run goes on");
  }

  void measure() {
    now_.figures.wall_s = wall_seconds() - began_s_;
    now_.figures.cpu_s = cpu_seconds() - began_cpu_s_;
    now_.figures.steps = now_.world.tick();
  }

 private:
  void record() {
    core::Recorder* const recorder = outputs_.record.get();
    const hal::Tick done = now_.world.tick() - 1;
    if (recorder == nullptr || !in_record_.ok() || done < 0) return;
    in_record_ = recorder->tick_done(now_.world.space(), done);
    const std::vector<std::string>& incidents = now_.world.incidents().first;
    for (; incidents_told_ < incidents.size() && in_record_.ok(); ++incidents_told_)
      in_record_ = recorder->event(done, {{"kind", "incident"}, {"text", incidents[incidents_told_]}});
    if (in_record_.ok() && recorder->wants_fingerprint(done))
      in_record_ = recorder->fingerprint(done, now_.world.state_hash());
    if (!in_record_.ok()) complain(kFailedRunning, in_record_.error().message + "; the run goes on");
  }
  void draw() {
    Pictures* const pictures = outputs_.pictures.get();
    if (pictures == nullptr) return;
    const hal::Tick done = now_.world.tick();
    pictures->note(done, now_.world.space());
    if (!pictures->wants(done)) return;
    std::optional<mixed_reality::MixedReport> real;
    if (mixed_ != nullptr) real = mixed_->report();
    auto picture = picture_options(now_.world, real ? &*real : nullptr, outputs_.look);
    picture.trails = &pictures->trails();
    pictures->draw(done, core::drawing_of(now_.world.space(), picture));
  }
  void prepare_report() {
    if (!outputs_.report) return;
    if (mixed_ != nullptr) real_ = mixed_->report();
    set_report();
  }
  void set_report() {
    if (!outputs_.report) return;
    measure();
    RunResult now = now_;
    now.real = real_ ? &*real_ : nullptr;
    emergency_.set_report(report_members(now));
  }

  RunOutputs& outputs_;
  RunResult& now_;
  const mixed_reality::MixedSession* mixed_;
  Watchdog& watchdog_;
  EmergencyOutputs emergency_;
  double began_s_, began_cpu_s_;
  std::optional<mixed_reality::MixedReport> real_;
  hal::Status recorded_, in_record_;
  std::size_t incidents_told_ = 0;
  SaveAtEnd save_;
};

/// Steps a purely simulated world, paced when its file says so. @returns deadlines that were missed.
template <class AfterTick>
std::uint64_t run_alone(core::World& world, std::int64_t steps, const std::atomic<bool>& stop,
                        mixed_reality::TimeSource& clock, const AfterTick& after_tick) {
  mixed_reality::Pacer pacer(clock, world.ticks_per_second());
  const bool paced = world.scenario().time_mode == core::TimeMode::Realtime;
  world.start();
  if (paced) pacer.start();
  while (world.state() == core::RunState::Running && (steps == 0 || world.tick() < steps) &&
         !stop.load(std::memory_order_relaxed)) {
    world.step();
    after_tick(world);
    if (paced && !pacer.wait_for_next(stop)) break;
  }
  world.finish();
  return pacer.ledger().deadline_misses;
}

/// Makes robots that are real in the file ordinary ones. Error: there is no such real robot.
hal::Status leave_out(core::Scenario& scenario, const std::vector<std::string>& ids) {
  for (const std::string& id : ids) {
    std::string real;
    bool found = false;
    for (core::RobotItem& item : scenario.robots) {
      if (!item.bridge) continue;
      real += (real.empty() ? "" : ", ") + item.id;
      if (item.id != id) continue;
      item.bridge.reset();
      found = true;
    }
    if (!found)
      return hal::Error{"--without " + id +
                        ": there is no real robot of this name; there are: " + (real.empty() ? "none" : real)};
  }
  return {};
}

bool has_real_robots(const core::Scenario& scenario) {
  for (const core::RobotItem& item : scenario.robots) {
    if (item.bridge) return true;
  }
  return false;
}

/// Where a world's real robots take part; null when it has none. `code` is not kDone when they cannot.
std::unique_ptr<mixed_reality::MixedSession> join_real_robots(
    const hal::Catalog& catalog, std::unique_ptr<core::World>& world, GuardedRobots& guarded, HubFaults& hub_faults,
    mixed_reality::TimeSource& clock, const std::atomic<bool>& stop, const hal::Log& log, int& code) {
  if (!has_real_robots(world->scenario())) return nullptr;
  mixed_reality::MixedOptions options;
  options.log = log;
  options.freezes = [&guarded] { return guarded.freezes(); };
  options.guarded = [&guarded] { return guarded.guarded(); };
  catch_rearm();
  options.rearm_asked = &rearm_asked();
  options.on_left_out = [&guarded](const bridges::RobotBridge& bridge) { guarded.remove(bridge); };
  options.before_commands = [&] {
    guarded.update();
    hub_faults.apply(clock.now_ns());
  };
  const auto maker = [&](const bridges::BridgeRequest& request) {
    bridges::BridgeRequest permitted = request;
    permitted.permit = guarded.permit();
    permitted.unix_clock = &hub_unix_ns;
    auto bridge = mixed_reality::make_bridge(catalog, permitted, log);
    if (bridge.ok()) guarded.add(**bridge);
    return bridge;
  };
  auto made = mixed_reality::MixedSession::make(std::move(world), maker, clock, options);
  if (!made.ok()) {
    code = complain(kBadInput, made.error().message);
    return nullptr;
  }
  auto session = std::move(made).value();
  const hal::Status claimed = guarded.claim();
  const hal::Status connected = claimed.ok() ? session->connect(stop) : claimed;
  if (!connected.ok()) code = complain(kFailedRunning, connected.error().message);
  return session;
}

/// Writes what was asked for at the end of a run. @returns whether all of it could be written.
bool write_results(RunOutputs& outputs, const RunResult& result, bool table) {
  bool good = true;
  const auto check = [&good](const hal::Status& status) {
    if (!status.ok()) good = complain(kFailedRunning, status.error().message) == kDone;
  };
  if (outputs.trajectory != nullptr) check(outputs.trajectory->close());
  if (outputs.record != nullptr) check(outputs.record->close(result.world.tick() - 1, record_end(result)));
  if (!outputs.observers.finish(result.world)) good = false;
  if (outputs.dump) check(outputs.dump->close(result.world));
  if (outputs.pictures != nullptr && !outputs.pictures->close()) good = false;
  auto picture = picture_options(result.world, result.real, outputs.look);
  if (outputs.pictures != nullptr) picture.trails = &outputs.pictures->trails();
  if (outputs.picture) {
    check(core::write_picture(result.world.space(), *outputs.picture, picture));
  }
  if (outputs.scene) {
    check(write_scene(core::drawing_of(result.world.space(), picture), outputs.look, *outputs.scene, outputs.povray));
  }
  if (outputs.report) {
    const hal::Status written = outputs.report->write(report_of(result) + "\n");
    check(written.ok() ? outputs.report->commit() : written);
  }
  if (table) print_result(result);
  return good;
}

}  // namespace

int run(const RunOptions& options) {
  const double began = wall_seconds();
  auto hub_faults = HubFaults::make(options.hub_faults);
  if (!hub_faults.ok()) return complain(kBadInput, hub_faults.error().message);
  hal::PluginLoader loader = make_loader();
  ExperimentReading reading(loader, options.plugins);
  if (!reading.open(options.experiment, options.overrides)) return kBadInput;
  GuardedRobots guarded(reading.has_real_robots(options.without), loader.catalog(),
                        hal::Log([](hal::Severity, std::string_view text) { say(text); }));  // before any thread
  auto scenario = reading.read();
  if (!scenario) return kBadInput;
  if (const hal::Status left_out = leave_out(*scenario, options.without); !left_out.ok())
    return complain(kBadInput, left_out.error().message);
  if (!options.hub_faults.empty() && !has_real_robots(*scenario))
    return complain(kBadInput, "--hub-fault needs a real robot: no robot of this experiment has a <bridge>");
  if (const hal::Status paths = check_output_paths(options, *scenario, loader.catalog()); !paths.ok())
    return complain(kBadInput, paths.error().message);

  if (!guarded.started().ok()) return complain(kFailedRunning, guarded.started().error().message);
  const std::atomic<bool>& stop = catch_signals();
  std::signal(SIGPIPE, SIG_IGN);  // who reads our output may end before us
  Watchdog watchdog(options.step_timeout_s, stop);
  auto opened_log = RunLog::open(options.log);
  if (!opened_log.ok()) return complain(kBadInput, opened_log.error().message);
  RunLog& run_log = *opened_log.value();
  core::WorldOptions world_options;
  world_options.seed = options.seed;
  world_options.threads = options.threads;
  world_options.log = run_log.log();
  core::Problems problems;
  auto made = core::World::make(*scenario, loader, world_options, problems);
  print_problems(problems);
  if (made == nullptr) return kBadInput;
  core::World* const world = made.get();  // a mixed session takes it over
  const InputFiles inputs = input_files(*scenario, loader);
  const std::int64_t steps = steps_of(options.steps, options.seconds, *scenario);
  auto opened = open_outputs(options, *scenario, *world, record_start(*world, inputs), steps);
  if (!opened.ok()) return complain(kBadInput, opened.error().message);
  RunOutputs& outputs = opened.value();
  problems.clear();
  outputs.observers = Observers::make(*scenario, loader.catalog(), *world, problems);
  print_problems(problems);
  if (core::has_errors(problems)) return kBadInput;

  int code = kDone;
  mixed_reality::MonotonicTime clock;
  const auto mixed =
      join_real_robots(loader.catalog(), made, guarded, hub_faults.value(), clock, stop, world_options.log, code);
  if (code != kDone) return stop.load() ? interrupted_code() : code;

  RunResult result{*world, inputs, {}, world->space().robot_count(), {}, nullptr};
  result.figures.threads = world->threads();
  result.figures.init_s = wall_seconds() - began;
  std::optional<mixed_reality::MixedReport> real;
  std::vector<std::string> left;  // robots whose stop nobody has confirmed
  {
    Progress progress(steps, scenario->ticks_per_second);
    Recording recording(outputs, result, mixed.get(), watchdog);
    const auto after_tick = [&](core::World& w) {
      recording.tick_done();
      progress.step(w.tick());
    };
    if (mixed != nullptr) {
      (void)mixed->run(steps, stop, after_tick);  // a failure is the world's, and told below
    } else {
      result.figures.deadline_misses = run_alone(*world, steps, stop, clock, after_tick);
    }
    recording.measure();
  }
  const bool was_guarded = guarded.guarded();
  if (mixed != nullptr) {
    mixed->shut_down();
    real = mixed->report();
    result.real = &*real;
    result.figures.deadline_misses = real->pace.deadline_misses;
    left = guarded.release_rested();
  }
  result.end = end_of(*world, steps, stop.load(std::memory_order_relaxed));
  if (result.end.how == Ended::Failed) complain(kFailedRunning, result.end.failure);
  if (result.end.how == Ended::Interrupted) say(fmt::format("interrupted at tick {}", world->tick()));
  const bool table = !options.quiet && options.report != "-";
  bool written = write_results(outputs, result, table);
  if (const hal::Status logged = run_log.close(); !logged.ok())
    written = complain(kFailedRunning, logged.error().message) == kDone;
  const bool failed = result.end.how == Ended::Failed || world->incidents().controllers_thrown > 0;
  if (failed || !was_guarded || !written || !left.empty()) return kFailedRunning;
  return result.end.how == Ended::Interrupted ? interrupted_code() : kDone;
}

}  // namespace tandem::app
