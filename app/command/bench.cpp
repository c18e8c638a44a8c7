// `tandem bench diffusion`: the standard scene of Pinciroli et al. (2012), section 4.1, one JSON object a line.
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "app/catalog.hpp"
#include "app/command/command.hpp"
#include "app/measure.hpp"
#include "app/report.hpp"
#include "app/signals.hpp"
#include "core/sim/world.hpp"

namespace tandem::app {
namespace {

constexpr double kArena_m = 40.0;
constexpr double kUsualRobots = 10'000.0;  // what "equal density" refers to
constexpr double kWall_m = 0.1;

core::ObjectItem wall(double x_m, double y_m, double size_x_m, double size_y_m, std::size_t number) {
  core::ObjectItem item;
  item.id = "wall" + std::to_string(number);
  item.size = {size_x_m, size_y_m, 0.5};
  item.placement.p_W = {x_m, y_m, 0.0};
  return item;
}

/// Outer walls, and inner ones at +-7 m that make 3 x 3 rooms with doors between; all but the walls' thickness times
/// `scale`.
void add_walls(core::Scenario& scenario, double scale) {
  auto& objects = scenario.objects;
  const double half = 0.5 * kArena_m * scale;
  for (const double side : {-1.0, 1.0}) {
    objects.push_back(wall(side * half, 0.0, kWall_m, 2.0 * half + kWall_m, objects.size()));
    objects.push_back(wall(0.0, side * half, 2.0 * half + kWall_m, kWall_m, objects.size()));
  }
  constexpr double kParts[4][2] = {{-20.0, -15.0}, {-12.0, -1.5}, {1.5, 12.0}, {15.0, 20.0}};
  for (const double line : {-7.0, 7.0}) {
    for (const auto& part : kParts) {
      const double middle = 0.5 * (part[0] + part[1]) * scale;
      const double length = (part[1] - part[0]) * scale;
      objects.push_back(wall(line * scale, middle, kWall_m, length, objects.size()));
      objects.push_back(wall(middle, line * scale, length, kWall_m, objects.size()));
    }
  }
}

core::Scenario diffusion(const BenchOptions& options, std::int64_t robots, std::int64_t threads) {
  core::Scenario scenario;
  scenario.file = "bench diffusion";
  scenario.name = "diffusion";
  scenario.seed = 1;
  scenario.ticks_per_second = 10;
  scenario.threads = threads;
  const double scale = options.density == "equal" ? std::sqrt(static_cast<double>(robots) / kUsualRobots) : 1.0;
  scenario.arena_size = {kArena_m * scale + kWall_m, kArena_m * scale + kWall_m, 1.0};
  add_walls(scenario, scale);

  core::ControllerConfig config;
  config.id = "diffusion";
  config.label = "epuck_diffusion";
  config.library = "epuck_diffusion";
  config.sensors.push_back({"proximity", "default", {}});
  config.actuators.push_back({"differential_steering", "default", {}});
  scenario.controllers.push_back(config);

  core::RobotItem item;
  item.kind = options.robot;
  item.id = "ep";
  core::Distribute d;
  d.quantity = robots;
  d.max_trials = 10'000;
  d.position.method = core::Distribution::Method::Uniform;
  const double half = 0.5 * kArena_m * scale - std::min(0.2, 0.05 * kArena_m * scale);
  d.position.min = {-half, -half, 0.0};
  d.position.max = {half, half, 0.0};
  d.orientation.method = core::Distribution::Method::Uniform;
  d.orientation.min = {-M_PI, 0.0, 0.0};
  d.orientation.max = {M_PI, 0.0, 0.0};
  item.distribute = d;
  scenario.robots.push_back(item);
  return scenario;
}

int bench_once(const BenchOptions& options, std::int64_t robots, std::int64_t threads, const std::atomic<bool>& stop) {
  const double began = wall_seconds();
  const double rss_before = peak_rss_mb();
  const core::Scenario scenario = diffusion(options, robots, threads);
  hal::PluginLoader loader(plugin_folders());
  core::Problems problems;
  auto world = core::World::make(scenario, loader, {}, problems);
  print_problems(problems);
  if (world == nullptr) return kBadInput;
  world->start();
  world->step();  // first touch of every page belongs to the preparation

  RunFigures figures;
  figures.threads = threads;
  figures.init_s = wall_seconds() - began;
  const double wall = wall_seconds();
  const double cpu = cpu_seconds();
  for (std::int64_t i = 0; i < options.ticks && world->state() == core::RunState::Running; ++i) {
    if (stop.load(std::memory_order_relaxed)) return kDone;  // a part of a benchmark is none
    world->step();
  }
  figures.wall_s = wall_seconds() - wall;
  figures.cpu_s = cpu_seconds() - cpu;
  figures.steps = world->tick() - 1;

  Json json;
  json.begin_object();
  json.field("bench", "diffusion")
      .field("robot", options.robot)
      .field("engine", options.engine)
      .field("density", options.density.empty() ? "40 m" : options.density);
  add_run_fields(json, *world, figures, static_cast<std::size_t>(robots));
  json.field("wall_ns_per_robot_step",
             figures.wall_s * 1e9 / static_cast<double>(robots) / static_cast<double>(figures.steps));
  json.field("speedup", figures.wall_s > 0.0 ? figures.cpu_s / figures.wall_s : 0.0);
  json.field("bytes_per_robot", (peak_rss_mb() - rss_before) * 1e6 / static_cast<double>(robots));
  const double closing = wall_seconds();
  const bool failed = world->state() == core::RunState::Failed;
  if (failed) json.field("failure", world->failure());
  world.reset();
  json.field("close_s", wall_seconds() - closing).end_object();
  fmt::print("{}\n", json.text());
  std::fflush(stdout);
  return failed ? kFailedRunning : kDone;
}

/// Runs in a process of its own, so that no run inherits memory from the one before.
int bench_apart(const BenchOptions& options, std::int64_t robots, std::int64_t threads, const std::atomic<bool>& stop) {
  const pid_t child = fork();
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    _exit(bench_once(options, robots, threads, stop));
  }
  int status = 0;
  while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR) {
    if (stop.load(std::memory_order_relaxed)) kill(child, SIGTERM);  // it may have been told already: no harm
  }
  if (child > 0 && WIFEXITED(status)) return WEXITSTATUS(status);
  fmt::print(stderr, "tandem bench: the run of {} robots {}\n", robots,
             child < 0 ? "cannot be started: no process can be made" : "was killed; is there memory enough?");
  return kFailedRunning;
}

}  // namespace

int bench(const BenchOptions& options) {
  const auto refuse = [](const std::string& why) {
    fmt::print(stderr, "tandem bench: {}\n", why);
    return kWrongUsage;
  };
  if (options.name != "diffusion") return refuse("there is no benchmark '" + options.name + "'; there is: diffusion");
  if (options.engine != "kinematics2d")
    return refuse("there is no engine '" + options.engine + "'; there is: kinematics2d");
  if (options.robot != "e-puck") return refuse("there is no robot '" + options.robot + "'; there is: e-puck");
  if (!options.density.empty() && options.density != "equal") return refuse("--density takes 'equal'");
  const std::atomic<bool>& stop = catch_signals();
  for (const std::int64_t robots :
       options.robots.empty() ? std::vector<std::int64_t>{1, 10, 100, 1000, 10'000, 100'000} : options.robots) {
    for (const std::int64_t threads : options.threads.empty() ? std::vector<std::int64_t>{0} : options.threads) {
      for (std::int64_t i = 0; i < options.repeat; ++i) {
        if (stop.load(std::memory_order_relaxed)) return kDone;
        const int code = bench_apart(options, robots, threads, stop);
        if (code != kDone) return code;
      }
    }
  }
  return kDone;
}

}  // namespace tandem::app
