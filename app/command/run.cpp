#include <algorithm>
#include <csignal>
#include <cstdio>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <iterator>

#include "app/command/command.hpp"
#include "app/experiment/plugins.hpp"
#include "app/experiment/reading.hpp"
#include "app/outputs/emergency_outputs.hpp"
#include "app/outputs/run_log.hpp"
#include "app/outputs/run_outputs.hpp"
#include "app/outputs/run_report.hpp"
#include "app/process/measure.hpp"
#include "app/process/progress.hpp"
#include "app/process/signals.hpp"
#include "app/process/terminal.hpp"
#include "app/process/watchdog.hpp"
#include "app/replay/replay_run.hpp"
#include "app/robots/desks.hpp"
#include "app/robots/guarded_robots.hpp"
#include "app/robots/hub_faults.hpp"
#include "app/robots/lockstep_peers.hpp"
#include "app/robots/mixed_run.hpp"
#include "app/robots/motion_memory.hpp"
#include "app/robots/real_robots.hpp"
#include "app/view/script_watch.hpp"
#include "app/view/view_run.hpp"
#include "app/view/watch.hpp"
#include "core/live/live_run.hpp"
#include "core/live/repeat.hpp"
#include "core/live/source_files.hpp"
#include "core/sim/world.hpp"
#include "core/view/picture.hpp"
#include "core/view/record_drawing.hpp"
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

/// A drawing of the world, with the layers that were asked for.
core::Drawing drawing_of(const core::World& world, const RunOutputs& outputs, const core::PictureOptions& options) {
  core::Drawing drawing = core::drawing_of(world.space(), options);
  drawing.areas = areas_of(world.scenario().safety);
  if (outputs.layers == nullptr) return drawing;
  const hal::Tick last = world.tick() == 0 ? 0 : world.tick() - 1;
  for (const core::LayerPicture& layer : outputs.layers->show(observation_of(world, last)))
    drawing.shapes.insert(drawing.shapes.end(), layer.sketch.shapes().begin(), layer.sketch.shapes().end());
  return drawing;
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
    if (outputs_.layers != nullptr && now_.world.tick() > 0)
      outputs_.layers->note(observation_of(now_.world, now_.world.tick() - 1));
    if (now_.world.tick() > 0) draw();
    if (!outputs_.dump) return;
    if (const hal::Status dumped = outputs_.dump->tick_done(now_.world); !dumped.ok())
      complain(kFailedRunning, dumped.error().message + "; the run goes on");
  }

  /// Of somebody who holds the run.
  void event(hal::Tick tick, const hal::Json& event) {
    const std::lock_guard hold(watchdog_.lock());
    if (outputs_.record == nullptr || !in_record_.ok()) return;
    if (event["kind"] == "back") in_record_ = outputs_.record->went_back(tick);
    if (in_record_.ok()) in_record_ = outputs_.record->event(tick, event);
    if (!in_record_.ok()) complain(kFailedRunning, in_record_.error().message + "; the run goes on");
  }

  /// The picture as it is now.
  core::Drawing drawing() const {
    std::optional<mixed_reality::MixedReport> real;
    if (mixed_ != nullptr) real = mixed_->report();
    auto picture = picture_options(now_.world, real ? &*real : nullptr, outputs_.look);
    if (outputs_.pictures != nullptr) picture.trails = &outputs_.pictures->trails();
    return drawing_of(now_.world, outputs_, picture);
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
    if (mixed_ != nullptr && in_record_.ok()) note_skipped(done);
    const std::vector<std::string>& incidents = now_.world.incidents().first;
    incidents_told_ = std::min(incidents_told_, incidents.size());  // fewer, where the run went back
    for (; incidents_told_ < incidents.size() && in_record_.ok(); ++incidents_told_)
      in_record_ = recorder->event(done, {{"kind", "incident"}, {"text", incidents[incidents_told_]}});
    if (in_record_.ok() && recorder->wants_fingerprint(done)) {
      if (recorder->wants_checks()) {
        const core::StateChecks checks = core::checks_of(now_.world.state_view());
        in_record_ = recorder->fingerprint(done, checks.fingerprint);
        if (in_record_.ok()) in_record_ = recorder->checks(done, checks);
      } else {
        in_record_ = recorder->fingerprint(done, now_.world.state_hash());
      }
    }
    if (!in_record_.ok()) complain(kFailedRunning, in_record_.error().message + "; the run goes on");
  }
  /// Slots of the schedule in which no tick could begin, right before this one.
  void note_skipped(hal::Tick done) {
    if (const auto skipped = skipped_event(mixed_->clock(), skipped_told_))
      in_record_ = outputs_.record->event(done, *skipped);
  }
  void draw() {
    Pictures* const pictures = outputs_.pictures.get();
    if (pictures == nullptr) return;
    const hal::Tick done = now_.world.tick();
    pictures->note(done, now_.world.space());
    if (!pictures->wants(done)) return;
    pictures->draw(done, drawing());
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
  std::uint32_t skipped_told_ = 0;
  SaveAtEnd save_;
};

