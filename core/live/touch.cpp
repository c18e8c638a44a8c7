#include "core/live/touch.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <vector>

#include "core/live/controls.hpp"
#include "core/live/source_files.hpp"
#include "core/space/stores.hpp"
#include "hal/element.hpp"
#include "hal/json/json_access.hpp"
#include "hal/unit.hpp"

namespace tandem::core {
namespace {

using hal::Json;

constexpr std::array<std::string_view, 9> kTouches{"move",    "add", "remove", "light", "halt",
                                                   "release", "set", "press",  "reload"};
constexpr double kFarthest_m = 1e6;
constexpr std::size_t kLongestId = 64;

/// Members of a JSON object, and the first thing that is wrong with them.
class Members {
 public:
  Members(const Json& json, std::string what) : json_(json), what_(std::move(what)) {}

  bool has(const char* key) const { return json_.contains(key); }
  double number(const char* key, double otherwise) {
    const auto found = json_.find(key);
    if (found == json_.end()) return otherwise;
    if (found->is_number() && std::isfinite(found->get<double>()) && std::fabs(found->get<double>()) <= kFarthest_m)
      return found->get<double>();
    return complain(key, "is a number, in m or rad", otherwise);
  }
  double needed(const char* key) { return has(key) ? number(key, 0.0) : complain(key, "is missing", 0.0); }
  bool flag(const char* key, bool otherwise) {
    const auto found = json_.find(key);
    if (found == json_.end()) return otherwise;
    return found->is_boolean() ? found->get<bool>() : complain(key, "is true or false", otherwise);
  }
  std::string text(const char* key, const std::string& otherwise = {}) {
    const auto found = json_.find(key);
    if (found == json_.end()) return otherwise;
    return found->is_string() ? found->get<std::string>() : complain(key, "is a text", otherwise);
  }
  /// For something new: short, and without what would break a line of a table. Empty where it is missing.
  std::string id(const char* key) {
    const std::string wanted = text(key);
    const auto odd = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; };
    if (wanted.size() <= kLongestId && std::none_of(wanted.begin(), wanted.end(), odd)) return wanted;
    return complain(key, "has at most 64 characters, none of them a control character", std::string());
  }
  hal::Rgb color(const char* key, hal::Rgb otherwise) {
    const std::string hex = text(key);
    if (hex.empty()) return otherwise;
    std::uint32_t rgb = 0;
    const auto [end, status] = std::from_chars(hex.data() + 1, hex.data() + hex.size(), rgb, 16);
    if (hex.size() == 7 && hex[0] == '#' && status == std::errc{} && end == hex.data() + 7)
      return {static_cast<std::uint8_t>(rgb >> 16), static_cast<std::uint8_t>(rgb >> 8),
              static_cast<std::uint8_t>(rgb)};
    return complain(key, "is a colour like \"#ff8000\"", otherwise);
  }
  /// "x", "y", "z", "heading", where they stand; else those of `otherwise`.
  Pose pose(const Pose& otherwise) {
    Pose pose{number("x", otherwise.x_m), number("y", otherwise.y_m), number("z", otherwise.z_m), otherwise.cos_h,
              otherwise.sin_h};
    if (!has("heading")) return pose;
    const double heading_rad = number("heading", 0.0);
    pose.cos_h = std::cos(heading_rad);
    pose.sin_h = std::sin(heading_rad);
    return pose;
  }

  const hal::Status& status() const noexcept { return status_; }

 private:
  template <class T>
  T complain(const char* key, const char* what, T otherwise) {
    if (status_.ok()) status_ = hal::Error{what_ + ": \"" + key + "\" " + what};
    return otherwise;
  }
  const Json& json_;
  std::string what_;
  hal::Status status_;
};

/// The lamp of that id that is there.
std::optional<std::size_t> find_light(const Space& space, const std::string& id) {
  const std::vector<LightSource>& lights = space.lights();
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (lights[i].alive && lights[i].id == id) return i;
  }
  return {};
}

