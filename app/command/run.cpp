#include <algorithm>
#include <cstdio>
#include <fmt/format.h>

#include "app/catalog.hpp"
#include "app/command/command.hpp"
#include "app/measure.hpp"
#include "app/progress.hpp"
#include "app/run_outputs.hpp"
#include "app/run_report.hpp"
#include "app/signals.hpp"
#include "app/terminal.hpp"
#include "bridges/epuck/guardian.hpp"
#include "bridges/eyebot/guardian.hpp"
#include "bridges/footbot/guardian.hpp"
#include "bridges/link/link_text.hpp"
#include "core/sim/world.hpp"
#include "core/view/picture.hpp"
#include "hal/spec/epuck.hpp"
#include "hal/spec/eyebot.hpp"
#include "hal/spec/footbot.hpp"
#include "mixed_reality/epuck/real_epuck.hpp"
#include "mixed_reality/eyebot/real_eyebot.hpp"
#include "mixed_reality/footbot/real_footbot.hpp"
#include "mixed_reality/session/mixed_session.hpp"
#include "mixed_reality/time/pacer.hpp"

namespace tandem::app {
namespace {

constexpr int kWarningsShown = 20;

/// Steps to do; 0: until interrupted or a hook ends the run.
std::int64_t steps_of(const RunOptions& options, const core::Scenario& scenario) {
  if (options.steps) return *options.steps;
  const double seconds = options.seconds.value_or(scenario.length_s);
  const auto steps = static_cast<std::int64_t>(seconds * static_cast<double>(scenario.ticks_per_second) + 0.5);
  return seconds > 0.0 ? std::max<std::int64_t>(1, steps) : 0;  // a duration below a tick is one tick, not endless
}

/// Records what every tick leaves, and hands it to the system twice a second, so that even a killed run leaves all but
/// its last second.
class Recording {
 public:
  /// `trajectory` may be null.
  Recording(core::TrajectoryRecorder* trajectory, double now_s) : trajectory_(trajectory), flushed_s_(now_s) {}

  void tick_done(const core::World& world) {
    if (trajectory_ == nullptr || !state_.ok() || world.tick() == 0) return;  // 0: a hook went back to the start
    state_ = trajectory_->record(world.space(), world.tick() - 1);            // the tick that was just done
    if (const double now_s = wall_seconds(); state_.ok() && now_s >= flushed_s_ + 0.5) {
      state_ = trajectory_->flush();
      flushed_s_ = now_s;
    }
    if (!state_.ok()) complain(kFailedRunning, state_.error().message + "; the run goes on");
  }

 private:
  core::TrajectoryRecorder* trajectory_;
  double flushed_s_;
  hal::Status state_;
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

/// Tells the guardians which robots to stop should this program be killed, or that all of them are stopped.
class Watch {
 public:
  /// Before any thread exists.
  explicit Watch(const core::Scenario& scenario) {
    for (const core::RobotItem& item : scenario.robots) {
      if (item.bridge) robots_.push_back({item.bridge->link, item.kind, nullptr, nullptr});
    }
    const auto any = [this](std::string_view kind) {
      return std::any_of(robots_.begin(), robots_.end(), [&](const Watched& w) { return w.kind == kind; });
    };
    if (any(hal::epuck::kDataSheet.kind)) start(epucks_);
    if (any(hal::footbot::kDataSheet.kind)) start(footbots_);
    if (any(hal::eyebot::kDataSheet.kind)) start(eyebots_);
  }
  /// Remembers the real robot that was made for the next one of its kind in the file; it must live until `end`.
  void note(const mixed_reality::RealFootbot& real) { next(hal::footbot::kDataSheet.kind).footbot = &real; }
  void note(const mixed_reality::RealEyebot& real) { next(hal::eyebot::kDataSheet.kind).eyebot = &real; }

