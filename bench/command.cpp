// `tandem bench`: measures a scene, the foot-bot's codec or how soon eye-bots are answered, prints one JSON object a
// line, draws figures from them.
#include "app/command/command.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <unistd.h>

#include "app/command/shared_options.hpp"
#include "app/experiment/plugins.hpp"
#include "app/module/module_table.hpp"
#include "app/process/measure.hpp"
#include "app/process/signals.hpp"
#include "app/process/terminal.hpp"
#include "bench/back.hpp"
#include "bench/codec.hpp"
#include "bench/comparison.hpp"
#include "bench/gap.hpp"
#include "bench/gnuplot.hpp"
#include "bench/lockstep.hpp"
#include "bench/measurement.hpp"
#include "bench/partition.hpp"
#include "bench/python.hpp"
#include "bench/record.hpp"
#include "bench/script_file.hpp"
#include "bench/sense_to_act.hpp"
#include "bench/sweep.hpp"
#include "bench/view.hpp"
#include "core/device/device.hpp"
#include "core/scenario/engine_traits.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/output_file.hpp"

namespace tandem::bench {
namespace {

/// Lists that are left empty: the usual values when measuring, every saved line with `from`.
struct BenchOptions {
  app::Libraries plugins;
  std::string file;  ///< with kinds of robots that may be measured, too
  std::string name = "diffusion";
  std::vector<std::int64_t> robots;
  std::string robot;                 ///< empty: the benchmark's own
  std::vector<std::string> devices;  ///< besides proximity sensors and wheels
  std::vector<std::string> engines;
  std::vector<std::int64_t> threads;
  std::vector<std::string> partitions;  ///< by name: A1 to A16
  std::vector<std::string> regions;     ///< other splits: "5x3" or "auto"
  std::int64_t ticks = 600;
  std::string density;     ///< "equal": the arena grows with the robots
  std::string assignment;  ///< of work to threads: "static" or "dynamic"
  std::int64_t repeat = 1;
  std::string plot;  ///< SVG or PNG file
  std::string from;  ///< saved lines, instead of measuring
  bool compare_threads = false;
  double seconds = 5.0;    ///< sense_to_act: that are timed
  bool real_time = false;  ///< sense_to_act: with SCHED_FIFO

  void describe(hal::CommandLine& line);
};

int refuse(int code, const std::string& message) {
  app::say("tandem bench: " + message);
  return code;
}

/// What the options ask for, checked.
struct Plan {
  std::vector<std::string> engines;  ///< empty in a plan for saved lines: all that there are; so with the next three
  std::vector<Partition> partitions;
  std::vector<std::int64_t> robots;
  std::vector<std::int64_t> threads;
};

/// "there is no engine 'x'; there are: …" when `name` is none of `known`.
hal::Status check_name(std::string_view what, const std::string& name, const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), name) != known.end()) return {};
  std::string all;
  for (const std::string& k : known) all += (all.empty() ? "" : ", ") + k;
  return hal::Error{
      fmt::format("there is no {} '{}'; there {}: {}", what, name, known.size() == 1 ? "is" : "are", all)};
}

/// The first that there is; for robots that fly the first that is made for them.
std::string usual_engine(const hal::Catalog& catalog, bool flying) {
  const auto engines = catalog.all<core::KnownEngine>();
  for (const core::KnownEngine* engine : engines) {
    if (engine->traits.air == flying) return std::string(engine->kind);
  }
  return std::string(engines.front()->kind);
}

using Kinds = std::vector<core::KindConfig>;

/// Of a file, those that drive and have proximity sensors can be measured, too.
std::vector<std::string> robots_of(const BenchOptions& o, const Kinds& kinds) {
  if (o.name == "flocking") return {"eye-bot"};
  std::vector<std::string> robots{"e-puck", "foot-bot"};
  for (const core::KindConfig& config : kinds) {
    if (config.kind->drive() != nullptr && config.kind->part<hal::ProximityPart>() != nullptr)
      robots.push_back(config.kind->name);
  }
  return robots;
}
std::string robot_of(const BenchOptions& o) {
  return o.robot.empty() ? robots_of(o, {}).front() : o.robot;
}