hal::Error none(const std::string& what, const std::string& id) {
  return {"there is no " + what + " '" + id + "', or no more"};
}

/// What a command is about: the first of these members that it has.
struct Target {
  std::string kind, id;
};
hal::Result<Target> target_of(const Json& command, std::initializer_list<const char*> kinds) {
  std::string all;
  for (const char* kind : kinds) {
    const auto found = command.find(kind);
    all += (all.empty() ? "\"" : ", \"") + std::string(kind) + "\"";
    if (found == command.end()) continue;
    if (!found->is_string()) return hal::Error{"\"" + std::string(kind) + "\" is an id"};
    return Target{kind, found->get<std::string>()};
  }
  return hal::Error{"it says not what of: it needs " + all + " with an id"};
}

// --- move ---

hal::Status move_robot(Space& space, const std::string& id, Members& members) {
  const RobotId robot = space.find_robot(id);
  if (!robot.valid()) return none("robot", id);
  if (space.external(robot))
    return hal::Error{"robot '" + id + "' is a real one: it stands where it stands, and can only be carried by hand"};
  const Pose pose = members.pose(space.pose(robot));
  if (!members.status().ok()) return members.status();
  if (const hal::Status room = space.room_for(robot, pose); !room.ok()) return room;
  space.set_pose(robot, pose);
  return {};
}

hal::Status move_object(Space& space, const std::string& id, Members& members) {
  const ObjectId object = space.find_object(id);
  if (!object.valid()) return none("object", id);
  Object changed = space.objects()[object.index];
  const Pose pose = members.pose({changed.x_m, changed.y_m, changed.z_low_m, changed.cos_h, changed.sin_h});
  if (!members.status().ok()) return members.status();
  if (const hal::Status room = space.room_for(object, pose); !room.ok()) return room;
  const double height_m = changed.z_high_m - changed.z_low_m;
  changed.x_m = pose.x_m;
  changed.y_m = pose.y_m;
  changed.cos_h = pose.cos_h;
  changed.sin_h = pose.sin_h;
  if (pose.z_m != changed.z_low_m) {
    changed.z_low_m = pose.z_m;
    changed.z_high_m = pose.z_m + height_m;
  }
  return space.set_object(object, changed);
}

hal::Status move_light(Space& space, const std::string& id, Members& members) {
  const auto number = find_light(space, id);
  if (!number) return none("lamp", id);
  LightSource light = space.lights()[*number];
  light.x_m = members.number("x", light.x_m);
  light.y_m = members.number("y", light.y_m);
  light.z_m = members.number("z", light.z_m);
  if (!members.status().ok()) return members.status();
  space.set_light(*number, light);
  return {};
}

hal::Result<Json> move(World& world, Json& command) {
  const auto target = target_of(command, {"robot", "object", "light"});
  if (!target.ok()) return target.error();
  const auto& [kind, id] = target.value();
  Members members(command, "move");
  Space& space = world.space();
  const hal::Status moved = kind == "robot"    ? move_robot(space, id, members)
                            : kind == "object" ? move_object(space, id, members)
                                               : move_light(space, id, members);
  if (!moved.ok()) return moved.error();
  return Json::object();
}

// --- add, remove ---

/// The id that was asked for, or the first of "<stem>1", "<stem>2", … that nobody has or had.
std::string free_id(const Space& space, const std::string& wanted, const std::string& stem) {
  if (!wanted.empty()) return wanted;
  const SpaceStores& s = space.stores();
  for (int i = 1;; ++i) {
    const std::string id = stem + std::to_string(i);
    const auto same = [&](const auto& thing) { return thing.id == id; };
    if (!s.find_entity(id) && !s.object_numbers.contains(id) && std::none_of(s.lights.begin(), s.lights.end(), same) &&
        std::none_of(s.sounds.begin(), s.sounds.end(), same))
      return id;
  }
}

