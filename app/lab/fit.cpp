// `tandem fit`: parameters of simulated robots from records of real ones.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

#include "app/command/command.hpp"
#include "app/command/shared_options.hpp"
#include "app/lab/recorded.hpp"
#include "app/module/module_table.hpp"
#include "app/outputs/report.hpp"
#include "app/process/progress.hpp"
#include "app/process/terminal.hpp"
#include "core/config/fitted.hpp"
#include "hal/device/fitted.hpp"
#include "hal/json/json.hpp"
#include "hal/output_file.hpp"
#include "mixed_reality/gap/population.hpp"
#include "mixed_reality/gap/proximity_fit.hpp"
#include "mixed_reality/gap/recorded_run.hpp"
#include "mixed_reality/gap/surroundings.hpp"
#include "mixed_reality/gap/wheel_fit.hpp"

namespace tandem::app {
namespace {

struct FitOptions {
  Libraries plugins;
  std::vector<std::string> records;
  std::vector<std::string> robots;  ///< ids, or patterns with '*'; empty: all real ones, or all where none is real
  std::string output;               ///< file of fitted parameters; empty: none
  std::string report;               ///< JSON file, or "-"

  void describe(hal::CommandLine& line) {
    line.footer("The file is for <fitted file=\"FILE\"/> in an experiment. Errors are those of 95 %.");
    line.word("record", records,
              "Records of runs with real robots; of simulated ones with <record ports=\"differential_steering\"/>")
        .required()
        .file();
    line.option("--robots", robots, "Only these, separated by commas; '*' stands for any text; default: real ones")
        .separated();
    line.option("-o,--output", output, "Write what was found to this file").file();
    line.option("--report", report, "Write it as JSON to this file ('-': standard output)").file();
    describe_plugins(line, plugins);
  }
};

using mixed_reality::DelayEstimate;
using mixed_reality::Estimate;
using mixed_reality::ProximityFit;
using mixed_reality::RecordedRobot;
using mixed_reality::RecordedRun;
using mixed_reality::WheelFit;

/// What was found for one robot.
struct RobotFit {
  std::string id, kind, record;
  WheelFit wheels;
  ProximityFit proximity;
};

/// Whether a real robot's poses come from its own wheels alone.
bool by_wheels(const core::Scenario& scenario, const RecordedRobot& robot) {
  if (!robot.real) return false;
  const auto item = std::find_if(scenario.robots.begin(), scenario.robots.end(),
                                 [&](const core::RobotItem& r) { return r.id == robot.id; });
  if (item == scenario.robots.end()) return false;
  const std::string source = item->tracker ? item->tracker->source : "auto";
  return source == "odometry" || (source == "auto" && scenario.trackers.empty());
}

mixed_reality::WheelFitOptions options_for(const core::Scenario& scenario, const RecordedRobot& robot,
                                           const hal::RobotKind& kind) {
  mixed_reality::WheelFitOptions options;
  options.wheel_base_m = kind.drive()->wheel_base_m;
  options.poses_by_wheels = robot.sightings.empty() && by_wheels(scenario, robot);
  options.poses_drawn = robot.real && robot.sightings.empty();
  if (std::isfinite(robot.round_trip_s)) options.round_trip_s = robot.round_trip_s;
  options.round_trip_jitter_s = robot.round_trip_jitter_s;
  return options;
}

std::string shown(const Estimate& e, double scale = 1.0, int digits = 4) {
  if (!e.observable) return "cannot be told";
  if (e.most) return fmt::format("at most {:.{}f}", *e.most * scale, digits);
  return fmt::format("{:.{}f} +- {:.{}f}", e.value * scale, digits, e.bound() * scale, digits);
}

std::string shown(const DelayEstimate& e) {
  if (!e.told) return "cannot be told";
  return fmt::format("{:.1f} +- {:.1f} ms", e.value_s * 1e3, e.bound_s * 1e3);
}

std::string shown_ms(const Estimate& e) {
  return shown(e, 1e3, 1) + (e.observable ? " ms" : "");
}

/// What cannot be told has no bounds.
hal::Json to_json(const Estimate& e) {
  if (!e.observable) return {{"value", e.value}, {"observable", false}};
  return {
      {"value", e.value}, {"bound_95", e.bound()}, {"low_95", e.low()}, {"high_95", e.high()}, {"observable", true}};
}

hal::Json to_json(const DelayEstimate& e) {
  return to_json(e.told ? Estimate{e.value_s, e.bound_s / 1.96, true} : Estimate{});
}

void print(const RobotFit& robot) {
  const WheelFit& w = robot.wheels;
  const ProximityFit& p = robot.proximity;
  fmt::print("{} ({})\n", printable(robot.id), printable(robot.kind));
  if (!w.flaw.empty()) {
    fmt::print("  wheels: nothing found: {}\n", w.flaw);
  } else {
    print_table({{"left wheel", shown(w.left)},
                 {"right wheel", shown(w.right)},
                 {"wheel base", shown(w.base)},
                 {"delay", shown_ms(w.delay_s)},
                 {"to counters", shown_ms(w.counter_delay_s)},
                 {"lag", shown_ms(w.lag_s)},
                 {"link both ways", shown_ms(w.round_trip_s)},
                 {"link to robot", shown(w.parts.link_in)},
                 {"command", shown(w.parts.command)},
                 {"body", shown(w.parts.body)},
                 {"counters", shown(w.parts.counters)},
                 {"noise", shown(w.noise_sqrt_m, 1e3, 2) + (w.noise_sqrt_m.observable ? " mm after 1 m" : "")},
                 {"play", shown(w.play_m, 1e3, 2) + (w.play_m.observable ? " mm" : "")},
                 {"counted", shown(w.counted_left) + " | " + shown(w.counted_right)},
                 {"slip", shown(w.slip_left) + " | " + shown(w.slip_right)},
                 {"places", shown(w.place_noise_m, 1e3, 2) + " mm, " + shown(w.place_noise_rad, 57.29578, 2) + " deg"},
                 {"used", fmt::format("{} places, {} left out", w.ticks, w.left_out)}});
  }
  if (!p.flaw.empty()) {
    fmt::print("  proximity: nothing found: {}\n", p.flaw);
  } else {
    print_table({{"gain", shown(p.gain)},
                 {"exponent", shown(p.exponent)},
                 {"offset", shown(p.offset_m, 1e3, 2) + (p.offset_m.observable ? " mm" : "")},
                 {"noise", shown(p.noise_m, 1e3, 2) + " mm"},
                 {"delay", shown(p.delay_s, 1e3, 1) + (p.delay_s.observable ? " ms" : "")},
                 {"readings", std::to_string(p.readings)}});
  }
}

hal::Json to_json(const WheelFit& w) {
  if (!w.flaw.empty()) return {{"flaw", w.flaw}};
  return {{"left", to_json(w.left)},
          {"right", to_json(w.right)},
          {"base", to_json(w.base)},
          {"delay_s", to_json(w.delay_s)},
          {"counter_delay_s", to_json(w.counter_delay_s)},
          {"lag_s", to_json(w.lag_s)},
          {"round_trip_s", to_json(w.round_trip_s)},
          {"link_in_s", to_json(w.parts.link_in)},
          {"command_s", to_json(w.parts.command)},
          {"body_s", to_json(w.parts.body)},
          {"counters_s", to_json(w.parts.counters)},
          {"noise_sqrt_m", to_json(w.noise_sqrt_m)},
          {"counted_left", to_json(w.counted_left)},
          {"counted_right", to_json(w.counted_right)},
          {"slip_left", to_json(w.slip_left)},
          {"slip_right", to_json(w.slip_right)},
          {"mount_rad", to_json(w.mount_rad)},
          {"play_m", to_json(w.play_m)},
          {"place_noise_m", to_json(w.place_noise_m)},
          {"place_noise_rad", to_json(w.place_noise_rad)},
          {"places", w.ticks},
          {"left_out", w.left_out}};
}

hal::Json to_json(const ProximityFit& p) {
  if (!p.flaw.empty()) return {{"flaw", p.flaw}};
  return {{"gain", to_json(p.gain)},       {"exponent", to_json(p.exponent)}, {"offset_m", to_json(p.offset_m)},
          {"noise_m", to_json(p.noise_m)}, {"delay_s", to_json(p.delay_s)},   {"readings", p.readings}};
}

hal::Json to_json(const RobotFit& robot) {
  return {{"robot", robot.id},
          {"kind", robot.kind},
          {"record", robot.record},
          {"wheels", to_json(robot.wheels)},
          {"proximity", to_json(robot.proximity)}};
}

/// Of one robot in several records: each value weighted by its certainty.
template <class Model>
hal::FittedRobot<Model> merged(const std::vector<hal::FittedRobot<Model>>& all) {
  hal::FittedRobot<Model> one = all.front();
  if (all.size() == 1) return one;
  for (const hal::ModelField<Model>& f : Model::fields()) {
    double weights = 0.0, sum = 0.0;
    for (const auto& robot : all) {
      const double error = std::max(1e-12, robot.error.of.*f.member);
      weights += 1.0 / (error * error);
      sum += robot.value.of.*f.member / (error * error);
    }
    one.value.of.*f.member = sum / weights;
    one.error.of.*f.member = 1.0 / std::sqrt(weights);
  }
  return one;
}

/// A value that the data did not tell has no error: draws leave it as it is.
hal::WheelModel told_errors(const WheelFit& fit) {
  hal::WheelModel errors = fit.errors();
  const auto clear = [](const Estimate& e, double& error) {
    if (!e.observable) error = 0.0;
  };
  clear(fit.left, errors.left);
  clear(fit.right, errors.right);
  clear(fit.base, errors.base);
  clear(fit.counted_left, errors.counted_left);
  clear(fit.counted_right, errors.counted_right);
  clear(fit.noise_sqrt_m, errors.noise_sqrt_m);
  clear(fit.delay_s, errors.delay_s);
  return errors;
}

/// The estimates of one kind of model, by kind of robot and robot.
template <class Model>
using ByRobot = std::map<std::string, std::map<std::string, std::vector<hal::FittedRobot<Model>>>>;

template <class Part, class Model>
Part part_of(const std::map<std::string, std::vector<hal::FittedRobot<Model>>>& by_id, const std::string& source) {
  std::vector<hal::FittedRobot<Model>> all;
  for (const auto& [id, found] : by_id) all.push_back(merged(found));
  auto part = mixed_reality::population<Part>(std::move(all));
  part.source = source;
  return part;
}

std::string fitted_text(const std::vector<RobotFit>& robots, const FitOptions& options) {
  ByRobot<hal::WheelModel> wheels;
  ByRobot<hal::ProximityModel> rays;
  std::vector<std::string> kinds;
  for (const RobotFit& robot : robots) {
    if (std::find(kinds.begin(), kinds.end(), robot.kind) == kinds.end()) kinds.push_back(robot.kind);
    if (robot.wheels.flaw.empty())
      wheels[robot.kind][robot.id].push_back({robot.id, {robot.wheels.values()}, {told_errors(robot.wheels)}});
    if (robot.proximity.flaw.empty())
      rays[robot.kind][robot.id].push_back({robot.id, {robot.proximity.values()}, {robot.proximity.one_by_one}});
  }
  std::string source = "tandem fit";
  for (const std::string& record : options.records) source += " " + record;
  std::vector<core::FittedKind> fitted;
  for (const std::string& kind : kinds) {
    core::FittedKind of{kind, {}};
    if (wheels.contains(kind)) of.parts.emplace_back(part_of<hal::FittedWheels>(wheels[kind], source));
    if (rays.contains(kind)) of.parts.emplace_back(part_of<hal::FittedProximity>(rays[kind], source));
    if (!of.parts.empty()) fitted.push_back(std::move(of));
  }
  return core::fitted_file(std::move(fitted));
}

/// The fits of one record's robots; nothing: complained.
bool fit_record(const std::string& path, const FitOptions& options, std::vector<RobotFit>& fits) {
  const auto recorded = open_recorded(path, options.plugins);
  if (!recorded) return false;
  const RecordedRun& run = recorded->run;
  const std::size_t before = fits.size();
  std::vector<double> radius_m;
  for (const RecordedRobot& robot : run.robots) {
    const auto* const kind = recorded->kind_of(robot);
    radius_m.push_back(kind != nullptr ? kind->body.radius_m : 0.0);
  }
  const mixed_reality::Surroundings surroundings(run, radius_m);
  Progress progress(static_cast<std::int64_t>(run.robots.size()), 1, "fit of '" + path + "'", "robots");
  for (std::size_t i = 0; i < run.robots.size(); ++i) {
    progress.step(static_cast<std::int64_t>(i));
    const RecordedRobot& robot = run.robots[i];
    if (!is_meant(robot, run, options.robots)) continue;
    RobotFit fit{robot.id, robot.kind, path, {}, {}};
    const auto* const kind = recorded->kind_of(robot);
    if (kind == nullptr || kind->drive() == nullptr)
      fit.wheels.flaw = "robots of this kind have no two wheels";
    else
      fit.wheels = fit_wheels(wheel_series(run, robot), options_for(recorded->scenario, robot, *kind));
    const auto* const rays = kind != nullptr ? kind->part<hal::ProximityPart>() : nullptr;
    if (rays == nullptr)
      fit.proximity.flaw = "robots of this kind have none";
    else
      fit.proximity = fit_proximity(proximity_series(run, i, surroundings, *rays), run.tick_s());
    fits.push_back(std::move(fit));
  }
  if (fits.size() > before) return true;
  std::vector<std::string> ids;
  for (const RecordedRobot& robot : run.robots) ids.push_back(robot.id);
  complain(kBadInput, "record '" + path + "': no robot of it is meant by --robots; there are: " + hal::listed(ids));
  return false;
}

/// One line for each reason, with the number of robots that it holds for.
std::string nothing_found(const std::vector<RobotFit>& fits) {
  std::map<std::string, std::size_t> reasons;
  for (const RobotFit& robot : fits) {
    ++reasons["wheels: " + robot.wheels.flaw];
    ++reasons["proximity: " + robot.proximity.flaw];
  }
  std::string text = "nothing was found for any robot";
  for (const auto& [reason, robots] : reasons)
    text += fmt::format("\n  {} robot{}: {}", robots, robots == 1 ? "" : "s", reason);
  return text;
}

int fit(const FitOptions& options) {
  std::vector<NamedFile> inputs;
  for (const std::string& record : options.records) inputs.push_back({"record", record});
  if (const hal::Status apart =
          check_apart({{"fitted parameters", options.output}, {"report", options.report}}, inputs);
      !apart.ok())
    return complain(kBadInput, apart.error().message);
  std::vector<RobotFit> fits;
  for (const std::string& record : options.records) {
    if (!fit_record(record, options, fits)) return kBadInput;
  }
  hal::Json json;
  const bool any = std::any_of(fits.begin(), fits.end(),
                               [](const RobotFit& f) { return f.wheels.flaw.empty() || f.proximity.flaw.empty(); });
  for (const RobotFit& robot : fits) {
    if (any && options.report != "-") print(robot);
    json["robots"].push_back(to_json(robot));
  }
  if (!options.report.empty()) {
    if (const hal::Status done = write_text(options.report, "report", hal::to_text(json)); !done.ok())
      return complain(kBadInput, done.error().message);
  }
  if (!any) return complain(kBadInput, nothing_found(fits));
  if (!options.output.empty()) {
    if (const hal::Status done = write_text(options.output, "fitted parameters", fitted_text(fits, options));
        !done.ok())
      return complain(kBadInput, done.error().message);
  }
  return kDone;
}

}  // namespace

constinit const hal::CommandType fit_command = module_command<FitOptions, fit>("fit");

}  // namespace tandem::app
