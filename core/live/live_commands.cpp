// Commands to a live run, which its thread carries out between two ticks.
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/live/controls.hpp"
#include "core/live/field_ref.hpp"
#include "core/live/inspection.hpp"
#include "core/live/live_run_impl.hpp"
#include "core/live/touch.hpp"
#include "hal/json/json_access.hpp"

namespace tandem::core {
namespace {

using hal::Json;

constexpr hal::TimeNs kHistory_ns = hal::kNsPerSecond;  // that a look back may hold the run up
constexpr std::size_t kMostSamples = 10'000;
constexpr double kLongestCommand = 1e9;

/// A whole number from `least` on. Error: missing, or something else.
hal::Result<std::int64_t> whole(const Json& json, const char* key, std::int64_t least,
                                std::optional<std::int64_t> otherwise = {}) {
  const auto found = json.find(key);
  if (found == json.end() && otherwise) return *otherwise;
  if (found != json.end() && found->is_number_integer() && found->get<double>() < kLongestCommand &&
      found->get<std::int64_t>() >= least)
    return found->get<std::int64_t>();
  return hal::Error{"\"" + std::string(key) + "\" is a whole number from " + std::to_string(least) + " on"};
}

/// A speed: times real time; null: as fast as possible.
hal::Result<std::optional<double>> speed_of(const Json& json) {
  if (json.is_null()) return std::optional<double>();
  if (json.is_number()) {
    const double times = json.get<double>();
    if (times >= 0.001 && times <= 1e6) return std::optional<double>(times);
  }
  return hal::Error{"a speed is a number from 0.001 to 1000000, times real time, or null: as fast as possible"};
}

std::vector<std::string> texts(const Json& json, const char* key) {
  std::vector<std::string> all;
  for (const Json& text : hal::list_of(json, key)) {
    if (text.is_string()) all.push_back(text.get<std::string>());
  }
  return all;
}

}  // namespace

void LiveRun::Impl::add_commands() {
  commands["play"] = [this](const Json& c) { return play(c); };
  commands["pause"] = [this](const Json& c) { return pause(c); };
  commands["step"] = [this](const Json& c) { return step(c); };
  commands["speed"] = [this](const Json& c) { return set_speed(c); };
  commands["go_to"] = [this](const Json& c) { return go_to(c); };
  commands["reset"] = [this](const Json& c) { return reset(c); };
  commands["undo"] = [this](const Json&) { return undo(); };
  commands["stop_when"] = [this](const Json& c) { return stop_when(c); };
  commands["history"] = [this](const Json& c) { return history(c); };
  commands["inspect"] = [this](const Json& c) -> hal::Result<Json> { return inspection_of(world, texts(c, "robots")); };
  commands["controls"] = [this](const Json&) -> hal::Result<Json> { return Json{{"controls", controls_json(world)}}; };
  for (const char* name : {"move", "add", "remove", "light", "halt", "release", "set", "press", "reload"})
    commands[name] = [this](const Json& c) { return act(c); };
}

hal::Result<Json> LiveRun::Impl::play(const Json& c) {
  if (options.real_robots) return pause_real(false, c);
  if (over()) return hal::Error{"the run has ended (" + why_ended() + "): go back to an earlier tick, or reset it"};
  if (c.contains("speed")) {
    const auto wanted = speed_of(c["speed"]);
    if (!wanted.ok()) return wanted.error();
    speed = wanted.value();
  }
  paused = false;
  steps_wanted = 0;
  stopped_by.clear();
  begin_schedule();
  return here();
}

/// Of a run with real robots.
hal::Result<Json> LiveRun::Impl::pause_real(bool on, const Json& c) {
  if (!options.pause_real) return no_pause().error();
  if (const hal::Status done = options.pause_real(on); !done.ok()) return done.error();
  paused = on;
  Json action = c;
  action.erase("id");
  timeline.note(action);
  return here();
}

hal::Result<Json> LiveRun::Impl::pause(const Json& c) {
  if (options.real_robots) return pause_real(true, c);
  paused = true;
  steps_wanted = 0;
  return here();
}

hal::Result<Json> LiveRun::Impl::step(const Json& c) {
  if (const hal::Status can = no_pause(); !can.ok()) return can.error();
  const auto ticks = whole(c, "ticks", 1, 1);
  if (!ticks.ok()) return ticks.error();
  if (over()) return hal::Error{"the run has ended (" + why_ended() + "): go back to an earlier tick, or reset it"};
  paused = true;
  steps_wanted = ticks.value();
  stopped_by.clear();
  return here();
}

hal::Result<Json> LiveRun::Impl::set_speed(const Json& c) {
  if (const hal::Status can = no_pause(); !can.ok()) return can.error();
  const auto times = c.find("times");
  if (times == c.end())
    return hal::Error{"\"times\" is missing: how many times real time, or null: as fast as possible"};
  const auto wanted = speed_of(*times);
  if (!wanted.ok()) return wanted.error();
  speed = wanted.value();
  begin_schedule();
  return Json::object();
}

hal::Result<Json> LiveRun::Impl::go_to(const Json& c) {
  const auto tick = whole(c, "tick", 0);
  if (!tick.ok()) return tick.error();
  if (const hal::Status gone = timeline.go_to(tick.value()); !gone.ok()) return gone.error();
  paused = true;
  steps_wanted = tick.value() - world.tick();  // what is to be recorded again
  stopped_by.clear();
  moved();
  return here();
}

hal::Result<Json> LiveRun::Impl::reset(const Json& c) {
  if (options.real_robots) return hal::Error{"there is no reset: real robots take part, which cannot be put back"};
  Json action{{"do", "reset"}};
  if (c.contains("seed")) action["seed"] = c["seed"];
  auto done = timeline.act(action);
  stopped_by.clear();
  moved();
  return done;
}

hal::Result<Json> LiveRun::Impl::undo() {
  auto done = timeline.undo();
  if (done.ok()) moved();
  return done;
}

hal::Result<Json> LiveRun::Impl::act(const Json& c) {
  Json action = c;
  action.erase("id");  // of the message
  if (!options.real_robots) {
    auto done = timeline.act(std::move(action));
    if (done.ok()) shown();
    return done;
  }
  auto done = touch(world, action);
  if (done.ok()) timeline.note(action);
  return done;
}

hal::Result<Json> LiveRun::Impl::stop_when(const Json& c) {
  if (hal::flag_of(c, "clear")) {
    conditions.clear();
    return Json::object();
  }
  if (const hal::Status can = no_pause(); !can.ok()) return can.error();
  const hal::Status added = conditions.add(c, world);
  if (!added.ok()) return added.error();
  return Json::object();
}

hal::Result<Json> LiveRun::Impl::history(const Json& c) {
  const auto field = read_field_ref(c);
  if (!field.ok()) return field.error();
  const auto robot = c.find("robot");
  if (robot == c.end() || !robot->is_string()) return hal::Error{"\"robot\" is missing: an id"};
  const auto id = robot->get<std::string>();
  const RobotId now = world.space().find_robot(id);
  if (now.valid()) {
    if (const auto known = value_of(field.value(), world.space(), now); !known.ok()) return known.error();
  }
  const auto from = whole(c, "from", 0, timeline.first_tick());
  const auto to = whole(c, "to", 0, world.tick());
  const auto every = whole(c, "every", 1, 1);
  for (const auto* number : {&from, &to, &every}) {
    if (!number->ok()) return number->error();
  }
  if (!timeline.no_way_back().empty()) return hal::Error{"there is no past to be had: " + timeline.no_way_back()};
  hal::Tick first = std::max(from.value(), timeline.first_tick());
  const hal::Tick last = std::min(to.value(), timeline.latest_tick());
  if (first > last)
    return hal::Error{"there are ticks " + std::to_string(timeline.first_tick()) + " to " +
                      std::to_string(timeline.latest_tick())};
  std::int64_t stride = every.value();
  stride = std::max(stride, (last - first) / static_cast<std::int64_t>(kMostSamples) + 1);
  const hal::Tick affordable = kHistory_ns / std::max<hal::TimeNs>(1000, timeline.step_cost_ns());
  Json answer;
  if (timeline.ticks_of_look(first, last) > affordable) {
    first = std::max(first, last - affordable);
    if (!timeline.no_checkpoint().empty() && timeline.ticks_of_look(first, last) > affordable)
      return hal::Error{"there is no past to be had within a second, for the run is computed again: " +
                        timeline.no_checkpoint()};
    answer["bounded"] = "the last " + std::to_string(last - first) +
                        " ticks: to compute more of them again would hold the run up for more than a second";
  }
  Json ticks = Json::array();
  Json values = Json::array();
  const hal::Status looked = timeline.look_back(first, last, [&](hal::Tick tick) {
    if ((tick - first) % stride != 0) return;
    ticks.push_back(tick);
    const auto value = value_of(field.value(), world.space(), world.space().find_robot(id));
    const bool number = value.ok() && value.value() && std::isfinite(*value.value());
    values.push_back(number ? Json(*value.value()) : Json(nullptr));
  });
  begin_schedule();
  if (!looked.ok()) return looked.error();
  answer["ticks"] = std::move(ticks);
  answer["values"] = std::move(values);
  return answer;
}

}  // namespace tandem::core
