#include "core/live/inspection.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "core/live/controls.hpp"
#include "core/record/scene_json.hpp"
#include "core/space/stores.hpp"
#include "hal/element.hpp"
#include "hal/open_params.hpp"
#include "hal/unit.hpp"

namespace tandem::core {
namespace {

using hal::Json;

Json pose_json(const Pose& pose) {
  return {{"x", pose.x_m}, {"y", pose.y_m}, {"z", pose.z_m}, {"heading", pose.heading_rad()}};
}

Json halted_json(const Space& space, RobotId robot) {
  Json owners = Json::array();
  for (const auto& [owner, name] :
       {std::pair{HaltOwner::Hook, "hook"}, std::pair{HaltOwner::Controller, "controller"},
        std::pair{HaltOwner::Safety, "safety"}, std::pair{HaltOwner::Operator, "operator"}}) {
    if (space.halted_by(robot, owner)) owners.push_back(name);
  }
  return owners;
}

const char* word_of(hal::Validity validity) noexcept {
  switch (validity) {
    case hal::Validity::Absent:
      return "absent";
    case hal::Validity::Stale:
      return "stale";
    case hal::Validity::Fresh:
      return "fresh";
  }
  return "";
}

Json field_json(const hal::PortType& type, const hal::Field& field, const std::byte* row) {
  Json json{{"name", field.name}, {"unit", field.unit.symbol}, {"doc", field.doc}};
  Json values = Json::array();
  const std::size_t used = hal::used_count(type, row, field);
  for (std::size_t i = 0; i < used; ++i) {
    const double value = hal::get_value(row, field, i);
    if (field.scalar == hal::Scalar::Bool)
      values.push_back(value != 0.0);
    else if (field.scalar == hal::Scalar::F32 || field.scalar == hal::Scalar::F64)
      values.push_back(std::isfinite(value) ? Json(value) : Json(nullptr));
    else
      values.push_back(static_cast<std::int64_t>(value));
  }
  json["values"] = std::move(values);
  if (field.count > 1) json["count"] = field.count;
  return json;
}

Json port_json(const hal::PortType& type, const std::byte* row, hal::TimeNs now_ns) {
  const bool sensor = type.role == hal::Role::Sensor;
  Json json{{"role", sensor ? "sensor" : "actuator"}, {"name", type.name}, {"doc", type.doc}};
  if (sensor) {
    // Those of old records may lack them.
    const auto stamp = [&](const char* name) {
      const hal::Field* const field = type.field(name);
      return field != nullptr ? hal::get_value(row, *field, 0) : 0.0;
    };
    const auto validity = static_cast<hal::Validity>(stamp("validity"));
    const double age_s = hal::to_seconds(now_ns) - 1e-9 * stamp("taken_ns");
    json["validity"] = word_of(validity);
    json["stamp_age_s"] = validity == hal::Validity::Absent ? Json(nullptr) : Json(std::max(0.0, age_s));
  }
  Json fields = Json::array();
  for (const hal::Field& field : type.fields) {
    if (sensor && (field.name == "taken_ns" || field.name == "validity")) continue;
    fields.push_back(field_json(type, field, row));
  }
  json["fields"] = std::move(fields);
  return json;
}

/// Lists parameters with the values that an element gives them.
class ParamLister final : public hal::ParamVisitor {
 public:
  ParamLister(const Element& element, Json& to, std::string prefix = {})
      : element_(element), to_(to), prefix_(std::move(prefix)) {}

  void visit(const hal::Param& param) override {
    const std::string name = prefix_ + std::string(param.name);
    if (const auto* const group = param.group(); group != nullptr) {
      static const Element nothing;
      const Element* child = element_.child(param.name);
      ParamLister inner(child != nullptr ? *child : nothing, to_, name + ".");
      group->describe(group->value, inner);
    } else if (hal::ParamList* const list = param.list(); list != nullptr) {
      list->clear();
      std::size_t count = 0;
      for (const Element& child : element_.children) {
        if (child.name != param.name) continue;
        ParamLister inner(child, to_, name + "[" + std::to_string(count++) + "].");
        list->add(inner);
      }
    } else {
      if (param.name == hal::kArgosParam) {
        *param.as<bool>() = element_.argos;
        return;
      }
      const std::string* const text = element_.attribute(param.name);
      to_.push_back({{"name", name},
                     {"value", text != nullptr ? written(param, *text) : default_of(param)},
                     {"unit", param.bare->symbol},
                     {"doc", param.doc}});
    }
  }

