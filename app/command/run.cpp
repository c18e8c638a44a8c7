#include <algorithm>
#include <cstdio>
#include <fmt/format.h>

#include "app/catalog.hpp"
#include "app/command/command.hpp"
#include "app/measure.hpp"
#include "app/progress.hpp"
#include "app/report.hpp"
#include "app/run_figures.hpp"
#include "app/sha256.hpp"
#include "app/signals.hpp"
#include "bridges/epuck/guardian.hpp"
#include "bridges/eyebot/guardian.hpp"
#include "bridges/footbot/guardian.hpp"
#include "bridges/link/link_text.hpp"
#include "core/config/xml.hpp"
#include "core/record/trajectory.hpp"
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

std::unique_ptr<core::TrajectoryRecorder> open_trajectory(const RunOptions& options, const core::Scenario& scenario,
                                                          const core::World& world, int& code) {
  auto config = scenario.trajectory;
  if (!options.trajectory.empty()) {
    if (!config) config = core::TrajectoryConfig{{}, {"*"}, 1};
    config->path = options.trajectory;
  }
  if (!config) return nullptr;
  auto opened = core::TrajectoryRecorder::open(*config, world.space(), world.ticks_per_second());
  if (opened.ok()) return std::move(opened).value();
  fmt::print(stderr, "error: {}\n", opened.error().message);
  code = kBadInput;
  return nullptr;
}

void add_real_robots(Json& json, const mixed_reality::MixedReport& report) {
  json.key("real_robots").begin_array();
  for (const mixed_reality::RealRobotReport& r : report.robots) {
    json.begin_object();
    json.field("id", r.id)
        .field("link", r.link)
        .field("x_m", r.pose.x_m)
        .field("y_m", r.pose.y_m)
        .field("heading_rad", r.pose.heading_rad());
    json.field("state", r.state).field("driving", r.driving).field("stop_confirmed", r.stop_confirmed);
    json.field("ticks_driving", r.counts.ticks_driving)
        .field("ticks_held", r.counts.ticks_held)
        .field("stops", r.counts.stops);
    json.field("rearms", r.counts.rearms).field("fenced_ticks", r.counts.fenced_ticks);
    json.field("packets", r.conversation.packets)
        .field("answers", r.conversation.answers)
        .field("time_outs", r.conversation.time_outs);
    json.field("bad_answers", r.conversation.bad_answers).field("resynchronised", r.conversation.resynchronised);
    json.field("links_lost", r.conversation.links_lost);
    json.key("incidents").begin_array();
    for (const std::string& what : r.incidents) json.value(what);
    json.end_array().end_object();
  }
  json.end_array();
  json.key("pace").begin_object();
  json.field("ticks", report.pace.ticks)
      .field("deadline_misses", report.pace.deadline_misses)
      .field("skipped_slots", report.pace.skipped_slots);
  json.field("largest_lateness_ms", static_cast<double>(report.pace.largest_lateness_ns) * 1e-6);
  json.field("wake_up_p99_ms", static_cast<double>(report.pace.wake_up.quantile_ns(0.99)) * 1e-6);
  json.field("step_p99_ms", static_cast<double>(report.pace.step.quantile_ns(0.99)) * 1e-6);
  json.end_object();
}

std::string report_of(const core::World& world, const hal::PluginLoader& loader, const RunFigures& figures,
                      std::size_t robots, const mixed_reality::MixedReport* real) {
  Json json;
  json.begin_object();
  add_run_fields(json, world, figures, robots);
  json.field("finished", world.state() != core::RunState::Failed);
  if (!world.failure().empty()) json.field("failure", world.failure());
  json.key("controllers").begin_array();
  for (const core::ControllerConfig& config : world.scenario().controllers) {
    const auto file = loader.find(config.library);
    if (!file.ok()) continue;
    const auto digest = sha256_of_file(file.value().string());
    json.begin_object().field("id", config.id).field("label", config.label).field("file", file.value().string());
    if (digest.ok()) json.field("sha256", digest.value());
    json.end_object();
  }
  json.end_array();
  const core::Incidents& incidents = world.incidents();
  json.key("incidents").begin_object();
  json.field("commands_clamped", incidents.commands_clamped)
      .field("commands_not_finite", incidents.commands_not_finite)
      .field("controllers_thrown", incidents.controllers_thrown)
      .field("bodies_escaped", incidents.bodies_escaped);
  json.key("first").begin_array();
  for (const std::string& what : incidents.first) json.value(what);
  json.end_array().end_object();
  if (real != nullptr) add_real_robots(json, *real);
  json.field("settings", core::to_xml(world.scenario().effective));
  json.end_object();
  return json.text();
}