/// What is to be done again; nothing where no record was named.
hal::Result<core::Repeatable> read_repeated(const RunOptions& options, const core::Scenario& scenario) {
  if (options.repeat.empty()) return core::Repeatable{};
  if (has_real_robots(scenario)) {
    return hal::Error{
        "--repeat: real robots take part, and never do the same twice; simulate them instead (--without)"};
  }
  auto repeated = core::read_repeatable(options.repeat);
  if (repeated.ok() && repeated.value().real_robots && options.replay.record.empty())
    return hal::Error{"record '" + options.repeat +
                      "': real robots took part in this run; `tandem replay` computes it again"};
  if (repeated.ok() && repeated.value().experiment != scenario.name)
    say("the record is of the experiment '" + repeated.value().experiment + "'");
  return repeated;
}

/// The repeated run begins with the scripts of the record, whatever stands in their files now.
void run_recorded_scripts(core::World& world, core::Repeatable& repeated) {
  std::vector<core::RepeatedAction> reloads = core::reloads_to(repeated.scripts, world);
  for (const core::RepeatedAction& reload : reloads) {
    say(fmt::format("controller '{}' begins with its script as the record has it; the file is another one now",
                    reload.action["controller"].get<std::string>()));
  }
  repeated.actions.insert(repeated.actions.begin(), std::make_move_iterator(reloads.begin()),
                          std::make_move_iterator(reloads.end()));
}

/// What a record says at its start, with the scripts of controllers.
hal::Json start_of(core::World& world, const InputFiles& inputs) {
  hal::Json start = record_start(world, inputs);
  hal::Json scripts = core::source_files(world);
  for (hal::Json& files : scripts) {
    for (hal::Json& file : files) file.erase("path");
  }
  if (!scripts.empty()) start["scripts"] = std::move(scripts);
  return start;
}

/// Whether the tick that was just done is as it was in the run that is repeated; true where nobody knows.
bool as_recorded(const core::Repeatable& repeated, const core::World& world) {
  const auto known = repeated.fingerprints.find(world.tick() - 1);
  return known == repeated.fingerprints.end() || known->second == world.state_hash();
}

/// A run that is held, or repeats what was done to another; null: it goes its way alone.
std::unique_ptr<core::LiveRun> hold_run(const RunOptions& options, core::World& world, std::int64_t steps,
                                        const core::Repeatable& repeated, bool in_lockstep,
                                        const std::atomic<bool>& stop, mixed_reality::MixedSession* mixed,
                                        const hal::Log& log) {
  const bool held = options.hold.wanted || options.view.on;
  if (!held && !options.watch.watch && options.repeat.empty() && mixed == nullptr) return nullptr;
  core::LiveOptions live;
  live.ticks = steps;
  live.paused = mixed != nullptr ? mixed->paused() : options.hold.paused;
  if (mixed != nullptr) {
    live.pause_real = [mixed](bool paused) {
      if (!paused) return mixed->go_on();
      mixed->pause();
      return hal::Status();
    };
  }
  live.speed = options.hold.speed;
  if (!live.speed && world.scenario().time_mode == core::TimeMode::Realtime) live.speed = 1.0;
  live.real_robots = has_real_robots(world.scenario());
  live.stay = options.hold.stay;
  live.can_go_back = held && !in_lockstep;  // peers cannot be put back
  live.memory_bytes = options.hold.memory_MB * 1'000'000;
  live.repeat = repeated.actions;
  live.log = log;
  live.stop = &stop;
  return std::make_unique<core::LiveRun>(world, std::move(live));
}