  /// When all answer.
  void begin() {
    for (const Watched& w : robots_) {
      if (w.kind == hal::footbot::kDataSheet.kind) {
        if (footbots_ && w.footbot != nullptr) footbots_->watch(w.link, w.footbot->last_words());
      } else if (w.kind == hal::eyebot::kDataSheet.kind) {
        if (eyebots_ && w.eyebot != nullptr) eyebots_->watch(w.eyebot->last_words());
      } else if (const auto address = bridges::parse_link(w.link); epucks_ && address.ok()) {
        epucks_->watch(address.value().target, address.value().rate);
      }
    }
  }
  /// Robots that confirmed their stop need no guardian any more; those of the report are in the order of the file.
  void end(const mixed_reality::MixedReport& report) {
    for (std::size_t i = 0; i < robots_.size() && i < report.robots.size(); ++i) {
      const Watched& w = robots_[i];
      if (!report.robots[i].stop_confirmed) continue;
      if (w.kind == hal::footbot::kDataSheet.kind) {
        if (footbots_) footbots_->release(w.link);
      } else if (w.kind == hal::eyebot::kDataSheet.kind) {
        // It hovers. It is landed as its bridge ends, and by its guardian where that fails.
      } else if (const auto address = bridges::parse_link(w.link); epucks_ && address.ok()) {
        epucks_->release(address.value().target);
      }
    }
  }

 private:
  struct Watched {
    std::string link;
    std::string kind;
    const mixed_reality::RealFootbot* footbot = nullptr;
    const mixed_reality::RealEyebot* eyebot = nullptr;
  };
  template <class Guardian>
  static void start(std::optional<Guardian>& guardian) {
    auto started = Guardian::start();
    if (started.ok()) {
      guardian.emplace(std::move(started).value());
    } else {
      say("warning: " + started.error().message);
    }
  }
  Watched& next(std::string_view kind) {
    return *std::find_if(robots_.begin(), robots_.end(), [&](const Watched& w) {
      return w.kind == kind && w.footbot == nullptr && w.eyebot == nullptr;
    });
  }