void print_result(const core::World& world, const RunFigures& figures, std::size_t robots,
                  const mixed_reality::MixedReport* real) {
  const core::Incidents& incidents = world.incidents();
  const double virtual_s = figures.virtual_s(world.ticks_per_second());
  std::vector<std::pair<std::string, std::string>> rows = {
      {"experiment", fmt::format("{}, seed {}", world.scenario().name, world.seed())},
      {"robots", fmt::format("{}", robots)},
      {"time",
       fmt::format("{:.1f} s in {} steps, taking {:.2f} s ({:.1f} times real time) after {:.2f} s of preparation",
                   virtual_s, figures.steps, figures.wall_s, figures.wall_s > 0 ? virtual_s / figures.wall_s : 0.0,
                   figures.init_s)},
      {"cost", fmt::format("{:.0f} ns of processor time a robot and step, {:.0f} MB", figures.ns_per_robot_step(robots),
                           peak_rss_mb())},
      {"state", hash_text(world.state_hash())}};
  if (world.scenario().time_mode == core::TimeMode::Realtime)
    rows.emplace_back("missed deadlines", fmt::format("{}", figures.deadline_misses));
  const std::uint64_t odd = incidents.commands_clamped + incidents.commands_not_finite + incidents.controllers_thrown +
                            incidents.bodies_escaped;
  if (odd > 0) {
    rows.emplace_back("incidents",
                      fmt::format("{} commands clamped, {} not finite, {} controllers threw, {} bodies escaped",
                                  incidents.commands_clamped, incidents.commands_not_finite,
                                  incidents.controllers_thrown, incidents.bodies_escaped));
  }
  if (real != nullptr) {
    for (const mixed_reality::RealRobotReport& r : real->robots) {
      rows.emplace_back(
          "real robot",
          fmt::format("{} on {}: {}; {} ticks driving, {} held, {} of {} packets answered, {}", r.id, r.link, r.state,
                      r.counts.ticks_driving, r.counts.ticks_held, r.conversation.answers, r.conversation.packets,
                      r.stop_confirmed ? "stop confirmed" : "STOP NOT CONFIRMED"));
    }
  }
  print_table(rows);
}

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
bool write_results(const RunOptions& options, const core::World& world, const hal::PluginLoader& loader,
                   const RunFigures& figures, std::size_t robots, const mixed_reality::MixedReport* real) {
  bool good = true;
  const auto complain = [&good](const hal::Status& status) {
    if (status.ok()) return;
    good = false;
    fmt::print(stderr, "error: {}\n", status.error().message);
  };
  if (!options.picture.empty()) {
    core::PictureOptions picture;
    picture.experiment = world.scenario().name;
    picture.seed = world.seed();
    picture.time_ns = hal::time_of_tick(world.tick(), world.ticks_per_second());
    for (const auto& r : real != nullptr ? real->robots : std::vector<mixed_reality::RealRobotReport>{}) {
      if (!r.driving) picture.trouble.push_back({r.robot, r.state});
    }
    complain(core::write_picture(world.space(), options.picture, picture));
  }
  if (!options.report.empty()) complain(write_report(options.report, report_of(world, loader, figures, robots, real)));
  if (!options.quiet && options.report != "-") print_result(world, figures, robots, real);
  return good;
}

}  // namespace

int run(const RunOptions& options) {
  const double began = wall_seconds();
  const auto scenario = read_or_complain(options.experiment, options.overrides);
  if (!scenario) return kBadInput;

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
  int code = kDone;
  const auto trajectory = open_trajectory(options, *scenario, *world, code);
  if (code != kDone) return code;

  const std::atomic<bool>& stop = catch_signals();
  mixed_reality::MonotonicTime clock;
  const auto mixed = join_real_robots(made, watch, clock, stop, world_options.log, code);
  if (code != kDone) return stop.load() ? kDone : code;

  const std::int64_t steps = steps_of(options, *scenario);
  const std::size_t robots = world->space().robot_count();
  RunFigures figures;
  figures.threads = world->threads();
  figures.init_s = wall_seconds() - began;
  const double wall = wall_seconds();
  const double cpu = cpu_seconds();
  hal::Status recorded;
  {
    Progress progress(steps, scenario->ticks_per_second);
    const auto after_tick = [&](core::World& w) {
      if (trajectory != nullptr && recorded.ok() && w.tick() > 0)  // 0: a hook went back to the start
        recorded = trajectory->record(w.space(), w.tick() - 1);    // the tick that was just done
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

  bool failed = world->state() == core::RunState::Failed;
  if (failed) fmt::print(stderr, "error: {}\n", world->failure());
  if (stop.load(std::memory_order_relaxed)) fmt::print(stderr, "interrupted at tick {}\n", world->tick());
  if (trajectory != nullptr) {
    const hal::Status closed = trajectory->close();
    if (!closed.ok()) fmt::print(stderr, "error: {}\n", closed.error().message);
    failed = failed || !closed.ok();
  }
  failed = !write_results(options, *world, loader, figures, robots, real ? &*real : nullptr) || failed;
  return failed ? kFailedRunning : kDone;
}

}  // namespace tandem::app