hal::Result<std::string> add_robot(World& world, const Json& json) {
  Members members(json, "add robot");
  NewRobot robot;
  robot.kind = members.text("kind");
  robot.controller = members.text("controller");
  if (robot.controller.empty() && !world.scenario().controllers.empty())
    robot.controller = world.scenario().controllers.front().id;
  robot.pose =
      Pose::at(members.needed("x"), members.needed("y"), members.number("heading", 0.0), members.number("z", 0.0));
  robot.id = free_id(world.space(), members.id("id"), "added");
  if (!members.status().ok()) return members.status().error();
  const auto added = world.space().add_robot(robot);
  if (!added.ok()) return added.error();
  return robot.id;
}

hal::Result<std::string> add_object(World& world, const Json& json) {
  Members members(json, "add object");
  const std::string shape = members.text("shape");
  if (shape != "box" && shape != "cylinder") return hal::Error{"add object: \"shape\" is \"box\" or \"cylinder\""};
  Object object;
  object.kind = shape == "box" ? Object::Kind::Box : Object::Kind::Cylinder;
  const Pose pose =
      Pose::at(members.needed("x"), members.needed("y"), members.number("heading", 0.0), members.number("z", 0.0));
  object.x_m = pose.x_m;
  object.y_m = pose.y_m;
  object.cos_h = pose.cos_h;
  object.sin_h = pose.sin_h;
  object.z_low_m = pose.z_m;
  object.z_high_m = pose.z_m + members.needed("height");
  if (shape == "box") {
    object.half_x_m = 0.5 * members.needed("size_x");
    object.half_y_m = 0.5 * members.needed("size_y");
  } else {
    object.radius_m = members.needed("radius");
  }
  object.movable = members.flag("movable", false);
  object.mass_kg = members.number("mass", 1.0);
  object.id = free_id(world.space(), members.id("id"), "added");
  if (!members.status().ok()) return members.status().error();
  const auto added = world.space().add_object(object);
  if (!added.ok()) return added.error();
  return object.id;
}

hal::Result<std::string> add_light(World& world, const Json& json) {
  Members members(json, "add light");
  LightSource light;
  light.x_m = members.needed("x");
  light.y_m = members.needed("y");
  light.z_m = members.needed("z");
  light.intensity = members.number("intensity", 1.0);
  light.color = members.color("color", light.color);
  light.id = free_id(world.space(), members.id("id"), "added");
  if (!members.status().ok()) return members.status().error();
  if (light.intensity < 0.0) return hal::Error{"add light: \"intensity\" is 0 or more"};
  const auto added = world.space().add_light(light);
  if (!added.ok()) return added.error();
  return light.id;
}

hal::Result<Json> add(World& world, Json& command) {
  for (const char* kind : {"robot", "object", "light"}) {
    const auto found = command.find(kind);
    if (found == command.end()) continue;
    if (!found->is_object()) return hal::Error{"add: \"" + std::string(kind) + "\" is an object that says which"};
    const auto id = kind[0] == 'r'   ? add_robot(world, *found)
                    : kind[0] == 'o' ? add_object(world, *found)
                                     : add_light(world, *found);
    if (!id.ok()) return id.error();
    (*found)["id"] = id.value();
    return Json{{"added", id.value()}};
  }
  return hal::Error{"add: it says not what: it needs \"robot\", \"object\" or \"light\""};
}

hal::Result<Json> remove(World& world, Json& command) {
  const auto target = target_of(command, {"robot", "object", "light"});
  if (!target.ok()) return target.error();
  const auto& [kind, id] = target.value();
  Space& space = world.space();
  if (kind == "robot") {
    const RobotId robot = space.find_robot(id);
    if (!robot.valid()) return none("robot", id);
    if (space.external(robot)) return hal::Error{"robot '" + id + "' is a real one: halt it instead"};
    space.remove_robot(robot);
  } else if (kind == "object") {
    const ObjectId object = space.find_object(id);
    if (!object.valid()) return none("object", id);
    space.remove_object(object);
  } else {
    const auto light = find_light(space, id);
    if (!light) return none("lamp", id);
    space.remove_light(*light);
  }
  return Json::object();
}