/// Steps a purely simulated world that somebody holds. @returns deadlines that were missed.
template <class AfterTick>
std::uint64_t run_held(core::World& world, core::LiveRun& live, const AfterTick& after_tick) {
  world.start();
  live.start();
  while (live.before_step()) {
    if (!world.step()) break;
    if (live.after_step()) after_tick(world);
  }
  world.finish();
  return live.deadline_misses();
}

/// The same for one that nobody holds, paced when its file says so.
template <class AfterTick>
std::uint64_t run_alone(core::World& world, std::int64_t steps, const std::atomic<bool>& stop,
                        mixed_reality::TimeSource& clock, const AfterTick& after_tick) {
  mixed_reality::Pacer pacer(clock, world.ticks_per_second());
  const bool paced = world.scenario().time_mode == core::TimeMode::Realtime;
  world.start();
  if (paced) pacer.start();
  while (world.state() == core::RunState::Running && (steps == 0 || world.tick() < steps) &&
         !stop.load(std::memory_order_relaxed)) {
    if (!world.step()) break;
    after_tick(world);
    if (paced && !pacer.wait_for_next(stop)) break;
  }
  world.finish();
  return pacer.ledger().deadline_misses;
}

/// Where a world's real robots take part; null when it has none. `code` is not kDone when they cannot.
std::unique_ptr<mixed_reality::MixedSession> join_real_robots(const hal::Catalog& catalog,
                                                              std::unique_ptr<core::World>& world,
                                                              GuardedRobots& guarded, HubFaults& hub_faults,
                                                              mixed_reality::TimeSource& clock,
                                                              const std::atomic<bool>& stop, bool anyway,
                                                              mixed_reality::MixedOptions options, int& code) {
  if (!has_real_robots(world->scenario())) return nullptr;
  options.scheduling = [] { return std::make_unique<mixed_reality::SystemScheduling>(); };
  options.before_commands = [&] {
    guarded.update();
    hub_faults.apply(clock.now_ns());
  };
  auto made = make_session(catalog, world, guarded, clock, std::move(options));
  if (!made.ok()) {
    code = complain(kBadInput, made.error().message);
    return nullptr;
  }
  auto session = std::move(made).value();
  const hal::Status moved = anyway ? hal::Status{} : check_motions(guarded.robots());
  const hal::Status claimed = moved.ok() ? guarded.claim() : moved;
  const hal::Status connected = claimed.ok() ? session->connect(stop) : claimed;
  if (!connected.ok()) code = complain(kFailedRunning, connected.error().message);
  return session;
}

