#include "bench/measurement.hpp"

#include <cerrno>
#include <csignal>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include "app/build_info.hpp"
#include "app/exit_code.hpp"
#include "app/experiment/reading.hpp"
#include "app/outputs/report.hpp"
#include "app/outputs/run_figures.hpp"
#include "app/process/measure.hpp"
#include "bench/scene.hpp"
#include "core/sim/world.hpp"

namespace tandem::bench {
namespace {

app::RunFigures time_loop(core::World& world, const BenchCase& c, const std::atomic<bool>& stop) {
  app::RunFigures figures;
  figures.threads = c.threads;
  const double wall = app::wall_seconds();
  const double cpu = app::cpu_seconds();
  for (std::int64_t i = 0; i < c.ticks && world.state() == core::RunState::Running; ++i) {
    if (stop.load(std::memory_order_relaxed)) break;
    world.step();
  }
  figures.wall_s = app::wall_seconds() - wall;
  figures.cpu_s = app::cpu_seconds() - cpu;
  figures.steps = world.tick() - 1;
  return figures;
}

void add_case_fields(hal::Json& json, const BenchCase& c) {
  json["bench"] = c.bench;
  json["robot"] = c.robot;
  json["engine"] = c.engine;
  json["partition"] = c.partition;
  json["regions"] = c.regions;
  json["devices"] = c.devices;
  json["density"] = c.density;
  json["assignment"] = assignment_word(c.assignment);
  json["ticks"] = c.ticks;
  json["repeat"] = c.repeat;
}

void add_machine_fields(hal::Json& json) {
  json["cpu_model"] = app::build_info().processor;
  json["cores"] = static_cast<std::int64_t>(std::thread::hardware_concurrency());
}

Measurement measure(const BenchCase& c, hal::PluginLoader& loader, const std::atomic<bool>& stop) {
  const double began = app::wall_seconds();
  const double rss_before = app::peak_rss_mb();
  const core::Scenario scenario = scene_of(c);
  core::Problems problems;
  auto world = core::World::make(scenario, loader, {}, problems);
  app::print_problems(problems);
  if (world == nullptr) return {app::kBadInput, {}};
  world->start();
  world->step();  // first touch of every page belongs to the preparation
  const double init_s = app::wall_seconds() - began;

  app::RunFigures figures = time_loop(*world, c, stop);
  figures.init_s = init_s;
  const bool failed = world->state() == core::RunState::Failed;
  if (!failed && figures.steps < c.ticks) return {app::kDone, {}};  // a part of a benchmark is none

  hal::Json json;
  add_case_fields(json, c);
  const auto robots = static_cast<std::size_t>(c.robots);
  app::add_run_fields(json, *world, figures, robots);
  const double robot_steps = static_cast<double>(c.robots) * static_cast<double>(figures.steps);
  json["cpu_ns_per_robot_step"] = figures.ns_per_robot_step(robots);
  json["wall_ns_per_robot_step"] = figures.wall_s * 1e9 / robot_steps;
  json["speedup"] = figures.wall_s > 0.0 ? figures.cpu_s / figures.wall_s : 0.0;
  json["bytes_per_robot"] = (app::peak_rss_mb() - rss_before) * 1e6 / static_cast<double>(c.robots);
  add_machine_fields(json);
  if (failed) json["failure"] = world->failure();
  const double closing = app::wall_seconds();
  world.reset();
  json["close_s"] = app::wall_seconds() - closing;
  return {failed ? app::kFailedRunning : app::kDone, hal::to_text(json)};
}

void write_all(int fd, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t n = write(fd, text.data() + done, text.size() - done);
    if (n < 0 && errno != EINTR) return;  // nobody listens any more
    if (n > 0) done += static_cast<std::size_t>(n);
  }
}

/// Everything that the child writes until it ends; it is told when `stop` is set. Telling it twice does no harm.
std::string read_all(int fd, pid_t child, const std::atomic<bool>& stop) {
  constexpr int kLook_ms = 200;  // a signal may come between looking at `stop` and waiting
  std::string text;
  char buffer[4096];
  for (;;) {
    pollfd wanted{fd, POLLIN, 0};
    const int ready = poll(&wanted, 1, kLook_ms);
    if (stop.load(std::memory_order_relaxed)) kill(child, SIGTERM);
    if (ready <= 0) continue;
    const ssize_t n = read(fd, buffer, sizeof buffer);
    if (n == 0 || (n < 0 && errno != EINTR)) return text;
    if (n > 0) text.append(buffer, static_cast<std::size_t>(n));
  }
}

}  // namespace

Measurement measure_apart(const BenchCase& c, hal::PluginLoader& loader, const std::atomic<bool>& stop) {
  const auto fail = [&](const char* why) {
    fmt::print(stderr, "tandem bench: the run of {} robots {}\n", c.robots, why);
    return Measurement{app::kFailedRunning, {}};
  };
  int ends[2];
  if (pipe(ends) != 0) return fail("cannot be started: no pipe can be made");
  const pid_t child = fork();
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    close(ends[0]);
    const Measurement measured = measure(c, loader, stop);
    write_all(ends[1], measured.line);
    _exit(measured.code);
  }
  close(ends[1]);
  Measurement measured;
  if (child > 0) measured.line = read_all(ends[0], child, stop);
  close(ends[0]);
  if (child < 0) return fail("cannot be started: no process can be made");
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!WIFEXITED(status)) return fail("was killed; is there memory enough?");
  measured.code = WEXITSTATUS(status);
  return measured;
}

}  // namespace tandem::bench