  std::vector<Watched> robots_;
  std::optional<bridges::epuck::Guardian> epucks_;
  std::optional<bridges::footbot::Guardian> footbots_;
  std::optional<bridges::eyebot::Guardian> eyebots_;
};

bool has_real_robots(const core::Scenario& scenario) {
  for (const core::RobotItem& item : scenario.robots) {
    if (item.bridge) return true;
  }
  return false;
}

/// Where a world's real robots take part; null when it has none. `code` is not kDone when they cannot.
std::unique_ptr<mixed_reality::MixedSession> join_real_robots(std::unique_ptr<core::World>& world, Watch& watch,
                                                              mixed_reality::TimeSource& clock,
                                                              const std::atomic<bool>& stop, const hal::Log& log,
                                                              int& code) {
  if (!has_real_robots(world->scenario())) return nullptr;
  mixed_reality::MixedOptions options;
  options.log = log;
  using RealRobotMade = hal::Result<std::unique_ptr<mixed_reality::RealRobot>>;
  const auto maker = [&](const mixed_reality::RealRobotRequest& r) -> RealRobotMade {
    if (r.item.kind == hal::footbot::kDataSheet.kind) {
      auto footbot = mixed_reality::make_real_footbot(r, log);
      if (!footbot.ok()) return footbot.error();
      watch.note(**footbot);
      return std::unique_ptr<mixed_reality::RealRobot>(std::move(footbot).value());
    }
    if (r.item.kind == hal::eyebot::kDataSheet.kind) {
      auto eyebot = mixed_reality::make_real_eyebot(r, log);
      if (!eyebot.ok()) return eyebot.error();
      watch.note(**eyebot);
      return std::unique_ptr<mixed_reality::RealRobot>(std::move(eyebot).value());
    }
    return mixed_reality::make_real_robot(r, log);
  };
  auto made = mixed_reality::MixedSession::make(std::move(world), maker, clock, options);
  if (!made.ok()) {
    fmt::print(stderr, "error: {}\n", made.error().message);
    code = kBadInput;
    return nullptr;
  }
  auto session = std::move(made).value();
  const hal::Status connected = session->connect(stop);
  if (!connected.ok()) {
    fmt::print(stderr, "error: {}\n", connected.error().message);
    code = kFailedRunning;
  }
  watch.begin();
  return session;
}

/// Writes what was asked for at the end of a run. @returns whether all of it could be written.
bool write_results(RunOutputs& outputs, const RunResult& result, bool table) {
  bool good = true;
  const auto check = [&good](const hal::Status& status) {
    if (!status.ok()) good = complain(kFailedRunning, status.error().message) == kDone;
  };
  if (outputs.trajectory != nullptr) check(outputs.trajectory->close());
  if (outputs.picture) {
    core::PictureOptions picture;
    picture.experiment = result.world.scenario().name;
    picture.seed = result.world.seed();
    picture.time_ns = hal::time_of_tick(result.world.tick(), result.world.ticks_per_second());
    for (const auto& r : result.real != nullptr ? result.real->robots : std::vector<mixed_reality::RealRobotReport>{}) {
      if (!r.driving) picture.trouble.push_back({r.robot, r.state});
    }
    check(core::write_picture(result.world.space(), *outputs.picture, picture));
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
  const auto scenario = read_or_complain(options.experiment, options.overrides);
  if (!scenario) return kBadInput;
  if (const hal::Status paths = check_output_paths(options, *scenario); !paths.ok())
    return complain(kBadInput, paths.error().message);

  Watch watch(*scenario);  // before any thread
  hal::PluginLoader loader(plugin_folders());
  int warned = 0;
  core::WorldOptions world_options;
  world_options.seed = options.seed;
  world_options.threads = options.threads;
  world_options.log = hal::Log([&warned](hal::Severity, std::string_view text) {
    if (++warned <= kWarningsShown) say(text);
  });
  core::Problems problems;
  auto made = core::World::make(*scenario, loader, world_options, problems);
  print_problems(problems);
  if (made == nullptr) return kBadInput;
  core::World* const world = made.get();  // a mixed session takes it over
  auto opened = open_outputs(options, *scenario, *world);
  if (!opened.ok()) return complain(kBadInput, opened.error().message);
  RunOutputs& outputs = opened.value();

  int code = kDone;
  const std::atomic<bool>& stop = catch_signals();
  mixed_reality::MonotonicTime clock;
  const auto mixed = join_real_robots(made, watch, clock, stop, world_options.log, code);
  if (code != kDone) return stop.load() ? kDone : code;

  const auto controllers = controller_files(*scenario, loader);
  const std::int64_t steps = steps_of(options, *scenario);
  const std::size_t robots = world->space().robot_count();
  RunFigures figures;
  figures.threads = world->threads();
  figures.init_s = wall_seconds() - began;
  const double wall = wall_seconds();
  const double cpu = cpu_seconds();
  {
    Progress progress(steps, scenario->ticks_per_second);
    Recording recording(outputs.trajectory.get(), wall);
    const auto after_tick = [&](core::World& w) {
      recording.tick_done(w);
      progress.step(w.tick());
    };
    if (mixed != nullptr) {
      (void)mixed->run(steps, stop, after_tick);  // a failure is the world's, and told below
      figures.deadline_misses = mixed->report().pace.deadline_misses;
    } else {
      figures.deadline_misses = run_alone(*world, steps, stop, clock, after_tick);
    }
  }
  figures.wall_s = wall_seconds() - wall;
  figures.cpu_s = cpu_seconds() - cpu;
  figures.steps = world->tick();
  std::optional<mixed_reality::MixedReport> real;
  if (mixed != nullptr) {
    real = mixed->report();
    watch.end(*real);
  }

  const RunResult result{*world,
                         controllers,
                         figures,
                         robots,
                         end_of(*world, steps, stop.load(std::memory_order_relaxed)),
                         real ? &*real : nullptr};
  if (result.end.how == Ended::Failed) complain(kFailedRunning, result.end.failure);
  if (result.end.how == Ended::Interrupted) say(fmt::format("interrupted at tick {}", world->tick()));
  const bool table = !options.quiet && options.report != "-";
  const bool written = write_results(outputs, result, table);
  const bool failed = result.end.how == Ended::Failed || world->incidents().controllers_thrown > 0;
  return failed || !written ? kFailedRunning : kDone;
}

}  // namespace tandem::app
