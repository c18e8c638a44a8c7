// `tandem bench`: measures a scene, the foot-bot's codec or how soon eye-bots are answered, prints one JSON object a
// line, draws figures from them.
#include "app/command/command.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>

#include "app/command/shared_options.hpp"
#include "app/experiment/plugins.hpp"
#include "app/module/module_table.hpp"
#include "app/process/signals.hpp"
#include "app/process/terminal.hpp"
#include "bench/bench.hpp"
#include "core/device/device.hpp"
#include "core/scenario/engine_traits.hpp"
#include "core/view/gnuplot.hpp"
#include "hal/device/ring_sensors.hpp"

namespace tandem::bench {
namespace {

constexpr std::array<Bench, 13> kBenches = {
    {{"diffusion", &bench_scene, "the standard scene"},
     {"flocking", &bench_scene, "robots that fly, in space"},
     {"lua", &bench_scene, ""},
     {"argos", &bench_scene, "the standard scene under a controller for ARGoS 3"},
     {"codec", &bench_codec, "messages of a bridge, only with --repeat"},
     {"record", &bench_record, "what a record of all poses costs, with --robots, --threads, --ticks"},
     {"sense_to_act", &bench_sense_to_act,
      "how soon robots are answered over LCM, with --robots, --seconds, --real-time, --repeat"},
     {"back", &bench_back, "the way back to an earlier tick, e.g. after --ticks 6000"},
     {"view", &bench_view, "what a window costs, in --repeat pairs of --ticks"},
     {"sweep", &bench_sweep,
      "what a sweep costs besides its runs, with --robots, --ticks, --repeat: how many runs (10000)"},
     {"gap", &bench_gap,
      "hidden parameters of --robots (50) found again, and controllers ranked in --repeat (200) pseudo-realities"},
     {"lockstep", &bench_lockstep, "a hub and --robots peers, each a process, with --ticks, --repeat"},
     {"python", &bench_python,
      "steps over arrays of --robots (10000), and --repeat (600) whole runs, by the module for Python"}}};

std::string joined(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
  return all;
}

/// "there is no engine 'x'; there are: …" when `name` is none of `known`.
hal::Status check_name(std::string_view what, const std::string& name, const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), name) != known.end()) return {};
  return hal::Error{
      fmt::format("there is no {} '{}'; there {}: {}", what, name, known.size() == 1 ? "is" : "are", joined(known))};
}

std::vector<std::string> bench_names(bool offered) {
  std::vector<std::string> names;
  for (const Bench& bench : kBenches)
    if (!offered || !bench.text.empty()) names.emplace_back(bench.name);
  return names;
}

/// The first that there is; for robots that fly the first that is made for them.
std::string usual_engine(const hal::Catalog& catalog, bool flying) {
  const auto engines = catalog.all<core::KnownEngine>();
  for (const core::KnownEngine* engine : engines) {
    if (engine->traits.air == flying) return std::string(engine->kind);
  }
  return std::string(engines.front()->kind);
}

/// Of a file, those that drive and have proximity sensors can be measured, too.
std::vector<std::string> robots_of(const Call& call) {
  if (call.options.name == "flocking") return {"eye-bot"};
  std::vector<std::string> robots{"e-puck", "foot-bot"};
  for (const core::KindConfig& config : call.kinds) {
    if (config.kind->drive() != nullptr && config.kind->part<hal::ProximityPart>() != nullptr)
      robots.push_back(config.kind->name);
  }
  return robots;
}

std::vector<std::string> devices_of(const Call& call) {
  if (call.options.name == "flocking") return {};
  std::vector<std::string> devices{"range_and_bearing"};
  if (call.robot == "foot-bot") devices.emplace_back("omnidirectional_camera");
  for (const core::DeviceType* type : call.loader.catalog().all<core::DeviceType>()) {
    if (type->device == hal::Proximity::kName) devices.push_back("proximity:" + std::string(type->implementation));
  }
  return devices;
}

hal::Status check_words(const Call& call) {
  const BenchOptions& o = call.options;
  if (auto s = check_name("benchmark", o.name, bench_names(false)); !s.ok()) return s;
  if (auto s = check_name("robot", call.robot, robots_of(call)); !s.ok()) return s;
  for (const std::string& device : o.devices) {
    if (auto s = check_name("device of the " + call.robot + " to measure with", device, devices_of(call)); !s.ok())
      return s;
  }
  for (const std::string& engine : o.engines) {
    // Saved lines may come from another build.
    if (auto s = check_name("engine", engine, call.loader.catalog().names("engine")); !s.ok() && o.from.empty())
      return s;
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

/// Checks what is asked for, and fills in what is usual.
hal::Status complete(Call& call) {
  const BenchOptions& o = call.options;
  call.robot = o.robot.empty() ? (o.name == "flocking" ? "eye-bot" : "e-puck") : o.robot;
  if (auto s = check_words(call); !s.ok()) return s;
  const auto add = [&](const hal::Result<Partition>& partition) -> hal::Status {
    if (!partition.ok()) return partition.error();
    call.partitions.push_back(partition.value());
    return {};
  };
  for (const std::string& name : o.partitions)
    if (auto s = add(partition_named(name)); !s.ok()) return s;
  for (const std::string& regions : o.regions)
    if (auto s = add(partition_split(regions)); !s.ok()) return s;
  if (!o.from.empty()) return {};
  if (call.engines.empty()) call.engines = {usual_engine(call.loader.catalog(), o.name == "flocking")};
  if (call.partitions.empty()) call.partitions = {{"auto", "auto"}};
  if (call.robots.empty()) call.robots = {1, 10, 100, 1000, 10'000, 100'000};
  if (call.threads.empty()) call.threads = {0};
  return {};
}

int run(const BenchOptions& options) {
  hal::PluginLoader loader = app::make_loader();
  if (!app::open_plugins(loader, options.plugins)) return app::kBadInput;
  Call call{options, loader, app::catch_signals(), {}, {}, options.engines, {}, options.robots, options.threads};
  if (!options.file.empty()) {
    const auto file = app::kinds_of_file(loader, options.file);
    if (file == nullptr) return app::kBadInput;
    call.kinds = file->kinds;
  }
  if (const hal::Status complete_now = complete(call); !complete_now.ok())
    return refuse(app::kWrongUsage, complete_now.error().message);
  const Bench& bench =
      *std::find_if(kBenches.begin(), kBenches.end(), [&](const Bench& b) { return b.name == options.name; });
  try {
    const hal::Result<int> code = bench.run(call);
    if (const int interrupted = app::interrupted_code(); interrupted != 0) {
      app::say("interrupted");
      return interrupted;
    }
    return code.ok() ? code.value() : refuse(app::kFailedRunning, code.error().message);
  } catch (const std::exception& e) {
    return refuse(app::kFailedRunning, e.what());
  }
}

}  // namespace

void BenchOptions::describe(hal::CommandLine& line) {
  std::string all;
  for (const Bench& bench : kBenches)
    if (!bench.text.empty()) all += fmt::format("{}{}: {}", all.empty() ? "" : "; ", bench.name, bench.text);
  line.footer(
      "With --from the options --robots, --engine, --threads, --partition, --regions, --density and --assignment "
      "choose among the saved lines.");
  line.word("name", name, all).show_default().suggest(bench_names(true));
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

}  // namespace tandem::bench

constinit const tandem::hal::CommandType tandem::app::bench_command =
    tandem::app::module_command<tandem::bench::BenchOptions, tandem::bench::run>("bench");
