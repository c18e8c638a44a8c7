#include "app/real/replay_run.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>

#include "app/build_info.hpp"
#include "app/experiment/reading.hpp"
#include "app/process/terminal.hpp"
#include "core/record/record_reader.hpp"
#include "hal/element.hpp"
#include "hal/json/json_access.hpp"

namespace tandem::app {
namespace {

using hal::text_of;

/// The configuration that is asked for in "ROBOT=ID" or "KIND=ID".
hal::Status choose_controller(core::Scenario& scenario, const std::string& asked) {
  const std::size_t equals = asked.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == asked.size())
    return hal::Error{"--controller " + asked + ": it is written ROBOT=ID or KIND=ID"};
  const std::string whose = asked.substr(0, equals), id = asked.substr(equals + 1);
  std::vector<std::string> ids, robots;
  std::optional<std::size_t> config;
  for (std::size_t i = 0; i < scenario.controllers.size(); ++i) {
    ids.push_back(scenario.controllers[i].id);
    if (ids.back() == id) config = i;
  }
  if (!config) {
    std::string known;
    for (const std::string& one : ids) known += (known.empty() ? "" : ", ") + one;
    return hal::Error{"--controller " + asked + ": the experiment has no configuration '" + id +
                      "' among its <controllers>" + hal::did_you_mean(id, ids) + "; it has: " + known};
  }
  bool any = false;
  for (core::RobotItem& item : scenario.robots) {
    robots.push_back(item.id);
    robots.push_back(item.kind);
    if (item.id != whose && item.kind != whose) continue;
    item.controller = *config;
    any = true;
  }
  if (any) return {};
  return hal::Error{"--controller " + asked + ": the experiment has no robot and no kind '" + whose + "'" +
                    hal::did_you_mean(whose, robots)};
}

}  // namespace

bool ReplayRun::open(ExperimentReading& reading) {
  auto record = core::RecordReader::open(asked_.record);
  if (!record.ok()) return complain(kBadInput, record.error().message) == kDone;
  start_ = record.value().start();
  settings_ = text_of(start_, "settings");
  name_ = text_of(hal::object_of(start_, "file"), "file");
  if (settings_.empty() || name_.empty()) {
    return complain(kBadInput, "record '" + asked_.record +
                                   "' does not hold the experiment of its run, so it cannot be computed again") ==
           kDone;
  }
  return reading.open_text(settings_, name_, changes_later() ? std::vector<std::string>() : options_.overrides);
}

hal::Status ReplayRun::check_record_path() const {
  if (!options_.record.empty() && std::filesystem::exists(options_.record) &&
      std::filesystem::equivalent(options_.record, asked_.record))
    return hal::Error{"--record would overwrite the record that is replayed"};
  return {};
}

void ReplayRun::leave_robots_out(core::Scenario& scenario) const {
  for (core::RobotItem& item : scenario.robots) {
    item.bridge.reset();
    item.peer.reset();
  }
  scenario.trackers.clear();
  scenario.record.path.clear();
  scenario.trajectory.reset();
  scenario.observers.clear();
  scenario.run_parts.clear();
  scenario.priority = 0;
  const bool paced = options_.view.on && scenario.time_mode == core::TimeMode::Realtime;
  if (!paced) scenario.time_mode = core::TimeMode::Fast;
}

bool ReplayRun::prepare(core::Scenario& scenario, hal::PluginLoader& loader) {
  if (const hal::Status path = check_record_path(); !path.ok())
    return complain(kBadInput, path.error().message) == kDone;
  leave_robots_out(scenario);
  if (changes_later()) {
    ExperimentReading other(loader, options_.plugins);
    if (!other.open_text(settings_, name_, options_.overrides)) return false;
    changed_ = other.read();
    if (!changed_) return false;
    leave_robots_out(*changed_);
  }
  core::Scenario& to_change = changed_ ? *changed_ : scenario;
  for (const std::string& asked : asked_.controllers) {
    if (const hal::Status chosen = choose_controller(to_change, asked); !chosen.ok())
      return complain(kBadInput, chosen.error().message) == kDone;
  }
  if (!changed_) return true;
  // What no world can be made of is told now, not at the tick: devices that a controller lacks, values out of range.
  core::WorldOptions options;
  options.threads = 0;
  core::Problems problems;
  if (core::World::make(*changed_, loader, options, problems) != nullptr) return true;
  print_problems(problems);
  return false;
}

hal::Status ReplayRun::check_files(const InputFiles& now) const {
  const std::string changed = changed_files(start_, now, changed_from_start());
  if (changed.empty()) return {};
  const std::string text = "files are not those of the run of '" + asked_.record + "':" + changed;
  if (!asked_.accept_changes)
    return hal::Error{text + "\nput back what there was, or take what there is with --accept-changes"};
  say(text);
  return {};
}

hal::Status ReplayRun::join(core::World& world, const hal::Log& log) {
  ticks_per_second_ = world.ticks_per_second();
  auto made = mixed_reality::Replay::make(world, asked_.record, {asked_.from, log});
  if (!made.ok()) return made.error();
  replay_ = std::move(made).value();
  if (replay_->recorded_ticks() == 0) return hal::Error{"record '" + asked_.record + "' holds no tick"};
  if (asked_.from && *asked_.from >= replay_->recorded_ticks()) {
    return hal::Error{fmt::format("--from {}: the record '{}' has {} ticks, 0 to {}", *asked_.from, asked_.record,
                                  replay_->recorded_ticks(), replay_->recorded_ticks() - 1)};
  }
  if (!changed_) return {};
  if (const hal::Status can = world.can_continue_with(*changed_); !can.ok()) {
    return hal::Error{
        fmt::format("--from {}: what --set changes there {}. Leave out --from: then it holds from the start",
                    *asked_.from, can.error().message)};
  }
  return {};
}