/// Why a run has failed whose world has not; empty: it has not.
std::string failure_besides(const core::World& world, bool as_before, const core::LiveRun* live, bool was_guarded,
                            const std::vector<std::string>& left) {
  if (const core::Incidents& incidents = world.incidents(); incidents.controllers_thrown > 0) {
    return fmt::format("{} threw, and the run went on without {}; the first incident: {}",
                       incidents.controllers_thrown == 1 ? "a controller"
                                                         : fmt::format("{} controllers", incidents.controllers_thrown),
                       incidents.controllers_thrown == 1 ? "its robot" : "their robots",
                       incidents.first.empty() ? "not known" : incidents.first.front());
  }
  if (!as_before) return "it was not as in the run that it repeats";
  if (live != nullptr && !live->failure().empty()) return live->failure();
  if (!left.empty()) return fmt::format("the stop of {} is not confirmed", fmt::join(left, ", "));
  if (!was_guarded) return "no guardian looked after its robots at the end";
  return {};
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
    check(core::write_picture(drawing_of(result.world, outputs, picture), *outputs.picture, outputs.look));
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

/// All but the end of the log, which outlives the world.
int run_with(const RunOptions& options, std::unique_ptr<RunLog>& log) {
  const double began = wall_seconds();
  auto hub_faults = HubFaults::make(options.hub_faults);
  if (!hub_faults.ok()) return complain(kBadInput, hub_faults.error().message);
  hal::PluginLoader loader = make_loader();
  ExperimentReading reading(loader, options.plugins);
  ReplayRun replay(options);
  if (!(replay.wanted() ? replay.open(reading) : reading.open(options.experiment, options.overrides))) return kBadInput;
  GuardedRobots guarded(!replay.wanted() && reading.has_real_robots(options.without), loader.catalog(),
                        hal::Log([](hal::Severity, std::string_view text) { say(text); }));  // before any thread
  auto scenario = reading.read();
  if (!scenario) return kBadInput;
  if (const hal::Status left_out = leave_out(*scenario, options.without); !left_out.ok())
    return complain(kBadInput, left_out.error().message);
  if (replay.wanted() && !replay.prepare(*scenario, loader)) return kBadInput;
  if (!options.hub_faults.empty() && !has_real_robots(*scenario))
    return complain(kBadInput, "--hub-fault needs a real robot: no robot of this experiment has a <bridge>");
  if (const hal::Status paths = check_output_paths(options, *scenario, loader.catalog()); !paths.ok())
    return complain(kBadInput, paths.error().message);

  if (!guarded.started().ok()) return complain(kFailedRunning, guarded.started().error().message);
  const std::atomic<bool>& stop = catch_signals();
  std::signal(SIGPIPE, SIG_IGN);  // who reads our output may end before us
  Watchdog watchdog(options.step_timeout_s, stop, options.step_limit_s);
  auto opened_log = RunLog::open(options.log);
  if (!opened_log.ok()) return complain(kBadInput, opened_log.error().message);
  log = std::move(opened_log).value();
  RunLog& run_log = *log;
  auto repeated = read_repeated(options, *scenario);
  if (!repeated.ok()) return complain(kBadInput, repeated.error().message);
  core::WorldOptions world_options;
  world_options.seed = options.seed ? options.seed : repeated.value().seed;
  world_options.threads = options.threads;
  world_options.log = run_log.log();
  core::Problems problems;
  auto made = core::World::make(*scenario, loader, world_options, problems);
  print_problems(problems);
  if (made == nullptr) return kBadInput;
  core::World* const world = made.get();  // a mixed session takes it over
  const bool other_scripts = options.replay.accept_changes || (replay.wanted() && replay.changed_from_start());
  if (!other_scripts) run_recorded_scripts(*world, repeated.value());
  const InputFiles inputs =
      replay.wanted() || tells_files(options, *scenario) ? input_files(*scenario, loader) : InputFiles{};
  if (replay.wanted()) {
    hal::Status joined = replay.check_files(inputs);
    if (joined.ok()) joined = replay.join(*world, world_options.log);
    if (!joined.ok()) return complain(kBadInput, joined.error().message);
  }
  const std::int64_t steps = replay.wanted() ? replay.steps() : steps_of(options.steps, options.seconds, *scenario);
  auto opened = open_outputs(
      options, *scenario, *world, loader.catalog(), [&] { return start_of(*world, inputs); }, steps);
  if (!opened.ok()) return complain(kBadInput, opened.error().message);
  RunOutputs& outputs = opened.value();
  problems.clear();
  outputs.observers = Observers::make(*scenario, loader.catalog(), *world, problems);
  print_problems(problems);
  if (core::has_errors(problems)) return kBadInput;

  if (const hal::Status watched = Watch::check(options.watch, world->space()); !watched.ok())
    return complain(kBadInput, watched.error().message);

  int code = kDone;
  mixed_reality::MonotonicTime clock;
  std::function<void()> look;  // while real robots stand, because somebody paused the run
  mixed_reality::MixedOptions mixed_options;
  mixed_options.log = run_log.robots();
  mixed_options.on_roll = [&run_log, shown_s = 0.0](const mixed_reality::MixedSession& session) mutable {
    if (wall_seconds() - shown_s < 0.1) return;
    shown_s = wall_seconds();
    run_log.show_robots(session.roll_call());
  };
  mixed_options.hold = options.hold.paused || scenario->desk.hold;
  mixed_options.while_paused = [&look] {
    if (look) look();
  };
  if (mixed_options.hold && has_real_robots(*scenario) && !options.view.on && !options.watch.watch &&
      scenario->desk.lcm.empty())
    return complain(kBadInput,
                    "nobody could start this run, which is to wait for that: add --view or --watch, or "
                    "<desk lcm=…> in the file");
  const auto mixed = join_real_robots(loader.catalog(), made, guarded, hub_faults.value(), clock, stop, options.anyway,
                                      mixed_options, code);
  if (code != kDone) return stop.load() ? interrupted_code() : code;
  if (mixed != nullptr && outputs.record != nullptr) {
    if (const hal::Status added = record_ledgers(*outputs.record, *mixed); !added.ok())
      return complain(kFailedRunning, added.error().message);
  }
  const core::SpaceInputs* const from_outside = mixed != nullptr  ? &mixed->inputs()
                                                : replay.wanted() ? replay.inputs()
                                                                  : nullptr;
  if (outputs.record != nullptr && from_outside != nullptr) {
    if (const hal::Status written = outputs.record->set_inputs(world->space(), *from_outside); !written.ok())
      return complain(kFailedRunning, written.error().message);
  }

  const auto lockstep = join_peers(*world, loader, stop, world_options.log, code);
  if (code != kDone) return stop.load() ? interrupted_code() : code;

  RunResult result{*world, inputs, {}, world->space().robot_count(), {}, nullptr};
  result.figures.threads = world->threads();
  result.figures.init_s = wall_seconds() - began;
  const auto live =
      hold_run(options, *world, steps, repeated.value(), lockstep != nullptr, stop, mixed.get(), world_options.log);
  bool as_before = true;  // as in the run that is repeated
  std::optional<mixed_reality::MixedReport> real;
  std::vector<std::string> left;  // robots whose stop nobody has confirmed
  {
    std::optional<Progress> progress;
    std::optional<Watch> watch;
    if (options.watch.watch) {
      Watch::Run watched{*live, *world, steps, {}, &request_stop};
      if (mixed != nullptr) {
        watched.real = [&mixed] { return mixed->status(); };
        watched.roll = [&mixed] { return mixed->roll_call(); };
      }
      watch.emplace(options.watch, watched);
    } else {
      progress.emplace(steps, scenario->ticks_per_second);
    }
    Recording recording(outputs, result, mixed.get(), watchdog);
    std::optional<CommandLog> commands;
    if (live != nullptr) commands.emplace([&run_log](std::string_view text) { run_log.keep(text); }, *live);
    std::optional<Desks> desks;
    std::unique_ptr<RunView> view;
    std::optional<ScriptWatch> scripts;
    if (mixed != nullptr) {
      desks.emplace(*live, *mixed, *commands, stop);
      desks->on_done([&](const hal::Json& action) {  // of real robots: nobody can do it again
        const hal::Json event = {{"kind", "action"}, {"action", action}, {"repeatable", false}};
        recording.event(world->tick(), event);
        if (view != nullptr) view->event(world->tick(), event);
      });
      desks->on_first_motion([&guarded](const mixed_reality::PreflightRows& rows) {
        if (const hal::Status kept = keep_motions(guarded.robots(), rows); !kept.ok()) say(kept.error().message);
      });
      if (const hal::Status listens = desks->listen(scenario->desk, options.hold.desk_keys); !listens.ok())
        return complain(kFailedRunning, listens.error().message);
    }
    if (options.view.on) {
      ViewedRun viewed{*world,
                       *live,
                       loader.catalog(),
                       mixed.get(),
                       [&] { return recording.drawing(); },
                       desks ? &*desks : nullptr,
                       commands ? &*commands : nullptr};
      auto made_view = RunView::open(options.view, viewed);
      if (!made_view.ok()) return complain(kBadInput, made_view.error().message);
      view = std::move(made_view).value();
      live->on_show([&] { view->show(); });
      run_log.tell_also([&](std::string_view text) { view->log(text); });
      if (!replay.wanted()) scripts.emplace(*live, *world, world_options.log);
    }
    if (live != nullptr) {
      live->on_event([&](hal::Tick tick, const hal::Json& event) {
        recording.event(tick, event);
        if (view != nullptr) view->event(tick, event);
      });
    }
    const auto after_tick = [&](core::World& w) {
      recording.tick_done();
      if (progress) progress->step(w.tick());
      if (replay.wanted()) {
        as_before = replay.tick_done(repeated.value(), w) && as_before;
        if (const std::string changes = replay.next_tick(w); !changes.empty())
          recording.event(w.tick(), {{"kind", "what if"}, {"text", changes}});
      } else if (as_before && !as_recorded(repeated.value(), w)) {
        as_before = false;
        complain(kFailedRunning, fmt::format("tick {} is not as in {}: another experiment, program or plug-in, or the "
                                             "run was not a repeatable one",
                                             w.tick() - 1, options.repeat));
      }
      if (live != nullptr && mixed != nullptr) (void)live->after_step();
      if (view != nullptr) view->tick_done();
    };
    look = [&] {
      live->look();
      if (view != nullptr) view->stand();
    };
    if (mixed != nullptr) {
      (void)mixed->run(steps, stop, after_tick);  // a failure is the world's, and told below
    } else if (live != nullptr) {
      result.figures.deadline_misses = run_held(*world, *live, after_tick);
    } else {
      result.figures.deadline_misses = run_alone(*world, steps, stop, clock, after_tick);
    }
    look = {};
    scripts.reset();
    recording.measure();
    if (live != nullptr) live->close();
    run_log.tell_also({});
  }
  const bool was_guarded = guarded.guarded();
  if (mixed != nullptr) {
    mixed->shut_down();
    run_log.end_robots();
    real = mixed->report();
    result.real = &*real;
    result.figures.deadline_misses = real->pace.deadline_misses;
    left = guarded.release_rested();
  }
  if (replay.wanted()) {
    as_before = replay.finish(*world) && as_before;
    result.replay = replay.json();
    result.more_rows = replay.rows();
  }
  result.end = end_of(*world, steps, stop.load(std::memory_order_relaxed));
  const RunEnd reached = result.end;
  if (reached.how != Ended::Failed) {
    result.end.failure = failure_besides(*world, as_before, live.get(), was_guarded, left);
    if (!result.end.failure.empty()) result.end.how = Ended::Failed;
  }
  std::optional<mixed_reality::LockstepReport> peers;
  if (lockstep != nullptr) {
    peers = lockstep->report();
    result.peers = &*peers;
    lockstep->finish(!reached.finished(), reached.finished() ? "the run is over" : "the run ended early");
  }
  if (reached.how == Ended::Failed) complain(kFailedRunning, reached.failure);
  if (reached.how == Ended::Interrupted) say(fmt::format("interrupted at tick {}", world->tick()));
  const bool table = !options.quiet && options.report != "-";
  const bool written = write_results(outputs, result, table);
  run_log.results_done();
  if (live != nullptr && !live->failure().empty()) complain(kFailedRunning, live->failure());
  if (result.end.how == Ended::Failed || !written) return kFailedRunning;
  const bool until_interrupted = options.view.on && options.hold.stay;  // that is how such a run ends
  return result.end.how == Ended::Interrupted && !until_interrupted ? interrupted_code() : kDone;
}

}  // namespace

int run(const RunOptions& options) {
  std::unique_ptr<RunLog> log;
  int code = run_with(options, log);
  if (log == nullptr || !log->over()) return code;
  if (const hal::Status logged = log->close(); !logged.ok()) code = complain(kFailedRunning, logged.error().message);
  if (code == kDone && log->late_errors() > 0)
    code = complain(kFailedRunning, "a controller or hook failed at its end, as told above; the results stand");
  return code;
}

}  // namespace tandem::app
