// Measures cases of a scene, each in a process of its own, so that no run inherits memory from the one before.
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <fmt/format.h>
#include <optional>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include "app/build_info.hpp"
#include "app/exit_code.hpp"
#include "app/module/modules.hpp"
#include "app/outputs/run_figures.hpp"
#include "app/process/measure.hpp"
#include "app/process/terminal.hpp"
#include "bench/bench.hpp"
#include "bench/comparison.hpp"
#include "bench/gnuplot.hpp"
#include "hal/output_file.hpp"
#include "hal/temporary_folder.hpp"

namespace tandem::bench {
namespace {

struct Measurement {
  int code = app::kDone;
  std::string line;  ///< one JSON object without a line break; empty when interrupted or when the world cannot be made
};

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

Measurement measure(const BenchCase& c, const Call& call) {
  const double began = app::wall_seconds();
  const double rss_before = app::peak_rss_mb();
  const core::Scenario scenario = scene_of(c);
  auto world = world_of(scenario, call.loader);
  if (world == nullptr) return {app::kBadInput, {}};
  world->start();
  world->step();  // first touch of every page belongs to the preparation
  const double init_s = app::wall_seconds() - began;

  app::RunFigures figures = time_loop(*world, c, call.stop);
  figures.init_s = init_s;
  const bool failed = world->state() == core::RunState::Failed;
  if (!failed && figures.steps < c.ticks) return {};  // a part of a benchmark is none

  hal::Json json = {{"bench", c.bench},
                    {"robot", c.robot},
                    {"engine", c.engine},
                    {"partition", c.partition.name},
                    {"regions", c.partition.regions},
                    {"devices", c.devices},
                    {"density", c.density},
                    {"assignment", c.dynamic ? "dynamic" : "static"},
                    {"ticks", c.ticks},
                    {"repeat", c.repeat}};
  const auto robots = static_cast<std::size_t>(c.robots);
  app::add_run_fields(json, *world, figures, robots);
  json["cpu_ns_per_robot_step"] = figures.ns_per_robot_step(robots);
  json["wall_ns_per_robot_step"] =
      figures.wall_s * 1e9 / (static_cast<double>(c.robots) * static_cast<double>(figures.steps));
  json["speedup"] = figures.wall_s > 0.0 ? figures.cpu_s / figures.wall_s : 0.0;
  json["bytes_per_robot"] = (app::peak_rss_mb() - rss_before) * 1e6 / static_cast<double>(c.robots);
  json["cpu_model"] = app::build_info().processor;
  json["cores"] = static_cast<std::int64_t>(std::thread::hardware_concurrency());
  if (failed) json["failure"] = world->failure();
  const double closing = app::wall_seconds();
  world.reset();
  json["close_s"] = app::wall_seconds() - closing;
  return {failed ? app::kFailedRunning : app::kDone, hal::to_text(json)};
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

/// Its problems go to standard error. Ends early, without a line, once the call is to stop.
hal::Result<Measurement> measure_apart(const BenchCase& c, const Call& call) {
  const auto fail = [&](const char* why) { return hal::Error{fmt::format("the run of {} robots {}", c.robots, why)}; };
  int ends[2];
  if (pipe(ends) != 0) return fail("cannot be started: no pipe can be made");
  const pid_t child = fork();
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    close(ends[0]);
    const Measurement measured = measure(c, call);
    const auto size = static_cast<ssize_t>(measured.line.size());  // less than a pipe holds
    _exit(write(ends[1], measured.line.data(), measured.line.size()) == size ? measured.code : app::kFailedRunning);
  }
  close(ends[1]);
  Measurement measured;
  if (child > 0) measured.line = read_all(ends[0], child, call.stop);
  close(ends[0]);
  if (child < 0) return fail("cannot be started: no process can be made");
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  if (!WIFEXITED(status)) return fail("was killed; is there memory enough?");
  measured.code = WEXITSTATUS(status);
  return measured;
}

/// How long runs take, roughly before the first, from those that are done later on.
class Forecast {
 public:
  explicit Forecast(const std::vector<BenchCase>& cases)
      : cases_(cases), shown_(isatty(STDERR_FILENO) != 0 && cases.size() > 1) {
    std::int64_t largest = 0;
    for (const BenchCase& c : cases) largest = std::max(largest, c.robots);
    if (const double all_s = expected_s(0); all_s > kWorthTelling_s)
      app::say(fmt::format("{} runs of up to {} robots: about {}", cases.size(), largest, duration_text(all_s)));
  }
  /// Shows where the benchmark is, on a terminal alone.
  void begin(std::size_t run) {
    began_s_ = app::wall_seconds();
    if (!shown_) return;
    fmt::print(stderr, "\r\033[Krun {} of {}, {} robots; about {} left", run + 1, cases_.size(), cases_[run].robots,
               duration_text(expected_s(run)));
    std::fflush(stderr);
  }
  void end(std::size_t run) {
    if (shown_) fmt::print(stderr, "\r\033[K");
    took_s_ += app::wall_seconds() - began_s_;
    guessed_s_ += guess_s(cases_[run]);
  }

 private:
  static constexpr double kWorthTelling_s = 10.0;