hal::Status check_words(const hal::Catalog& catalog, const BenchOptions& o, const Kinds& kinds) {
  if (auto s = check_name("benchmark", o.name,
                          {"diffusion", "flocking", "lua", "codec", "record", "sense_to_act", "back", "view", "sweep",
                           "gap", "lockstep", "python"});
      !s.ok())
    return s;
  const std::vector<std::string> robots = robots_of(o, kinds);
  if (auto s = check_name("robot", robot_of(o), robots); !s.ok()) return s;
  std::vector<std::string> devices{"range_and_bearing"};
  if (robot_of(o) == "foot-bot") devices.emplace_back("omnidirectional_camera");
  for (const core::DeviceType* type : catalog.all<core::DeviceType>()) {
    if (type->device == hal::Proximity::kName) devices.push_back("proximity:" + std::string(type->implementation));
  }
  if (o.name == "flocking") devices.clear();
  for (const std::string& device : o.devices) {
    if (auto s = check_name("device of the " + robot_of(o) + " to measure with", device, devices); !s.ok()) return s;
  }
  for (const std::string& engine : o.engines) {
    // Saved lines may come from another build.
    if (auto s = check_name("engine", engine, catalog.names("engine")); !s.ok() && o.from.empty()) return s;
  }
  if (!o.density.empty() && o.density != "equal") return hal::Error{"--density takes 'equal'"};
  if (!o.assignment.empty() && o.assignment != "static" && o.assignment != "dynamic")
    return hal::Error{"--assignment takes static or dynamic, not '" + o.assignment + "'"};
  if (!o.plot.empty()) {
    if (const auto kind = core::figure_format(o.plot); !kind.ok()) return hal::Error{"--plot: " + kind.error().message};
  }
  if (!o.from.empty() && o.plot.empty() && !o.compare_threads)
    return hal::Error{"--from needs --plot FILE or --compare-threads: what to do with the saved lines"};
  if (o.compare_threads && o.from.empty() && o.threads.size() < 2)
    return hal::Error{"--compare-threads needs several numbers of threads, e.g. --threads 0,2"};
  return {};
}

hal::Result<Plan> plan_of(const hal::Catalog& catalog, const BenchOptions& o, const Kinds& kinds) {
  if (auto s = check_words(catalog, o, kinds); !s.ok()) return s.error();
  Plan plan{o.engines, {}, o.robots, o.threads};
  for (const std::string& name : o.partitions) {
    auto partition = partition_named(name);
    if (!partition.ok()) return partition.error();
    plan.partitions.push_back(std::move(partition).value());
  }
  for (const std::string& regions : o.regions) {
    auto partition = partition_split(regions);
    if (!partition.ok()) return partition.error();
    plan.partitions.push_back(std::move(partition).value());
  }
  if (!o.from.empty()) return plan;
  if (plan.engines.empty()) plan.engines = {usual_engine(catalog, o.name == "flocking")};
  if (plan.partitions.empty()) plan.partitions = {{"auto", "auto"}};
  if (plan.robots.empty()) plan.robots = {1, 10, 100, 1000, 10'000, 100'000};
  if (plan.threads.empty()) plan.threads = {0};
  return plan;
}

/// Every case once a round, so that what the machine does besides meets all of them; those that differ in threads alone
/// follow one another.
std::vector<BenchCase> cases_of(const Plan& plan, const BenchOptions& o, const Kinds& kinds,
                                const std::string& script = {}) {
  std::vector<BenchCase> cases;
  std::string devices;
  for (const std::string& device : o.devices) devices += (devices.empty() ? "" : ",") + device;
  for (std::int64_t repeat = 0; repeat < o.repeat; ++repeat) {
    for (const std::string& engine : plan.engines) {
      for (const Partition& partition : plan.partitions) {
        for (const std::int64_t robots : plan.robots) {
          for (const std::int64_t threads : plan.threads) {
            cases.push_back({o.name, robot_of(o), engine, partition.name, partition.regions, devices,
                             o.density.empty() && o.name != "flocking" ? "40 m" : "equal", robots, threads,
                             o.assignment == "dynamic" ? core::Assignment::Dynamic : core::Assignment::Static, o.ticks,
                             repeat, script, kinds});
          }
        }
      }
    }
  }
  return cases;
}

