// `tandem gap`: how far a simulation is from what was recorded.
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <unistd.h>

#include "app/command/command.hpp"
#include "app/command/shared_options.hpp"
#include "app/experiment/reading.hpp"
#include "app/lab/recorded.hpp"
#include "app/module/module_table.hpp"
#include "app/outputs/report.hpp"
#include "app/outputs/run_record.hpp"
#include "app/process/signals.hpp"
#include "app/process/terminal.hpp"
#include "app/run/time_parts.hpp"
#include "core/run/run.hpp"
#include "core/sim/world.hpp"
#include "mixed_reality/gap/measures.hpp"

namespace tandem::app {
namespace {

struct GapOptions {
  Libraries plugins;
  std::string record, other;        ///< an empty other: the first, simulated
  std::vector<std::string> robots;  ///< as of `tandem fit`
  std::string fitted;               ///< file of fitted parameters for the simulation; empty: as the record's settings
  std::vector<std::string> overrides;  ///< of the simulation's settings
  std::optional<std::uint64_t> seed;   ///< of the simulation; none: the record's
  std::string report;                  ///< JSON file, or "-"

  void describe(hal::CommandLine& line) {
    line.footer(
        "Without a second record the run of the first is made again, with its real robots simulated from where they "
        "began. A report that stands in the place of the new one is kept as FILE.bak.");
    line.word("record", record, "The record of what really happened").required().file();
    line.word("other", other, "Another record, to be compared with it instead of a simulation").file();
    line.option("--robots", robots, "Only these, separated by commas; '*' stands for any text; default: real ones")
        .separated();
    line.option("--fitted", fitted, "Simulate with these fitted parameters (`tandem fit`)").file();
    line.option("--set", overrides, "Change the simulation: path=value; repeatable").repeatable();
    line.option("--seed", seed, "Of the simulation, instead of the record's");
    line.option("--report", report, "Write it as JSON to this file ('-': standard output)").file();
    describe_plugins(line, plugins);
  }
};

using mixed_reality::RecordedRun;

/// A file that is removed when it goes.
struct TemporaryFile {
  TemporaryFile() {
    std::error_code error;
    auto folder = std::filesystem::temp_directory_path(error);
    path = ((error ? std::filesystem::path("/tmp") : folder) / ("tandem_gap_" + std::to_string(getpid()) + ".record"))
               .string();
  }
  ~TemporaryFile() {
    std::error_code error;
    for (const std::string& file : {path, path + ".part"}) std::filesystem::remove(file, error);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  std::string path;
};

/// Real robots become simulated ones that begin where the real ones were first seen.
void simulate_robots(core::Scenario& scenario, const RecordedRun& run) {
  scenario.time_mode = core::TimeMode::Fast;
  scenario.trackers.clear();
  for (core::RobotItem& item : scenario.robots) {
    if (!item.bridge) continue;
    item.bridge.reset();
    item.tracker.reset();
    const mixed_reality::RecordedRobot* const robot = run.find(item.id);
    if (robot == nullptr) continue;
    const auto first = std::find_if(robot->ticks.begin(), robot->ticks.end(), [](const auto& t) { return t.posed; });
    if (first == robot->ticks.end()) continue;
    item.placement.p_W[0] = first->x_m;
    item.placement.p_W[1] = first->y_m;
    item.placement.yaw_rad = first->heading_rad;
  }
}

/// Runs it for as many ticks as the record has, with a record of its own. Error: it cannot be made, or fails.
hal::Status simulate(Recorded& recorded, const GapOptions& options, const std::string& path) {
  core::Scenario& scenario = recorded.scenario;
  simulate_robots(scenario, recorded.run);
  core::WorldOptions world_options;
  world_options.seed = options.seed;
  const auto seed = recorded.run.start.find("seed");
  if (!options.seed && seed != recorded.run.start.end() && seed->is_number_unsigned())
    world_options.seed = seed->get<std::uint64_t>();
  scenario.record = {};
  scenario.record.look = scenario.record.state = false;
  scenario.record.fingerprint_every = 0;
  if (std::any_of(recorded.run.robots.begin(), recorded.run.robots.end(), [](const auto& r) { return r.rays > 0; }))
    scenario.record.ports = {"proximity"};
  core::Problems problems;
  auto world = core::World::make(scenario, *recorded.loader, world_options, problems);
  print_problems(problems);
  if (world == nullptr) return hal::Error{"the simulation cannot be made"};
  auto record = RecordPart::open(*world, *recorded.loader, path);
  if (!record.ok()) return record.error();
  core::Run run(*world, catch_signals());
  run.add(std::make_unique<core::Length>(recorded.run.first + static_cast<hal::Tick>(recorded.run.ticks)));
  run.add(std::move(record).value());
  run.add(progress_part(recorded.run.first + static_cast<hal::Tick>(recorded.run.ticks), world->ticks_per_second(),
                        "simulating"));
  (void)run.go();
  if (run.stopped()) return hal::Error{"interrupted"};
  const std::string& failure = world->failure().empty() ? run.failure() : world->failure();
  return failure.empty() ? hal::Status() : hal::Status(hal::Error{failure});
}

void print(const mixed_reality::Gap& gap) {
  fmt::print("{:<16} {:>8} {:>10} {:>10} {:>10} {:>10} {:>10}\n", "robot", "way", "absolute", "apart", "heading",
             "end per m", "in 1 s");
  const auto line = [](const mixed_reality::TrajectoryGap& g) {
    fmt::print("{:<16} {:>6.2f} m {:>7.1f} mm {:>7.1f} mm {:>6.1f} deg {:>7.1f} mm {:>7.1f} mm\n", printable(g.id),
               g.way_m, g.absolute_m * 1e3, g.apart_m * 1e3, g.heading_rad * 57.29578, g.end_m_per_m * 1e3,
               g.relative_m * 1e3);
  };
  for (const auto& robot : gap.robots) line(robot);
  if (gap.robots.size() > 1) line(gap.typical);
  fmt::print("\n{:<20} {:>12} {:>12} {:>10} {:>14}\n", "distribution", "mean", "mean of B", "K-S", "Wasserstein");
  for (const auto* list : {&gap.distributions, &gap.measures}) {
    for (const auto& d : *list) {
      fmt::print("{:<20} {:>12.4g} {:>12.4g} {:>10.3f} {:>11.4g} {}\n", printable(d.name), d.mean_a, d.mean_b,
                 d.largest, d.moved, d.unit);
    }
  }
  fmt::print("{:<20} {:>12} {:>12} {:>10.3f}\n", "occupancy", "", "", gap.occupancy);
}

int gap(const GapOptions& options) {
  if (const hal::Status apart =
          check_apart({{"report", options.report}}, {{"record", options.record}, {"record", options.other}});
      !apart.ok())
    return complain(kBadInput, apart.error().message);
  std::vector<std::string> overrides = options.overrides;
  if (!options.fitted.empty()) overrides.push_back("fitted.file=" + options.fitted);
  if (!options.other.empty() && (!overrides.empty() || options.seed))
    return complain(kWrongUsage, "--fitted, --set and --seed change a simulation; two records have none");
  auto recorded = open_recorded(options.record, options.plugins, overrides);
  if (!recorded) return kBadInput;
  const TemporaryFile simulated;
  if (options.other.empty()) {
    if (const hal::Status done = simulate(*recorded, options, simulated.path); !done.ok())
      return complain(kFailedRunning, done.error().message);
  }
  const auto other = mixed_reality::read_recorded_run(options.other.empty() ? simulated.path : options.other);
  if (!other.ok()) return complain(kBadInput, other.error().message);
  std::vector<std::string> ids;
  for (const auto& robot : recorded->run.robots) {
    if (is_meant(robot, recorded->run, options.robots)) ids.push_back(robot.id);
  }
  if (ids.empty()) return complain(kBadInput, "no robot of '" + options.record + "' is meant by --robots");
  const mixed_reality::Gap gap = gap_between(recorded->run, other.value(), ids);
  if (gap.robots.empty()) return complain(kBadInput, "the two runs have no robot in common");
  if (options.report != "-") print(gap);
  if (options.report.empty()) return kDone;
  const hal::Status written = write_text(options.report, "report", hal::to_text(to_json(gap)));
  return written.ok() ? kDone : complain(kBadInput, written.error().message);
}

}  // namespace

constinit const hal::CommandType gap_command = module_command<GapOptions, gap>("gap");

}  // namespace tandem::app