  /// Processor time of a core of the 2020s [docs/performance.md].
  static double guess_s(const BenchCase& c) {
    return 0.1 + 1e-6 * static_cast<double>(c.robots) * static_cast<double>(c.ticks);
  }
  double expected_s(std::size_t from) const {
    double sum_s = 0.0;
    for (std::size_t i = from; i < cases_.size(); ++i) sum_s += guess_s(cases_[i]);
    return guessed_s_ > 0.0 ? sum_s * took_s_ / guessed_s_ : sum_s;
  }
  static std::string duration_text(double seconds) {
    if (seconds < 100.0) return fmt::format("{:.0f} s", std::ceil(seconds));
    if (seconds < 6000.0) return fmt::format("{:.0f} minutes", std::ceil(seconds / 60.0));
    return fmt::format("{:.1f} hours", seconds / 3600.0);
  }

  const std::vector<BenchCase>& cases_;
  bool shown_;
  double began_s_ = 0.0, took_s_ = 0.0, guessed_s_ = 0.0;
};

/// Results, or why there are none: with the exit code alone where that has been said.
struct Lines {
  int code = app::kDone;
  std::vector<ResultLine> lines = {};
};

/// Prints each line as soon as it is there. None when interrupted.
hal::Result<Lines> measure_all(const std::vector<BenchCase>& cases, const Call& call) {
  Lines all;
  Forecast forecast(cases);
  for (std::size_t run = 0; run < cases.size(); ++run) {
    if (call.stop.load(std::memory_order_relaxed)) return Lines{};
    forecast.begin(run);
    const auto measured = measure_apart(cases[run], call);
    forecast.end(run);
    if (!measured.ok()) return measured.error();
    if (!measured.value().line.empty()) {
      fmt::print("{}\n", measured.value().line);
      std::fflush(stdout);
    }
    if (measured.value().code != app::kDone || measured.value().line.empty()) return Lines{measured.value().code};
    auto line = parse_result_line(measured.value().line);
    if (!line.ok()) return line.error();
    line->number = static_cast<std::int64_t>(all.lines.size()) + 1;
    all.lines.push_back(std::move(line).value());
  }
  return all;
}

template <class T>
bool chosen(const std::vector<T>& wanted, const T& value) {
  return wanted.empty() || std::find(wanted.begin(), wanted.end(), value) != wanted.end();
}

/// The saved lines that the options choose. Error: there are none, or they do not go together.
hal::Result<std::vector<ResultLine>> choose_saved(const Call& call) {
  const BenchOptions& o = call.options;
  auto saved = read_result_lines(o.from);
  if (!saved.ok()) return saved.error();
  std::vector<std::string> splits;
  for (const Partition& p : call.partitions) splits.push_back(p.regions);
  std::erase_if(saved.value(), [&](const ResultLine& line) {
    return !chosen(call.engines, line.engine) || !chosen(splits, line.regions) || !chosen(call.robots, line.robots) ||
           !chosen(call.threads, line.threads) || (!o.density.empty() && o.density != line.density) ||
           (!o.assignment.empty() && o.assignment != line.assignment);
  });
  if (saved->empty()) return hal::Error{o.from + ": error: none of its lines is what the other options choose"};
  const hal::Status alike = check_alike(saved.value(), o.from);
  return alike.ok() ? saved : alike.error();
}

hal::Result<Lines> lines_of(const Call& call) {
  if (!call.options.from.empty()) {
    auto saved = choose_saved(call);
    return saved.ok() ? Lines{app::kDone, std::move(saved).value()}
                      : Lines{refuse(app::kBadInput, saved.error().message)};
  }
  if (call.options.name == "argos") {
    if (const hal::Status there = app::need_module(call.loader, "argos3"); !there.ok()) return there.error();
  }
  if (call.options.name != "lua") return measure_all(cases_of(call), call);
  const hal::TemporaryFolder folder("tandem_bench");
  const std::string script = folder.file("diffusion.lua");
  const hal::Status written =
      hal::write_whole_file(script, "script", hal::carried_text(scene_files(), "diffusion.lua"));
  return written.ok() ? measure_all(cases_of(call, script), call) : written.error();
}

}  // namespace

hal::Result<int> bench_scene(const Call& call) {
  std::optional<hal::OutputFile> plot;
  if (!call.options.plot.empty()) {
    if (const hal::Status drawable = core::can_draw_figures(); !drawable.ok()) return drawable.error();
    auto opened = hal::OutputFile::open(call.options.plot, "figure");
    if (!opened.ok()) return refuse(app::kBadInput, opened.error().message);
    plot = std::move(opened).value();
  }
  const auto all = lines_of(call);
  if (!all.ok()) return all.error();
  const std::vector<ResultLine>& lines = all.value().lines;
  if (lines.empty()) return all.value().code;
  if (call.options.compare_threads) {  // standard output is for the lines
    for (const auto& [group, ratios] : compare_threads(lines)) fmt::print(stderr, "{}: {}\n", group, ratios);
  }
  if (!plot) return app::kDone;
  const std::string script = gnuplot_script(figure_of(lines), core::figure_format(plot->path()).value());
  const hal::Status drawn = core::draw_figure(script, *plot);
  return drawn.ok() ? hal::Result<int>(app::kDone) : drawn.error();
}

}  // namespace tandem::bench
