#include "core/live/condition.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "hal/element.hpp"
#include "hal/json/json_access.hpp"
#include "hal/rounded.hpp"
#include "hal/unit.hpp"

namespace tandem::core {
namespace {

constexpr std::array<std::string_view, 4> kOps{"<", ">", "==", "!="};

/// The number that `json` stands for: itself, or its place among an enumeration's names.
hal::Result<double> wanted_value(const hal::Json& json, const std::vector<std::string>& texts) {
  if (json.is_number()) return json.get<double>();
  if (json.is_boolean()) return json.get<bool>() ? 1.0 : 0.0;
  if (json.is_string() && !texts.empty()) {
    const auto text = json.get<std::string>();
    const auto found = std::find(texts.begin(), texts.end(), text);
    if (found != texts.end()) return static_cast<double>(found - texts.begin());
    return hal::Error{"\"value\" is none of: " + hal::listed(texts) + hal::did_you_mean(text, texts)};
  }
  return hal::Error{"\"value\" is a number"};
}

}  // namespace

hal::Status Conditions::add(const hal::Json& json, const World& world) {
  if (all_.size() == kMost)
    return hal::Error{"there are " + std::to_string(kMost) + " conditions already; remove them first (\"clear\")"};
  Condition c;
  if (hal::flag_of(json, "incident")) {
    c.incident = true;
    c.words = "an incident";
    incidents_ = incidents_of(world);
    all_.push_back(std::move(c));
    return {};
  }
  const auto robot = json.find("robot");
  if (robot == json.end() || !robot->is_string()) return hal::Error{"\"robot\" is missing: an id, or \"*\" for any"};
  c.robot = robot->get<std::string>();
  auto field = read_field_ref(json);
  if (!field.ok()) return field.error();
  c.field = std::move(field).value();
  const auto known = std::find(kOps.begin(), kOps.end(), hal::text_of(json, "op"));
  if (known == kOps.end()) return hal::Error{"\"op\" is one of <, >, ==, !="};
  c.op = static_cast<Op>(known - kOps.begin());

  const SpaceStores& s = world.space().stores();
  hal::Result<FieldPlace> place = hal::Error{"there are no robots"};
  if (c.robot == "*") {
    for (const RobotGroup& group : s.groups) {
      place = FieldPlace::find(c.field, group);
      if (place.ok()) break;
    }
  } else {
    const RobotId id = world.space().find_robot(c.robot);
    if (!id.valid()) return hal::Error{"there is no robot '" + c.robot + "'"};
    place = FieldPlace::find(c.field, s.groups[s.blocks[s.robots[id.index].block].group]);
  }
  if (!place.ok()) return place.error();
  const auto value = json.find("value");
  const auto number = wanted_value(value == json.end() ? hal::Json() : *value, place.value().texts());
  if (!number.ok()) return number.error();
  c.value = number.value();
  c.words = c.field.text() + " " + std::string(*known) + " " +
            (value->is_string() ? value->get<std::string>() : hal::format_number(c.value));
  all_.push_back(std::move(c));
  return {};
}

bool Conditions::holds(const Condition& c, std::optional<double> value) noexcept {
  if (!value) return false;
  switch (c.op) {
    case Op::Below:
      return *value < c.value;
    case Op::Above:
      return *value > c.value;
    case Op::Equal:
      return *value == c.value;
    case Op::Unequal:
      return *value != c.value;
  }
  return false;
}

std::string Conditions::who(const Condition& c, const World& world) {
  const Space& space = world.space();
  const SpaceStores& s = space.stores();
  const auto told = [&](const std::string& id, double value) {
    return "robot '" + id + "': " + c.words + " (it is " + hal::rounded(value, 6) + ")";
  };
  if (c.robot != "*") {
    const auto value = value_of(c.field, space, space.find_robot(c.robot));
    return value.ok() && holds(c, value.value()) ? told(c.robot, *value.value()) : std::string();
  }
  for (const RobotGroup& group : s.groups) {
    const auto place = FieldPlace::find(c.field, group);
    if (!place.ok()) continue;
    for (const std::size_t b : group.blocks) {
      const RobotBlock& block = s.blocks[b];
      for (std::size_t slot = 0; slot < block.used; ++slot) {
        const std::size_t row = block.first_row + slot;
        if ((s.bodies.flags[row] & kAlive) == 0) continue;
        const auto value = place.value().value(s, block, slot);
        if (!holds(c, value)) continue;
        const std::uint32_t entity = s.bodies.entity[row];
        return told(space.robot_name({entity, s.robots[entity].generation}), *value);
      }
    }
  }
  return {};
}

std::uint64_t Conditions::incidents_of(const World& world) noexcept {
  const Incidents& i = world.incidents();
  return i.controllers_thrown + i.bodies_escaped + i.causes.size();
}

void Conditions::forget(const World& world) noexcept {
  incidents_ = incidents_of(world);
}

std::string Conditions::check(const World& world) {
  std::string all;
  for (Condition& c : all_) {
    std::string now;
    if (c.incident) {
      const std::uint64_t incidents = incidents_of(world);
      if (incidents > incidents_)
        now = world.incidents().causes.empty()
                  ? "an incident"
                  : "incident: " + world.incidents().causes.at(world.incidents().latest).text();
      incidents_ = incidents;
      c.held = false;
    } else {
      now = who(c, world);
    }
    if (!now.empty() && !c.held) all += (all.empty() ? "" : "; ") + now;
    c.held = !now.empty();
  }
  return all;
}

}  // namespace tandem::core
