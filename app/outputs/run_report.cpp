#include "app/outputs/run_report.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>

#include "app/build_info.hpp"
#include "app/experiment/real_side_type.hpp"
#include "app/outputs/report.hpp"
#include "app/process/measure.hpp"
#include "core/record/scene_json.hpp"
#include "hal/json/json_access.hpp"
#include "hal/sha256.hpp"
#include "hal/unit.hpp"
#include "hal/xml/xml.hpp"

namespace tandem::app {
namespace {

using hal::text_of;

std::string_view word_of(Ended how) {
  static constexpr std::string_view kWords[] = {"length", "hook", "part", "interrupted", "failed"};
  return kWords[static_cast<std::size_t>(how)];
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
                       {"first", incidents.first()}};
  const core::PhysicsAccuracy accuracy = world.accuracy();
  json["physics"] = {{"largest_constraint_error_m_s", accuracy.constraint_error_m_s},
                     {"unsolved_sub_steps", accuracy.unsolved_sub_steps},
                     {"largest_overlap", accuracy.overlap}};
  if (!world.measures().all().empty()) json["measures"] = world.measures().all();
  if (!result.more.is_null()) json.update(result.more);
  json["program"] = to_json(build_info());
  json["settings"] = hal::to_xml(world.scenario().effective);
}

constexpr std::size_t kDigitsShown = 12;

/// Files of a list of the record's beginning; what makes no sense is empty.
std::vector<InputFile> files_of(const hal::Json& start, const char* key) {
  std::vector<InputFile> files;
  for (const hal::Json& file : hal::list_of(start, key)) {
    if (file.is_object())
      files.push_back({text_of(file, "id"), text_of(file, "label"), text_of(file, "file"), text_of(file, "sha256")});
  }
  return files;
}

std::string digest_text(const std::string& sha256) {
  return sha256.empty() ? "missing" : sha256.substr(0, kDigitsShown) + "…";
}

bool same_name(const std::string& a, const std::string& b) {
  return std::filesystem::path(a).filename() == std::filesystem::path(b).filename();
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
    if (hook.library == hal::Catalog::kInside) continue;
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
  for (const RealSideType* real : loader.catalog().all<RealSideType>()) {
    for (const RealSideType::Input& input : real->inputs(scenario, loader.catalog()))
      files.others.push_back(described(input.robot, "", input.path));
  }
  return files;
}

std::string changed_files(const hal::Json& start, const InputFiles& now, bool others_named) {
  std::string changed;
  const auto compare = [&](const char* what, const std::vector<InputFile>& recorded,
                           const std::vector<InputFile>& present) {
    for (std::size_t i = 0; i < recorded.size(); ++i) {
      const InputFile& then = recorded[i];
      const bool by_place = i < present.size() && present[i].id == then.id;
      const auto named = std::find_if(present.begin(), present.end(), [&](const InputFile& file) {
        return file.id == then.id && same_name(file.file, then.file);
      });
      const InputFile* const file = named != present.end() ? &*named : by_place ? &present[i] : nullptr;
      // One that the settings hold themselves, as they do kinds of robots, is none of the present ones.
      const auto there = file != nullptr ? hal::Result<std::string>(file->sha256) : hal::sha256_of_file(then.file);
      const std::string sha256 = there.ok() ? there.value() : std::string();
      if (sha256 == then.sha256) continue;
      if (file != nullptr && others_named && !same_name(file->file, then.file)) continue;
      changed += fmt::format("\n  {}{} '{}': in the run {}, now {}", what, then.id.empty() ? "" : " " + then.id,
                             file != nullptr ? file->file : then.file, digest_text(then.sha256), digest_text(sha256));
    }
  };
  compare("plug-in", files_of(start, "plugins"), now.plugins);
  compare("controller", files_of(start, "controllers"), now.controllers);
  compare("hook", files_of(start, "hooks"), now.hooks);
  std::vector<InputFile> others;  // those of bridges have a robot's id, and are of no use here
  for (InputFile& file : files_of(start, "other_files")) {
    if (file.id.empty()) others.push_back(std::move(file));
  }
  compare("file", others, now.others);
  return changed;
}

hal::Json record_start(const core::Scenario& scenario, std::uint64_t seed, const InputFiles& inputs) {
  hal::Json json;
  json["experiment"] = scenario.name;
  json["seed"] = seed;
  json["ticks_per_second"] = scenario.ticks_per_second;
  add_inputs(json, inputs);
  json["program"] = to_json(build_info());
  json["settings"] = hal::to_xml(scenario.effective);
  if (hal::Json areas = core::areas_json(scenario.safety); !areas.empty()) json["areas"] = std::move(areas);
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
    rows.emplace_back("missed deadlines", figures.misses_by_machine && figures.deadline_misses > 0
                                              ? fmt::format("{}, {} of them because this computer gave no processor",
                                                            figures.deadline_misses, *figures.misses_by_machine)
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
  rows.insert(rows.end(), result.more_rows.begin(), result.more_rows.end());
  print_table(rows);
}

}  // namespace tandem::app