std::int64_t ReplayRun::steps() const {
  return asked_.until.value_or(replay_->recorded_ticks());
}

const core::SpaceInputs* ReplayRun::inputs() const noexcept {
  return replay_->ticks() < steps() ? nullptr : &replay_->inputs();
}

bool ReplayRun::tick_done(const core::Repeatable& recorded, const core::World& world) {
  const hal::Tick tick = world.tick() - 1;
  if (first_difference_ || tick >= replay_->ticks()) return true;
  const auto known = recorded.fingerprints.find(tick);
  if (known == recorded.fingerprints.end()) return true;
  if (known->second == world.state_hash()) {
    ++compared_;
    return true;
  }
  first_difference_ = tick;
  difference_ = replay_->difference();
  const std::string where = difference_.empty() ? "" : ": " + difference_;
  if (changed_from_start()) {
    say(fmt::format("tick {} is the first that is not as recorded, with what was changed{}", tick, where));
    return true;
  }
  const hal::Json now = to_json(build_info());
  const auto then = start_.find("program");
  const bool same = then != start_.end() && text_of(*then, "commit") == text_of(now, "commit") &&
                    text_of(*then, "build") == text_of(now, "build");
  complain(
      kFailedRunning,
      fmt::format("tick {} is not as in {}{}; {}", tick, asked_.record, where,
                  same ? "a controller or hook depends on something besides its inputs (a clock, a file, chance of "
                         "its own), or another file or plug-in is in use"
                       : "the record was written by another build of this program (" +
                             (then != start_.end() ? text_of(*then, "version") + " " + text_of(*then, "commit")
                                                   : std::string("unknown")) +
                             ")"));
  return false;
}

std::string ReplayRun::changes() const {
  std::string what;
  for (const auto* all : {&options_.overrides, &asked_.controllers}) {
    for (const std::string& one : *all) what += (what.empty() ? "" : ", ") + one;
  }
  return what;
}

std::string ReplayRun::next_tick(core::World& world) {
  if (!changed_ || world.tick() != *asked_.from || world.state() != core::RunState::Running) return {};
  return world.continue_with(*changed_).ok() ? changes() : std::string();
}

bool ReplayRun::finish(const core::World& world) {
  const bool short_of = replay_->recorded_end() != "the run ended";
  const bool came_there = world.tick() >= replay_->recorded_ticks();
  if (short_of && came_there)
    say(fmt::format("inputs of real robots end after tick {}: {}", replay_->recorded_ticks() - 1,
                    replay_->recorded_end()));
  if (asked_.until && *asked_.until > replay_->recorded_ticks() && !asked_.from) {
    say(fmt::format("from tick {} on the robots were simulated, because nothing is recorded of them",
                    replay_->recorded_ticks()));
  }
  return replay_->failure().empty();
}

hal::Json ReplayRun::json() const {
  hal::Json json = {{"record", asked_.record},
                    {"ticks_recorded", replay_->recorded_ticks()},
                    {"recorded_end", replay_->recorded_end()},
                    {"ticks_compared", compared_},
                    {"simulated_from", replay_->ticks()}};
  if (changed()) {
    json["changed_from"] = changes_later() ? *asked_.from : 0;
    json["set"] = options_.overrides;
    json["controllers"] = asked_.controllers;
  }
  if (first_difference_) {
    json["first_difference"] = *first_difference_;
    json["difference"] = difference_;
  }
  hal::Json& robots = json["deviations"] = hal::Json::array();
  for (const mixed_reality::Deviation& d : replay_->deviations()) {
    if (d.ticks() > 0) robots.push_back(d.json(ticks_per_second_));
  }
  return json;
}

std::vector<std::pair<std::string, std::string>> ReplayRun::rows() const {
  std::vector<std::pair<std::string, std::string>> rows;
  rows.emplace_back(
      "replay", fmt::format("{} of {} recorded ticks are as they were{}", compared_, replay_->recorded_ticks(),
                            first_difference_ ? fmt::format("; tick {} is not", *first_difference_) : std::string()));
  if (changed_) rows.emplace_back("what if", fmt::format("from tick {} on {}", *asked_.from, changes()));
  for (const mixed_reality::Deviation& d : replay_->deviations()) {
    if (d.ticks() < 2) continue;
    rows.emplace_back(
        "what if " + d.robot(),
        fmt::format("simulated from tick {} on; from the real one {:.1f} mm after 1 s, {:.1f} mm RMS, {:.1f} "
                    "mm at most, {:.1f} mm and {:.1f} degrees RMS in the end of {} ticks",
                    replay_->ticks(), 1e3 * d.max_within_m(ticks_per_second_ + 1), 1e3 * d.rms_m(), 1e3 * d.max_m(),
                    1e3 * d.last_m(), d.rms_rad() * 57.29577951308232, d.ticks()));
  }
  return rows;
}

}  // namespace tandem::app
