#include "app/run_report.hpp"

#include <fmt/format.h>

#include "app/bridge_status.hpp"
#include "app/measure.hpp"
#include "app/report.hpp"
#include "app/sha256.hpp"
#include "core/config/xml.hpp"

namespace tandem::app {
namespace {

std::string_view word_of(Ended how) {
  switch (how) {
    case Ended::Length:
      return "length";
    case Ended::Hook:
      return "hook";
    case Ended::Interrupted:
      return "interrupted";
    case Ended::Failed:
      break;
  }
  return "failed";
}

/// "interrupted at tick 4006 of 200000, not finished"; empty where there is nothing to tell.
std::string end_text(const RunEnd& end, hal::Tick tick) {
  if (end.how == Ended::Length) return {};
  const std::string at =
      fmt::format("at tick {}{}", tick, end.steps_wanted > 0 ? fmt::format(" of {}", end.steps_wanted) : "");
  if (end.how == Ended::Hook) return "by a hook " + at;
  return fmt::format("{} {}, not finished", word_of(end.how), at);
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
    add_link_report(json, r.conversation);
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

void add_members(Json& json, const RunResult& result, bool between_ticks) {
  const core::World& world = result.world;
  add_run_fields(json, world, result.figures, result.robots, between_ticks);
  json.key("controllers").begin_array();
  for (const ControllerFile& file : result.controllers) {
    json.begin_object().field("id", file.id).field("label", file.label).field("file", file.file);
    if (!file.sha256.empty()) json.field("sha256", file.sha256);
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
  if (result.real != nullptr) add_real_robots(json, *result.real);
  json.field("settings", core::to_xml(world.scenario().effective));
}

}  // namespace

RunEnd end_of(const core::World& world, std::int64_t steps_wanted, bool stopped) {
  RunEnd end{Ended::Length, world.failure(), steps_wanted};
  if (world.state() == core::RunState::Failed) {
    end.how = Ended::Failed;
  } else if (world.state() == core::RunState::Done) {
    end.how = Ended::Hook;
  } else if (stopped && (steps_wanted == 0 || world.tick() < steps_wanted)) {
    end.how = Ended::Interrupted;
  }
  return end;
}

std::vector<ControllerFile> controller_files(const core::Scenario& scenario, const hal::PluginLoader& loader) {
  std::vector<ControllerFile> files;
  for (const core::ControllerConfig& config : scenario.controllers) {
    const auto file = loader.find(config.library);
    if (!file.ok()) continue;
    const auto digest = sha256_of_file(file.value().string());
    files.push_back({config.id, config.label, file.value().string(), digest.ok() ? digest.value() : ""});
  }
  return files;
}

std::string report_of(const RunResult& result) {
  Json json;
  json.begin_object();
  json.field("finished", result.end.finished()).field("ended", word_of(result.end.how));
  if (!result.end.failure.empty()) json.field("failure", result.end.failure);
  add_members(json, result, true);
  json.end_object();
  return json.text();
}

std::string report_members(const RunResult& result) {
  Json json;
  json.begin_object();
  add_members(json, result, false);
  return json.text().substr(1);  // without the brace
}

void print_result(const RunResult& result) {
  const core::World& world = result.world;
  const RunFigures& figures = result.figures;
  const std::size_t robots = result.robots;
  const mixed_reality::MixedReport* const real = result.real;
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
  if (const std::string text = end_text(result.end, world.tick()); !text.empty()) rows.emplace_back("ended", text);
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
          fmt::format("{} on {}: {}; {} ticks driving, {} held, {} of {} questions answered, {}", r.id, r.link, r.state,
                      r.counts.ticks_driving, r.counts.ticks_held, r.conversation.answers, r.conversation.questions,
                      r.stop_confirmed ? "stop confirmed" : "STOP NOT CONFIRMED"));
    }
  }
  print_table(rows);
}

}  // namespace tandem::app
