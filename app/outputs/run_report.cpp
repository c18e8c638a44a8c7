#include "app/outputs/run_report.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "app/build_info.hpp"
#include "app/outputs/report.hpp"
#include "app/process/measure.hpp"
#include "app/robots/bridge_status.hpp"
#include "app/robots/ledger_json.hpp"
#include "app/robots/lockstep_peers.hpp"
#include "app/robots/real_robots.hpp"
#include "core/view/record_drawing.hpp"
#include "hal/json/json.hpp"
#include "hal/sha256.hpp"
#include "hal/unit.hpp"
#include "hal/xml/xml.hpp"
#include "mixed_reality/settings/bridge_request.hpp"

namespace tandem::app {
namespace {

std::string_view word_of(Ended how) {
  switch (how) {
    case Ended::Length:
      return "length";
    case Ended::Hook:
      return "hook";
    case Ended::Part:
      return "part";
    case Ended::Interrupted:
      return "interrupted";
    case Ended::Failed:
      break;
  }
  return "failed";
}

std::string ledger_text(const mixed_reality::RobotLedger& l) {
  std::string text = fmt::format(
      "readings {:.0f} ms old, {:.0f} ms at most (99 %); answers in {:.1f} ms, {:.1f} ms (99 %), jitter {:.1f} ms; {} "
      "late "
      "readings, {} late commands",
      to_ms(l.age_median_ns), to_ms(l.age_p99_ns), to_ms(l.round_trip_median_ns), to_ms(l.round_trip_p99_ns),
      to_ms(l.jitter_ns), l.late_readings, l.late_commands);
  if (l.clock)
    text += fmt::format("; its clock {:+.1f} ppm, {}, {} jumps", l.clock->drift_ppm,
                        l.clock->bound_ns ? fmt::format("within {:.1f} ms", to_ms(*l.clock->bound_ns)) : "one way",
                        l.clock->jumps);
  return text;
}

/// "interrupted at tick 4006 of 200000, not finished"; empty where there is nothing to tell.
std::string end_text(const RunEnd& end, hal::Tick tick) {
  if (end.how == Ended::Length) return {};
  const std::string at =
      fmt::format("at tick {}{}", tick, end.steps_wanted > 0 ? fmt::format(" of {}", end.steps_wanted) : "");
  if (end.how == Ended::Hook) return "by a hook " + at;
  if (end.how == Ended::Part) return "by a part " + at;
  return fmt::format("{} {}, not finished", word_of(end.how), at);
}

/// What trackers saw of a robot, and what was made of it.
void add_pose(hal::Json& robot, const mixed_reality::RealRobotReport& r) {
  robot["pose_source"] = r.pose_source;
  robot["poses_rejected"] = r.poses_rejected;
  if (r.sightings) {
    robot["sightings"] = {{"used", r.sightings->used},
                          {"gated", r.sightings->gated},
                          {"late", r.sightings->late},
                          {"doubled", r.sightings->doubled},
                          {"impossible", r.sightings->impossible},
                          {"disputed", r.sightings->disputed},
                          {"jumps", r.sightings->jumps},
                          {"slips", r.sightings->slips}};
  }
  if (r.learnt) {
    robot["learnt"] = {{"left_wheel", r.learnt->left},          {"right_wheel", r.learnt->right},
                       {"wheel_base", r.learnt->base},          {"gyroscope_bias_rad_s", r.learnt->bias_rad_s},
                       {"tracker_delays_s", r.learnt->delay_s}, {"standard_deviations", r.learnt->sd}};
    if (r.learnt->lag_s) {
      robot["learnt"]["lag_s"] = *r.learnt->lag_s;
      robot["learnt"]["lag_sd_s"] = r.learnt->lag_sd_s;
    }
  }
}

void add_trackers(hal::Json& json, const std::vector<mixed_reality::TrackerStatus>& trackers) {
  hal::Json& all = json["trackers"] = hal::Json::array();
  for (const mixed_reality::TrackerStatus& t : trackers) {
    hal::Json tracker{{"id", t.id},
                      {"kind", t.kind},
                      {"messages", t.heard.messages},
                      {"malformed", t.heard.malformed},
                      {"sightings", t.heard.sightings},
                      {"dropped", t.heard.dropped},
                      {"unknown", t.unknown},
                      {"from_future", t.from_future},
                      {"old", t.old},
                      {"outside", t.outside},
                      {"clock_jumps", t.clock_jumps},
                      {"by_former_date", t.by_former_date}};
    if (t.clock) tracker["clock"] = clock_json(*t.clock);
    if (t.shortest_way_s) tracker["shortest_way_ms"] = 1e3 * *t.shortest_way_s;
    if (!t.unknown_names.empty()) tracker["unknown_names"] = t.unknown_names;
    if (!t.heard.trouble.empty()) tracker["trouble"] = t.heard.trouble;
    for (const auto& [name, count] : t.heard.counts) tracker[name] = count;
    all.push_back(std::move(tracker));
  }
}

void add_real_robots(hal::Json& json, const mixed_reality::MixedReport& report) {
  hal::Json& robots = json["real_robots"] = hal::Json::array();
  for (const mixed_reality::RealRobotReport& r : report.robots) {
    hal::Json robot;
    robot["id"] = r.id;
    robot["link"] = r.link;
    robot["x_m"] = r.pose.x_m;
    robot["y_m"] = r.pose.y_m;
    robot["heading_rad"] = r.pose.heading_rad();
    robot["state"] = r.state;
    robot["driving"] = r.driving;
    robot["stop_confirmed"] = r.stop_confirmed;
    robot["ticks_driving"] = r.counts.ticks_driving;
    robot["ticks_held"] = r.counts.ticks_held;
    robot["stops"] = r.counts.stops;
    robot["rearms"] = r.counts.rearms;
    robot["fenced_ticks"] = r.counts.fenced_ticks;
    robot["intrusions"] = r.counts.intrusions;
    robot["trespasses"] = r.counts.barrier.trespasses;
    robot["held_back_ticks"] = r.counts.barrier.changed_ticks;
    robot["held_back_most_m_s"] = r.counts.barrier.most_m_s;
    if (r.counts.barrier.delay_s > 0.0) robot["measured_delay_s"] = r.counts.barrier.delay_s;
    add_pose(robot, r);
    add_link_report(robot, r.conversation);
    robot["ledger"] = ledger_json(r.ledger);
    robot["incidents"] = r.incidents;
    robots.push_back(std::move(robot));
  }
  if (!report.replacements.empty()) {
    hal::Json& replacements = json["replacements"] = hal::Json::array();
    for (const mixed_reality::ReplacementReport& r : report.replacements)
      replacements.push_back(
          {{"robot", r.robot}, {"before", r.before}, {"after", r.after}, {"link", r.link}, {"tick", r.tick}});
  }
  if (!report.trackers.empty()) add_trackers(json, report.trackers);
  hal::Json& pace = json["pace"];
  pace["ticks"] = report.pace.ticks;
  pace["deadline_misses"] = report.pace.deadline_misses;
  pace["misses_by_machine"] = report.pace.misses_by_machine;
  for (std::size_t i = 0; i < std::min<std::size_t>(report.pace.deadline_misses, mixed_reality::PaceLedger::kKept);
       ++i) {
    const mixed_reality::MissedDeadline& m = report.pace.first_misses[i];
    pace["first_misses"].push_back({{"tick", m.tick},
                                    {"late_ms", to_ms(m.lateness_ns)},
                                    {"ran_ms", to_ms(m.ran_ns)},
                                    {"waited_ms", to_ms(m.waited_ns)},
                                    {"stalled_ms", to_ms(m.stalled_ns)},
                                    {"woke_late_ms", to_ms(m.woke_late_ns)},
                                    {"by_machine", m.by_machine}});
  }
  pace["skipped_slots"] = report.pace.skipped_slots;
  pace["largest_lateness_ms"] = static_cast<double>(report.pace.largest_lateness_ns) * 1e-6;
  pace["wake_up_p99_ms"] = static_cast<double>(report.pace.wake_up.quantile_ns(0.99)) * 1e-6;
  pace["step_p99_ms"] = static_cast<double>(report.pace.step.quantile_ns(0.99)) * 1e-6;
  json["system_clock"] = system_clock_json(report.clock);
}

hal::Json to_json(const InputFile& file) {
  hal::Json json;
  if (!file.id.empty()) json["id"] = file.id;
  if (!file.label.empty()) json["label"] = file.label;
  json["file"] = file.file;
  if (!file.sha256.empty()) json["sha256"] = file.sha256;
  return json;
}

void add_inputs(hal::Json& json, const InputFiles& inputs) {
  const auto add_files = [&json](const char* key, const std::vector<InputFile>& files) {
    hal::Json& list = json[key] = hal::Json::array();
    for (const InputFile& file : files) list.push_back(to_json(file));
  };
  json["file"] = to_json(inputs.experiment);
  if (!inputs.plugins.empty()) add_files("plugins", inputs.plugins);
  add_files("controllers", inputs.controllers);
  if (!inputs.hooks.empty()) add_files("hooks", inputs.hooks);
  if (!inputs.others.empty()) add_files("other_files", inputs.others);
}

void add_members(hal::Json& json, const RunResult& result, bool between_ticks) {
  const core::World& world = result.world;
  add_run_fields(json, world, result.figures, result.robots, between_ticks);
  add_inputs(json, result.inputs);
  const core::Incidents& incidents = world.incidents();
  json["incidents"] = {{"commands_clamped", incidents.commands_clamped},
                       {"commands_not_finite", incidents.commands_not_finite},
                       {"controllers_thrown", incidents.controllers_thrown},
                       {"bodies_escaped", incidents.bodies_escaped},
                       {"first", incidents.first}};
  const core::PhysicsAccuracy accuracy = world.accuracy();
  json["physics"] = {{"largest_constraint_error_m_s", accuracy.constraint_error_m_s},
                     {"unsolved_sub_steps", accuracy.unsolved_sub_steps},
                     {"largest_overlap", accuracy.overlap}};
  if (!world.measures().all().empty()) json["measures"] = world.measures().all();
  if (result.real != nullptr) add_real_robots(json, *result.real);
  if (!result.replay.is_null()) json["replay"] = result.replay;
  if (result.peers != nullptr) json["lockstep"] = lockstep_json(*result.peers);
  json["program"] = to_json(build_info());
  json["settings"] = hal::to_xml(world.scenario().effective);
}

}  // namespace

RunEnd end_of(const core::Run& run, std::int64_t steps_wanted) {
  const core::World& world = run.world();
  RunEnd end{Ended::Length, world.failure(), steps_wanted};
  if (world.state() == core::RunState::Failed) {
    end.how = Ended::Failed;
  } else if (world.state() == core::RunState::Done) {
    end.how = Ended::Hook;
  } else if (run.stopped() && (steps_wanted == 0 || world.tick() < steps_wanted)) {
    end.how = Ended::Interrupted;
  } else if (run.ended_by() != nullptr && run.ended_by()->turn() == core::RunTurn::Added) {
    end.how = Ended::Part;
  }
  return end;
}

InputFiles input_files(const core::Scenario& scenario, const hal::PluginLoader& loader) {
  const auto described = [](std::string id, std::string label, std::string path) {
    const auto digest = hal::sha256_of_file(path);
    return InputFile{std::move(id), std::move(label), std::move(path), digest.ok() ? digest.value() : ""};
  };
  InputFiles files;
  files.experiment = described("", "", scenario.file);
  for (const std::string& library : loader.plugins()) files.plugins.push_back(described("", "", library));
  for (const core::ControllerConfig& config : scenario.controllers) {
    const auto file = loader.find(config.library);
    if (file.ok()) files.controllers.push_back(described(config.id, config.label, file.value().string()));
  }
  for (const core::HookConfig& hook : scenario.hooks) {
    const auto file = loader.find(hook.library);
    if (file.ok()) files.hooks.push_back(described("", hook.label, file.value().string()));
  }
  for (const core::Element& field : scenario.fields) {
    const std::string* path = field.attribute("path");
    if (path != nullptr && !path->empty()) files.others.push_back(described("", "", *path));
  }
  std::string last = scenario.file;
  for (const core::KindConfig& kind : scenario.kinds) {
    if (kind.file != last) files.others.push_back(described("", "", kind.file));
    last = kind.file;
  }
  for (const core::RobotItem& robot : scenario.robots) {
    if (!robot.bridge) continue;
    for (const auto& file :
         mixed_reality::bridge_inputs(loader.catalog(), mixed_reality::bridge_request(scenario, robot, 0)))
      files.others.push_back(described(robot.id, "", file.second));
  }
  return files;
}

hal::Json record_start(const core::World& world, const InputFiles& inputs) {
  hal::Json json;
  json["experiment"] = world.scenario().name;
  json["seed"] = world.seed();
  json["ticks_per_second"] = world.ticks_per_second();
  add_inputs(json, inputs);
  json["program"] = to_json(build_info());
  json["settings"] = hal::to_xml(world.scenario().effective);
  if (const auto areas = areas_of(world.scenario().safety); !areas.empty()) json["areas"] = core::to_json(areas);
  return json;
}

hal::Json record_end(const RunResult& result) {
  hal::Json json;
  json["finished"] = result.end.finished();
  json["ended"] = word_of(result.end.how);
  if (!result.end.failure.empty()) json["failure"] = result.end.failure;
  add_members(json, result, true);
  return json;
}

std::string report_of(const RunResult& result) {
  return hal::to_text(record_end(result));
}

hal::Json report_members(const RunResult& result) {
  hal::Json json;
  add_members(json, result, false);
  return json;
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
    rows.emplace_back("missed deadlines", real != nullptr && figures.deadline_misses > 0
                                              ? fmt::format("{}, {} of them because this computer gave no processor",
                                                            figures.deadline_misses, real->pace.misses_by_machine)
                                              : fmt::format("{}", figures.deadline_misses));
  const std::uint64_t odd = incidents.commands_clamped + incidents.commands_not_finite + incidents.controllers_thrown +
                            incidents.bodies_escaped;
  if (odd > 0) {
    rows.emplace_back("incidents",
                      fmt::format("{} commands clamped, {} not finite, {} controllers threw, {} bodies escaped",
                                  incidents.commands_clamped, incidents.commands_not_finite,
                                  incidents.controllers_thrown, incidents.bodies_escaped));
  }
  if (const core::PhysicsAccuracy accuracy = world.accuracy(); accuracy.unsolved_sub_steps > 0) {
    rows.emplace_back("warning", fmt::format("contacts or joints of {} sub-steps are not solved: velocities are up to "
                                             "{:.3g} m/s off; give the engine shorter sub-steps (iterations)",
                                             accuracy.unsolved_sub_steps, accuracy.constraint_error_m_s));
  }
  for (const auto& [name, value] : world.measures().all()) rows.emplace_back(name, hal::format_number(value));
  if (result.peers != nullptr) {
    std::uint64_t asked_again = 0, odd_answers = 0;
    for (const mixed_reality::PartnerReport& p : result.peers->peers) {
      asked_again += p.asked_again;
      odd_answers += p.doubled + p.wrong_tick + p.not_understood + p.garbled;
    }
    rows.emplace_back("peers", fmt::format("{}, waited for {:.2f} s in all; {} times asked again, {} odd answers",
                                           result.peers->peers.size(), hal::to_seconds(result.peers->waited_ns),
                                           asked_again, odd_answers));
  }
  if (real != nullptr) {
    for (const mixed_reality::RealRobotReport& r : real->robots) {
      rows.emplace_back(
          "real robot",
          fmt::format("{} on {}: {}; {} ticks driving, {} held, {} of {} questions answered, {}", r.id, r.link, r.state,
                      r.counts.ticks_driving, r.counts.ticks_held, r.conversation.answers, r.conversation.questions,
                      r.stop_confirmed ? "stop confirmed" : "STOP NOT CONFIRMED"));
      const mixed_reality::BarrierCounts& barrier = r.counts.barrier;
      if (barrier.changed_ticks + barrier.trespasses + r.counts.intrusions > 0) {
        rows.emplace_back("safety of " + r.id,
                          fmt::format("held back in {} ticks, by {} m/s at most; {} times where it should not be",
                                      barrier.changed_ticks, hal::format_number(barrier.most_m_s),
                                      barrier.trespasses + r.counts.intrusions));
      }
      rows.emplace_back("ledger of " + r.id, ledger_text(r.ledger));
      if (r.sightings) {
        rows.emplace_back(
            "sightings of " + r.id,
            fmt::format("{} used, {} gated, {} late, {} doubled, {} impossible, {} disputed, {} jumps, {} slips",
                        r.sightings->used, r.sightings->gated, r.sightings->late, r.sightings->doubled,
                        r.sightings->impossible, r.sightings->disputed, r.sightings->jumps, r.sightings->slips));
      }
    }
    for (const mixed_reality::TrackerStatus& t : real->trackers) {
      rows.emplace_back(
          "tracker", fmt::format("{}: {} messages, {} malformed, {} sightings, {} of nobody here, {} from "
                                 "the future, {} old, {} outside, {} jumps of its clock",
                                 t.id, t.heard.messages, t.heard.malformed, t.heard.sightings, t.unknown, t.from_future,
                                 t.old, t.outside, t.clock_jumps));
    }
  }
  rows.insert(rows.end(), result.more_rows.begin(), result.more_rows.end());
  print_table(rows);
}

}  // namespace tandem::app