/// How long runs take, roughly before the first, from those that are done later on.
class Forecast {
 public:
  explicit Forecast(const std::vector<BenchCase>& cases) : cases_(cases), terminal_(isatty(STDERR_FILENO) != 0) {
    const double all_s = expected_s(0);
    if (all_s > kWorthTelling_s)
      app::say(fmt::format("{} runs of up to {} robots: about {}", cases.size(), largest(), duration_text(all_s)));
  }
  /// Shows where the benchmark is, on a terminal alone.
  void begin(std::size_t run) {
    began_s_ = app::wall_seconds();
    if (!terminal_ || cases_.size() < 2) return;
    fmt::print(stderr, "\r\033[Krun {} of {}, {} robots; about {} left", run + 1, cases_.size(), cases_[run].robots,
               duration_text(expected_s(run)));
    std::fflush(stderr);
  }
  void end(std::size_t run) {
    if (terminal_ && cases_.size() >= 2) fmt::print(stderr, "\r\033[K");
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
  std::int64_t largest() const {
    const auto fewer = [](const BenchCase& a, const BenchCase& b) { return a.robots < b.robots; };
    return std::max_element(cases_.begin(), cases_.end(), fewer)->robots;
  }
  static std::string duration_text(double seconds) {
    if (seconds < 100.0) return fmt::format("{:.0f} s", std::ceil(seconds));
    if (seconds < 6000.0) return fmt::format("{:.0f} minutes", std::ceil(seconds / 60.0));
    return fmt::format("{:.1f} hours", seconds / 3600.0);
  }

  const std::vector<BenchCase>& cases_;
  bool terminal_;
  double began_s_ = 0.0, took_s_ = 0.0, guessed_s_ = 0.0;
};

/// Prints each line as soon as it is there. @returns them; nothing when interrupted, or when `code` tells of a failure.
std::vector<ResultLine> measure_all(const std::vector<BenchCase>& cases, hal::PluginLoader& loader, int& code) {
  const std::atomic<bool>& stop = app::catch_signals();
  std::vector<ResultLine> lines;
  Forecast forecast(cases);
  for (std::size_t run = 0; run < cases.size(); ++run) {
    if (stop.load(std::memory_order_relaxed)) return {};
    forecast.begin(run);
    const Measurement measured = measure_apart(cases[run], loader, stop);
    forecast.end(run);
    if (!measured.line.empty()) {
      fmt::print("{}\n", measured.line);
      std::fflush(stdout);
    }
    code = measured.code;
    if (code != app::kDone || measured.line.empty()) return {};
    auto line = parse_result_line(measured.line);
    if (!line.ok()) {
      code = refuse(app::kFailedRunning, line.error().message);
      return {};
    }
    line->number = static_cast<std::int64_t>(lines.size()) + 1;
    lines.push_back(std::move(line).value());
  }
  return lines;
}

template <class T>
bool chosen(const std::vector<T>& wanted, const T& value) {
  return wanted.empty() || std::find(wanted.begin(), wanted.end(), value) != wanted.end();
}

/// The saved lines that the options choose; nothing, and a message, when there are none or they do not go together.
std::vector<ResultLine> choose_saved(const Plan& plan, const BenchOptions& o, int& code) {
  auto saved = read_result_lines(o.from);
  if (!saved.ok()) {
    code = refuse(app::kBadInput, saved.error().message);
    return {};
  }
  std::vector<std::string> splits;
  for (const Partition& p : plan.partitions) splits.push_back(p.regions);
  std::vector<ResultLine> lines;
  for (ResultLine& line : saved.value()) {
    if (chosen(plan.engines, line.engine) && chosen(splits, line.regions) && chosen(plan.robots, line.robots) &&
        chosen(plan.threads, line.threads) && (o.density.empty() || o.density == line.density) &&
        (o.assignment.empty() || o.assignment == line.assignment))
      lines.push_back(std::move(line));
  }
  if (lines.empty()) {
    code = refuse(app::kBadInput, o.from + ": error: none of its lines is what the other options choose");
    return {};
  }
  const hal::Status alike = check_alike(lines, o.from);
  if (alike.ok()) return lines;
  code = refuse(app::kBadInput, alike.error().message);
  return {};
}

hal::Status draw(const std::vector<ResultLine>& lines, hal::OutputFile& file) {
  const auto format = core::figure_format(file.path());
  if (!format.ok()) return format.error();
  return core::draw_figure(gnuplot_script(figure_of(lines), format.value()), file);
}

/// To standard error: standard output is for the lines.
void print_comparison(const std::vector<ResultLine>& lines) {
  for (const auto& [group, ratios] : compare_threads(lines)) fmt::print(stderr, "{}: {}\n", group, ratios);
}

/// Each case apart from the others only by its place in the line: worlds of one process follow one another.
int record(const std::vector<BenchCase>& cases, hal::PluginLoader& loader) {
  const std::atomic<bool>& stop = app::catch_signals();
  for (BenchCase c : cases) {
    c.bench = "diffusion";
    const auto line = bench_record(c, loader, stop);
    if (!line.ok()) return refuse(app::kFailedRunning, line.error().message);
    if (line.value().empty()) return app::kDone;
    fmt::print("{}\n", line.value());
    std::fflush(stdout);
  }
  return app::kDone;
}

int sense_to_act(const BenchOptions& o) {
  constexpr std::int64_t kMostRobots = 100;
  const std::vector<std::int64_t> robots = o.robots.empty() ? std::vector<std::int64_t>{20} : o.robots;
  for (const std::int64_t n : robots) {
    if (n > kMostRobots) return refuse(app::kWrongUsage, fmt::format("at most {} eye-bots", kMostRobots));
    const hal::Status measured = bench_sense_to_act({n, o.seconds, o.real_time}, o.repeat);
    if (!measured.ok()) return refuse(app::kFailedRunning, measured.error().message);
  }
  return app::kDone;
}

int back(const Plan& plan, const BenchOptions& o, const Kinds& kinds, hal::PluginLoader& loader) {
  for (const std::string& engine : plan.engines) {
    for (const std::int64_t robots : o.robots.empty() ? std::vector<std::int64_t>{1000} : plan.robots) {
      for (const std::int64_t threads : plan.threads) {
        BenchCase c;
        c.bench = "diffusion";
        c.robot = robot_of(o);
        c.engine = engine;
        c.partition = c.regions = plan.partitions.front().regions;
        c.density = o.density.empty() ? "40 m" : o.density;
        c.robots = robots;
        c.threads = threads;
        c.ticks = o.ticks;
        c.kinds = kinds;
        if (const int code = bench_back(c, o.repeat, loader); code != app::kDone) return code;
      }
    }
  }
  return app::kDone;
}

/// What a window costs; and how soon a thousand robots are seen.
int view(const Plan& plan, const BenchOptions& o, hal::PluginLoader& loader) {
  constexpr std::int64_t kMany = 20'000, kSoonShown = 1000;
  for (const std::string& engine : plan.engines) {
    for (const std::int64_t robots : o.robots.empty() ? std::vector<std::int64_t>{10'000, 100'000} : plan.robots) {
      for (const std::int64_t threads : plan.threads) {
        const double rate_per_s = robots > kMany ? 10.0 : 20.0;
        const hal::Status measured =
            bench_view({robots, robot_of(o), engine, threads, o.ticks, o.repeat, rate_per_s}, loader);
        if (!measured.ok()) return refuse(app::kFailedRunning, measured.error().message);
      }
    }
  }
  const hal::Status seen = bench_first_frame(kSoonShown, o.repeat);
  return seen.ok() ? app::kDone : refuse(app::kFailedRunning, seen.error().message);
}

int gap(const BenchOptions& o, hal::PluginLoader& loader) {
  GapCase c;
  if (!o.robots.empty()) c.robots = o.robots.front();
  if (o.repeat > 1) c.realities = o.repeat;
  const hal::Status measured = bench_gap(c, loader, app::catch_signals());
  return measured.ok() ? app::kDone : refuse(app::kFailedRunning, measured.error().message);
}

int sweep(const BenchOptions& o, hal::PluginLoader& loader) {
  SweepCase c;
  c.ticks = o.ticks;
  if (o.repeat > 1) c.runs = o.repeat;
  for (const std::int64_t robots : o.robots.empty() ? std::vector<std::int64_t>{c.robots} : o.robots) {
    c.robots = robots;
    const hal::Status measured = bench_sweep(c, loader);
    if (!measured.ok()) return refuse(app::kFailedRunning, measured.error().message);
  }
  return app::kDone;
}

int python(const BenchOptions& o) {
  PythonCase c;
  c.robots = o.robots;
  c.ticks = o.ticks;
  if (o.repeat > 1) c.runs = o.repeat;
  return refuse(app::kFailedRunning, bench_python(c).error().message);
}

int lockstep(const BenchOptions& o, hal::PluginLoader& loader) {
  for (const std::int64_t peers : o.robots.empty() ? std::vector<std::int64_t>{20} : o.robots) {
    if (peers > 1000) return refuse(app::kWrongUsage, "at most 1000 peers, each a process");
    for (std::int64_t i = 0; i < o.repeat; ++i) {
      const hal::Status measured = bench_lockstep({peers, o.ticks}, loader);
      if (!measured.ok()) return refuse(app::kFailedRunning, measured.error().message);
    }
  }
  return app::kDone;
}

void BenchOptions::describe(hal::CommandLine& line) {
  line.footer(
      "With --from the options --robots, --engine, --threads, --partition, --regions, --density and --assignment "
      "choose among the saved lines.");
  line.word(
          "name", name,
          "diffusion: the standard scene; flocking: robots that fly, in space; codec: messages of a bridge, only with "
          "--repeat; record: what a record of all poses costs, with --robots, --threads, --ticks; sense_to_act: how "
          "soon robots are answered over LCM, with --robots, --seconds, --real-time, "
          "--repeat; back: the way back to an earlier tick, e.g. after --ticks 6000; view: what a window costs, in "
          "--repeat "
          "pairs of --ticks; sweep: what a sweep costs besides its runs, with --robots, --ticks, --repeat: how many "
          "runs (10000); gap: hidden parameters of --robots (50) found again, and controllers ranked in --repeat (200) "
          "pseudo-realities; lockstep: a hub and --robots peers, each a process, with --ticks, --repeat; "
          "python: steps over arrays of --robots (10000), and --repeat (600) whole runs, by the module for Python")
      .show_default()
      .suggest({"diffusion", "flocking", "codec", "record", "sense_to_act", "back", "view", "sweep", "gap", "lockstep",
                "python"});
  line.option("--robots", robots, "Numbers of robots, e.g. 1000,10000; default: 1 to 100000")
      .separated()
      .range(1, 100'000'000);
  line.option("--robot", robot, "Kind of robot; default: the one of the benchmark's scene").named_in("robot");
  line.option("--in", file, "A file with kinds of robots that --robot may name, too").file();
  line.option("--with", devices,
              "Devices besides proximity sensors and wheels: range_and_bearing, omnidirectional_camera "
              "(of robots that have one); proximity:NAME: another implementation of those")
      .separated();
  line.option("--engine", engines,
              "Physics engines; `tandem list engines` names them; default: its first, for flocking the first for "
              "robots that fly")
      .separated()
      .named_in("engine");
  line.option("--threads", threads, "Numbers of threads, e.g. 0,2; default: 0").separated().range(0, 1024);
  line.option("--partition", partitions, "Divide the arena in equal parts: A1, A2 (2x1), A4 (2x2), A8 (4x2), A16 (4x4)")
      .separated()
      .suggest({"A1", "A2", "A4", "A8", "A16"});
  line.option("--regions", regions, "Divide it otherwise, e.g. 5x3; default: auto").separated().excludes("--partition");
  line.option("--ticks", ticks, "Steps that are timed").show_default().positive();
  line.option("--density", density, "equal: the arena grows with the number of robots; else it is 40 m")
      .suggest({"equal"});
  line.option("--assignment", assignment, "Of work to threads: static (default) or dynamic")
      .suggest({"static", "dynamic"});
  line.option("--repeat", repeat, "How often each is run, in turns; figures show medians").show_default().positive();
  line.option("--plot", plot, "Draw wall time and speed-up against robots: FILE.svg or FILE.png (gnuplot-nox)").file();
  line.option("--from", from, "Take saved lines from this file instead of measuring")
      .file()
      .excludes("--robot")
      .excludes("--with")
      .excludes("--ticks")
      .excludes("--repeat");
  line.option("--seconds", seconds, "Of sense_to_act: how long it is timed").show_default().range(0.1, 3600.0);
  line.flag("--real-time", real_time, "Of sense_to_act: with the scheduling class SCHED_FIFO");
  line.flag("--compare-threads", compare_threads,
            "Print how many times faster each number of threads is than the first");
  app::describe_plugins(line, plugins);
}

int run(const BenchOptions& options) {
  hal::PluginLoader loader = app::make_loader();
  if (!app::open_plugins(loader, options.plugins)) return app::kBadInput;
  Kinds kinds;
  if (!options.file.empty()) {
    const auto file = app::kinds_of_file(loader, options.file);
    if (file == nullptr) return app::kBadInput;
    kinds = file->kinds;
  }
  const auto plan = plan_of(loader.catalog(), options, kinds);
  if (!plan.ok()) return refuse(app::kWrongUsage, plan.error().message);
  if (options.name == "codec") {
    bench_codec(options.repeat);
    return app::kDone;
  }
  if (options.name == "sense_to_act") return sense_to_act(options);
  if (options.name == "back") return back(plan.value(), options, kinds, loader);
  if (options.name == "view") return view(plan.value(), options, loader);
  if (options.name == "record") {
    Plan measured = plan.value();
    if (options.robots.empty()) measured.robots = {10'000};
    return record(cases_of(measured, options, kinds), loader);
  }
  if (options.name == "sweep") return sweep(options, loader);
  if (options.name == "gap") return gap(options, loader);
  if (options.name == "lockstep") return lockstep(options, loader);
  if (options.name == "python") return python(options);
  std::optional<hal::OutputFile> plot;
  if (!options.plot.empty()) {
    const hal::Status drawable = core::can_draw_figures();
    if (!drawable.ok()) return refuse(app::kFailedRunning, drawable.error().message);
    auto opened = hal::OutputFile::open(options.plot, "figure");
    if (!opened.ok()) return refuse(app::kBadInput, opened.error().message);
    plot = std::move(opened).value();
  }
  std::optional<ScriptFile> script;
  if (options.name == "lua" && options.from.empty()) {
    script.emplace();
    if (script->path().empty())
      return refuse(app::kFailedRunning, "the script could not be written to a temporary file");
  }
  int code = app::kDone;
  const std::string path = script ? script->path() : "";
  const std::vector<ResultLine> lines = options.from.empty()
                                            ? measure_all(cases_of(plan.value(), options, kinds, path), loader, code)
                                            : choose_saved(plan.value(), options, code);
  if (lines.empty()) return code;
  if (options.compare_threads) print_comparison(lines);
  if (!plot) return app::kDone;
  const hal::Status drawn = draw(lines, *plot);
  return drawn.ok() ? app::kDone : refuse(app::kFailedRunning, drawn.error().message);
}

}  // namespace
}  // namespace tandem::bench

constinit const tandem::hal::CommandType tandem::app::bench_command =
    tandem::hal::command_type<tandem::bench::BenchOptions, tandem::bench::run>("bench", module_summary("bench"));
