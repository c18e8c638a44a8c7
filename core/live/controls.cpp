#include "core/live/controls.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "core/space/stores.hpp"
#include "hal/element.hpp"
#include "hal/source_files.hpp"
#include "hal/unit.hpp"

namespace tandem::core {
namespace {

using hal::Json;

/// Lists controls.
class Listing final : public hal::Controls {
 public:
  Listing(std::string owner, Json& to) : owner_(std::move(owner)), to_(to) {}

  bool number(std::string_view name, double& value, const hal::Unit& shown, hal::Range range,
              std::string_view doc) override {
    Json& json = begin(name, "number", doc);
    json["value"] = value / shown.to_si;
    json["min"] = range.min / shown.to_si;
    json["max"] = range.max / shown.to_si;
    json["unit"] = shown.symbol;
    return false;
  }
  bool integer(std::string_view name, std::int64_t& value, hal::Range range, std::string_view doc) override {
    Json& json = begin(name, "integer", doc);
    json["value"] = value;
    json["min"] = range.min;
    json["max"] = range.max;
    return false;
  }
  bool flag(std::string_view name, bool& value, std::string_view doc) override {
    begin(name, "flag", doc)["value"] = value;
    return false;
  }
  bool choice(std::string_view name, std::string& value, std::span<const std::string_view> options,
              std::string_view doc) override {
    Json& json = begin(name, "choice", doc);
    json["value"] = value;
    json["options"] = Json::array();
    for (const std::string_view option : options) json["options"].push_back(option);
    return false;
  }
  bool text(std::string_view name, std::string& value, std::string_view doc) override {
    if (name == hal::kSourceFilesControl) return false;
    begin(name, "text", doc)["value"] = value;
    return false;
  }
  bool button(std::string_view name, std::string_view doc) override {
    begin(name, "button", doc);
    return false;
  }

 private:
  Json& begin(std::string_view name, const char* kind, std::string_view doc) {
    to_.push_back({{"owner", owner_}, {"name", name}, {"kind", kind}});
    to_.back()["doc"] = doc;
    return to_.back();
  }
  std::string owner_;
  Json& to_;
};

/// Changes one control, or presses one button.
class Setting final : public hal::Controls {
 public:
  /// `value` null: a button is to be pressed.
  Setting(std::string_view name, const Json* value) : name_(name), value_(value) {}

  bool number(std::string_view name, double& value, const hal::Unit& shown, hal::Range range,
              std::string_view) override {
    if (!meant(name)) return false;
    if (!value_->is_number()) return refuse("is a number");
    const double si = value_->get<double>() * shown.to_si;
    const double slack = 1e-9 * std::max(std::fabs(range.min), std::fabs(range.max));  // of the unit's rounding
    if (!(si >= range.min - slack && si <= range.max + slack)) {
      return refuse("lies between " + hal::format_quantity(range.min, shown) + " and " +
                    hal::format_quantity(range.max, shown));
    }
    return change(value, std::clamp(si, range.min, range.max));
  }
  bool integer(std::string_view name, std::int64_t& value, hal::Range range, std::string_view) override {
    if (!meant(name)) return false;
    if (!value_->is_number_integer()) return refuse("is a whole number");
    const auto wanted = value_->get<std::int64_t>();
    if (static_cast<double>(wanted) < range.min || static_cast<double>(wanted) > range.max)
      return refuse("lies between " + hal::format_number(range.min) + " and " + hal::format_number(range.max));
    return change(value, wanted);
  }
  bool flag(std::string_view name, bool& value, std::string_view) override {
    if (!meant(name)) return false;
    return value_->is_boolean() ? change(value, value_->get<bool>()) : refuse("is true or false");
  }
  bool choice(std::string_view name, std::string& value, std::span<const std::string_view> options,
              std::string_view) override {
    if (!meant(name)) return false;
    const auto wanted = value_->is_string() ? value_->get<std::string>() : std::string();
    if (std::find(options.begin(), options.end(), wanted) != options.end()) return change(value, wanted);
    return refuse("is one of: " + hal::listed({options.begin(), options.end()}));
  }
  bool text(std::string_view name, std::string& value, std::string_view) override {
    if (name == hal::kSourceFilesControl || !meant(name)) return false;
    return value_->is_string() ? change(value, value_->get<std::string>()) : refuse("is a text");
  }
  bool button(std::string_view name, std::string_view) override {
    names_.emplace_back(name);
    if (name != name_ || value_ != nullptr) return false;
    found_ = true;
    return true;
  }