 private:
  static Json written(const hal::Param& param, const std::string& text) {
    if (param.as<bool>() != nullptr) return text == "true" || text == "1" || text == "yes";
    if (double* const number = param.as<double>(); number != nullptr) {
      if (const auto read = hal::parse_quantity(text, *param.bare); read.ok()) *number = read.value();
      return default_of(param);
    }
    return text;
  }
  static Json default_of(const hal::Param& param) {
    if (const auto* const v = param.as<double>(); v != nullptr) return *v / param.bare->to_si;
    if (const auto* const v = param.as<std::int64_t>(); v != nullptr) return *v;
    if (const auto* const v = param.as<bool>(); v != nullptr) return *v;
    if (const std::string* const v = param.text(); v != nullptr) return *v;
    if (const auto* const v = param.as<hal::Interval>(); v != nullptr)
      return hal::format_number(v->least / param.bare->to_si) + ":" + hal::format_number(v->most / param.bare->to_si);
    std::string all;
    for (const double v : *param.as<std::array<double, 3>>())
      all += (all.empty() ? "" : ",") + hal::format_number(v / param.bare->to_si);
    return all;
  }
  const Element& element_;
  Json& to_;
  std::string prefix_;
};

/// A robot that was added shows its configuration's.
Json params_json(const World& world, const RobotGroup& group, const RobotEntity& entity) {
  const Scenario& scenario = world.scenario();
  if (group.config >= scenario.controllers.size() || group.controller->read_params == nullptr) return Json::array();
  const Element* params = &scenario.controllers[group.config].params;
  if (entity.item < scenario.robots.size() && scenario.robots[entity.item].params)
    params = &*scenario.robots[entity.item].params;
  Json all = Json::array();
  ParamLister lister(*params, all);
  try {
    (void)group.controller->read_params(lister);
  } catch (...) {  // it was read before, so nothing depends on it
  }
  return all;
}

Json published_json(const hal::PublishedField& field, const void* controller) {
  Json json{{"name", field.name}, {"unit", field.unit.symbol}, {"doc", field.doc}};
  const auto one = [&](std::size_t i) {
    const double value = hal::value_of(field, controller, i);
    const auto number = static_cast<std::size_t>(value);
    if (value >= 0.0 && number < field.texts.size()) return Json(field.texts[number]);
    return std::isfinite(value) ? Json(value) : Json(nullptr);
  };
  if (field.count == 1) {
    json["value"] = one(0);
  } else {
    json["value"] = Json::array();
    for (std::size_t i = 0; i < field.count; ++i) json["value"].push_back(one(i));
  }
  return json;
}

Json robot_json(const Space& space, const std::string& id, hal::TimeNs now_ns) {
  const SpaceStores& s = space.stores();
  const RobotId robot = space.find_robot(id);
  if (!robot.valid()) return {{"id", id}, {"alive", false}};
  const RobotEntity& entity = s.robots[robot.index];
  const RobotBlock& block = s.blocks[entity.block];
  const RobotGroup& group = s.groups[block.group];
  const Velocity velocity = space.velocity(robot);
  Json json{{"id", id}, {"alive", true}, {"kind", group.kind->name}};
  json["controller"] = group.controller != nullptr ? group.controller->name : std::string_view();
  json["real"] = space.external(robot);
  json["pose"] = pose_json(space.pose(robot));
  json["velocity"] = {
      {"x", velocity.v_m_s[0]}, {"y", velocity.v_m_s[1]}, {"z", velocity.v_m_s[2]}, {"turn", velocity.w_rad_s[2]}};
  json["halted"] = halted_json(space, robot);
  Json ports = Json::array();
  for (std::size_t p = 0; p < group.ports.size(); ++p) {
    const hal::PortType& type = *group.ports[p];
    ports.push_back(port_json(type, block.ports[p] + entity.slot * type.size, now_ns));
  }
  json["ports"] = std::move(ports);
  Json published = Json::array();
  if (block.constructed[entity.slot] != 0) {
    for (const hal::PublishedField& field : group.published)
      published.push_back(published_json(field, block.controller(entity.slot)));
  }
  json["published"] = std::move(published);
  return json;
}

}  // namespace

Json inspection_of(const Space& space, hal::Tick done, std::int64_t ticks_per_second,
                   const std::vector<std::string>& robots) {
  const hal::TimeNs now_ns = hal::time_of_tick(std::max<hal::Tick>(0, done - 1), ticks_per_second);
  Json all{{"tick", done}};
  all["robots"] = Json::array();
  for (const std::string& id : robots) all["robots"].push_back(robot_json(space, id, now_ns));
  return all;
}

Json inspection_of(World& world, const std::vector<std::string>& robots) {
  const SpaceStores& s = world.space().stores();
  Json all = inspection_of(world.space(), world.tick(), world.ticks_per_second(), robots);
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const RobotId robot = world.space().find_robot(robots[i]);
    if (!robot.valid()) continue;
    const RobotEntity& entity = s.robots[robot.index];
    const RobotGroup& group = s.groups[s.blocks[entity.block].group];
    Json& json = all["robots"][i];
    json["controller"] = world.scenario().controllers[group.config].id;
    json["params"] = params_json(world, group, entity);
    json["controls"] = controls_json(world, robot);
  }
  return all;
}

std::vector<std::string> published_names(const Space& space) {
  std::vector<std::string> names;
  for (const RobotGroup& group : space.stores().groups) {
    for (const hal::PublishedField& field : group.published) {
      if (field.count == 1 && std::find(names.begin(), names.end(), field.name) == names.end())
        names.push_back(field.name);
    }
  }
  return names;
}

Json published_values(const Space& space, const std::string& name) {
  const SpaceStores& s = space.stores();
  Json all{{"name", name}, {"values", Json::array()}};
  for (const std::uint32_t row : living_rows(s)) {
    const RobotEntity& robot = s.robots[s.bodies.entity[row]];
    const RobotBlock& block = s.blocks[robot.block];
    const std::vector<hal::PublishedField>& published = s.groups[block.group].published;
    const auto field = std::find_if(published.begin(), published.end(),
                                    [&name](const hal::PublishedField& one) { return one.name == name; });
    const bool there = field != published.end() && field->count == 1 && block.constructed[robot.slot] != 0;
    const double value = there ? hal::value_of(*field, block.controller(robot.slot)) : std::nan("");
    all["values"].push_back(std::isfinite(value) ? Json(value) : Json(nullptr));
    if (there && !field->texts.empty() && !all.contains("words")) all["words"] = field->texts;
  }
  return all;
}

}  // namespace tandem::core