// --- lamps, halts, controls ---

hal::Result<Json> set_light(World& world, Json& command) {
  const auto target = target_of(command, {"light"});
  if (!target.ok()) return target.error();
  const auto number = find_light(world.space(), target.value().id);
  if (!number) return none("lamp", target.value().id);
  Members members(command, "light");
  LightSource light = world.space().lights()[*number];
  light.intensity = members.number("intensity", light.intensity);
  light.color = members.color("color", light.color);
  if (!members.status().ok()) return members.status().error();
  if (light.intensity < 0.0) return hal::Error{"light: \"intensity\" is 0 (off) or more"};
  world.space().set_light(*number, light);
  return Json::object();
}

hal::Result<Json> halt(World& world, Json& command, bool halted) {
  const auto target = target_of(command, {"robot"});
  if (!target.ok()) return target.error();
  Space& space = world.space();
  if (target.value().id == "*") {
    for (std::size_t i = 0; i < space.robot_count(); ++i) space.set_halted(space.robot(i), halted, HaltOwner::Operator);
    return Json{{"robots", space.robot_count()}};
  }
  const RobotId robot = space.find_robot(target.value().id);
  if (!robot.valid()) return none("robot", target.value().id);
  space.set_halted(robot, halted, HaltOwner::Operator);
  Json answer{{"robots", 1}};
  if (halted || !space.halted(robot)) return answer;
  if (space.halted_by(robot, HaltOwner::Controller))
    answer["note"] = "its controller failed: it stands until the run is over";
  else if (space.halted_by(robot, HaltOwner::Hook))
    answer["note"] = "a hook holds the robot, too: it stands until that lets go";
  else  // the safety table, which held it because the person did
    answer["note"] = "it drives when its safety table lets it: see its state";
  return answer;
}

hal::Result<Json> use_control(World& world, Json& command, bool press) {
  Members members(command, press ? "press" : "set");
  const std::string owner = members.text("owner");
  const std::string control = members.text("control");
  if (!members.status().ok()) return members.status().error();
  const auto value = command.find("value");
  if (!press && value == command.end()) return hal::Error{"set: \"value\" is missing"};
  const hal::Status done = press ? press_button(world, owner, control) : set_control(world, owner, control, *value);
  if (!done.ok()) return done.error();
  return Json::object();
}

}  // namespace

bool is_touch(std::string_view name) noexcept {
  return std::find(kTouches.begin(), kTouches.end(), name) != kTouches.end();
}

hal::Result<Json> touch(World& world, Json& command) {
  const std::string name = hal::text_of(command, "do");
  if (name == "move") return move(world, command);
  if (name == "add") return add(world, command);
  if (name == "remove") return remove(world, command);
  if (name == "light") return set_light(world, command);
  if (name == "halt" || name == "release") return halt(world, command, name == "halt");
  if (name == "set" || name == "press") return use_control(world, command, name == "press");
  if (name == "reload") return reload(world, command);
  return hal::Error{"there is no action '" + name + "'; there are: " + hal::listed({kTouches.begin(), kTouches.end()})};
}

bool continues(const Json& first, const Json& second) {
  const auto name = second.find("do");
  if (name == second.end() || !first.contains("do") || first["do"] != *name) return false;
  const auto same = [&](const char* key) {
    const auto a = first.find(key);
    const auto b = second.find(key);
    return (a == first.end()) == (b == second.end()) && (a == first.end() || *a == *b);
  };
  const auto has_all = [&](std::initializer_list<const char*> keys) {  // that the first set
    for (const char* key : keys) {
      if (first.contains(key) && !second.contains(key)) return false;
    }
    return true;
  };
  if (*name == "move") return same("robot") && same("object") && same("light") && has_all({"x", "y", "z", "heading"});
  if (*name == "light") return same("light") && has_all({"intensity", "color"});
  return *name == "set" && same("owner") && same("control");
}

}  // namespace tandem::core