  /// Whether it was done. Error: why not.
  hal::Status done(const std::string& owner) const {
    if (!refused_.empty()) return hal::Error{owner + ": " + refused_};
    if (found_) return {};
    const bool there = std::find(names_.begin(), names_.end(), name_) != names_.end();
    return hal::Error{owner + " has no " + (value_ == nullptr ? "button" : "value") + " '" + std::string(name_) +
                      "' to " + (value_ == nullptr ? "press" : "set") +
                      "; its controls are: " + (names_.empty() ? "none" : hal::listed(names_)) +
                      (there ? "" : hal::did_you_mean(name_, names_))};
  }

 private:
  bool meant(std::string_view name) {
    names_.emplace_back(name);
    return name == name_ && value_ != nullptr;
  }
  bool refuse(const std::string& why) {
    refused_ = "'" + std::string(name_) + "' " + why + "; it stays as it is";
    return false;
  }
  template <class T>
  bool change(T& value, const T& wanted) {
    found_ = true;
    if (value == wanted) return false;
    value = wanted;
    return true;
  }

  std::string_view name_;
  const Json* value_;
  std::vector<std::string> names_;
  bool found_ = false;
  std::string refused_;
};

std::string owner_of_hook(const World& world, std::size_t hook) {
  std::size_t before = 0;
  for (std::size_t i = 0; i < hook; ++i) before += world.hook_name(i) == world.hook_name(hook) ? 1U : 0U;
  return "hook:" + world.hook_name(hook) + (before == 0 ? "" : "#" + std::to_string(before + 1));
}

hal::Status change(World& world, const std::string& owner, std::string_view name, const Json* value) {
  for (std::size_t i = 0; i < world.hooks(); ++i) {
    if (owner_of_hook(world, i) != owner) continue;
    Setting setting(name, value);
    const hal::Status called = world.visit_controls(i, setting);
    return called.ok() ? setting.done(owner) : hal::Status(hal::Error{owner + ": " + called.error().message});
  }
  std::vector<RobotId> robots;
  if (owner.starts_with("robot:")) {
    const RobotId robot = world.space().find_robot(owner.substr(6));
    if (!robot.valid()) return hal::Error{"there is no robot '" + owner.substr(6) + "', or no more"};
    robots.push_back(robot);
  }
  const auto& configs = world.scenario().controllers;
  for (std::size_t c = 0; c < configs.size(); ++c) {
    if (owner != "controller:" + configs[c].id) continue;
    robots = robots_of(world, c);
    if (robots.empty()) return hal::Error{"no robot has the controller '" + configs[c].id + "' now"};
  }
  if (robots.empty()) {
    std::vector<std::string> owners;
    for (std::size_t i = 0; i < world.hooks(); ++i) owners.push_back(owner_of_hook(world, i));
    for (const auto& config : configs) owners.push_back("controller:" + config.id);
    return hal::Error{"there is no owner '" + owner + "' of controls; there are robot:<id>, " + hal::listed(owners) +
                      hal::did_you_mean(owner, owners)};
  }
  for (const RobotId robot : robots) {
    Setting setting(name, value);
    const hal::Status called = world.visit_controls(robot, setting);
    if (!called.ok()) return hal::Error{owner + ": " + called.error().message};
    if (const hal::Status done = setting.done(owner); !done.ok()) return done;  // by the first: all are of one class
  }
  return {};
}

}  // namespace

Json controls_json(World& world) {
  Json all = Json::array();
  for (std::size_t i = 0; i < world.hooks(); ++i) {
    Listing listing(owner_of_hook(world, i), all);
    (void)world.visit_controls(i, listing);  // one that throws shows what it listed before
  }
  const auto& configs = world.scenario().controllers;
  const SpaceStores& s = world.space().stores();
  for (std::size_t c = 0; c < configs.size(); ++c) {
    for (const std::uint32_t entity : s.living) {
      const RobotEntity& e = s.robots[entity];
      if (s.groups[s.blocks[e.block].group].config != c) continue;
      Listing listing("controller:" + configs[c].id, all);
      (void)world.visit_controls(RobotId{entity, e.generation}, listing);
      break;
    }
  }
  return all;
}

Json controls_json(World& world, RobotId robot) {
  Json all = Json::array();
  Listing listing("robot:" + world.space().robot_name(robot), all);
  (void)world.visit_controls(robot, listing);
  return all;
}

hal::Status set_control(World& world, const std::string& owner, std::string_view name, const Json& value) {
  return change(world, owner, name, &value);
}

hal::Status press_button(World& world, const std::string& owner, std::string_view name) {
  return change(world, owner, name, nullptr);
}

}  // namespace tandem::core
