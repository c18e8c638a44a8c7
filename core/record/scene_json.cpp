#include "core/record/scene_json.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <numeric>
#include <string_view>
#include <utility>

#include "core/space/attitude.hpp"
#include "hal/json/json_access.hpp"
#include "hal/robot/former_parts.hpp"

namespace tandem::core {
namespace {

using hal::Json;

Json object_json(const SpaceStores& s, const Object& o) {
  Json json = {{"id", o.id},           {"shape", o.kind == Object::Kind::Box ? "box" : "cylinder"},
               {"movable", o.movable}, {"x", o.x_m},
               {"y", o.y_m},           {"heading", std::atan2(o.sin_h, o.cos_h)},
               {"z", o.z_low_m},       {"height", o.z_high_m - o.z_low_m}};
  if (o.kind == Object::Kind::Box) {
    json["size_x"] = 2.0 * o.half_x_m;
    json["size_y"] = 2.0 * o.half_y_m;
  } else {
    json["radius"] = o.radius_m;
  }
  if (const auto& q = turn_of(s, o); leans(q)) json["q_WB"] = q;
  for (const ObjectLed& led : o.leds)
    json["leds"].push_back({led.x_m, led.y_m, led.z_m, led.color.r, led.color.g, led.color.b});
  return json;
}

/// A fingerprint of what is added, in its order.
class Mark {
 public:
  void add(std::uint64_t value) noexcept {
    mark_ = (mark_ ^ value) * 0x9E3779B97F4A7C15ULL;
    mark_ ^= mark_ >> 32;
  }
  void add(double value) noexcept { add(std::bit_cast<std::uint64_t>(value)); }
  void add(std::string_view text) noexcept {
    add(std::uint64_t{text.size()});
    for (const char c : text) add(std::uint64_t{static_cast<unsigned char>(c)});
  }
  std::uint64_t mark() const noexcept { return mark_; }

 private:
  std::uint64_t mark_ = 1;
};

}  // namespace

Json scene_json(const SpaceStores& s) {
  Json scene = {{"arena", {{"min_x", s.min_x_m}, {"min_y", s.min_y_m}, {"max_x", s.max_x_m}, {"max_y", s.max_y_m}}},
                {"objects", Json::array()},
                {"lights", Json::array()},
                {"borders", Json::array()}};
  for (const Object& o : s.objects) {
    if (o.alive) scene["objects"].push_back(object_json(s, o));
  }
  for (const Region& region : s.regions) {
    for (std::size_t i = 0; i < region.sides.size(); ++i) {
      const RegionSide& a = region.sides[i];
      const RegionSide& b = region.sides[(i + 1) % region.sides.size()];
      scene["borders"].push_back({a.x_m, a.y_m, b.x_m, b.y_m, a.wall});
    }
  }
  for (const LightSource& light : s.lights) {
    if (!light.alive) continue;
    scene["lights"].push_back({{"id", light.id},
                               {"x", light.x_m},
                               {"y", light.y_m},
                               {"z", light.z_m},
                               {"intensity", light.intensity},
                               {"color", {light.color.r, light.color.g, light.color.b}}});
  }
  return scene;
}

namespace {

using hal::flag_of;
using hal::item_of;
using hal::list_of;
using hal::number_of;

hal::Rgb color_of(const Json& json, std::size_t at = 0) {
  const auto channel = [&](std::size_t i) {
    return static_cast<std::uint8_t>(std::clamp(item_of(json, at + i), 0.0, 255.0));
  };
  return {channel(0), channel(1), channel(2)};
}

Object object_of(const Json& json) {
  Object o;
  o.id = hal::text_of(json, "id");
  o.kind = hal::text_of(json, "shape", "box") == "box" ? Object::Kind::Box : Object::Kind::Cylinder;
  o.movable = flag_of(json, "movable");
  o.x_m = number_of(json, "x");
  o.y_m = number_of(json, "y");
  o.cos_h = std::cos(number_of(json, "heading"));
  o.sin_h = std::sin(number_of(json, "heading"));
  o.z_low_m = number_of(json, "z");
  o.z_high_m = o.z_low_m + number_of(json, "height");
  o.half_x_m = 0.5 * number_of(json, "size_x");
  o.half_y_m = 0.5 * number_of(json, "size_y");
  o.radius_m = number_of(json, "radius");
  for (const Json& led : list_of(json, "leds"))
    o.leds.push_back({item_of(led, 0), item_of(led, 1), item_of(led, 2), color_of(led, 3)});
  return o;
}

/// Sides of one region follow each other, each where the one before ends, until they are back where they began.
std::vector<Region> regions_of(const Json& borders) {
  std::vector<Region> regions(1);
  RegionSide end;  // of the last side
  for (const Json& b : borders) {
    const RegionSide side{item_of(b, 0), item_of(b, 1), b.is_array() && b.size() > 4 && b[4] == Json(true)};
    const auto at = [](const RegionSide& p, const RegionSide& q) { return p.x_m == q.x_m && p.y_m == q.y_m; };
    const std::vector<RegionSide>& sides = regions.back().sides;
    if (!sides.empty() && (at(end, sides.front()) || !at(end, side))) regions.emplace_back();
    regions.back().sides.push_back(side);
    end = {item_of(b, 2), item_of(b, 3)};
  }
  return regions;
}

}  // namespace

void read_scene(const Json& scene, SpaceStores& s) {
  const Json& arena = hal::object_of(scene, "arena");
  const std::array<double, 4> sides = {number_of(arena, "min_x", -1.0), number_of(arena, "min_y", -1.0),
                                       number_of(arena, "max_x", 1.0), number_of(arena, "max_y", 1.0)};
  if (sides[0] < sides[2] && sides[1] < sides[3]) {
    s.min_x_m = sides[0];
    s.min_y_m = sides[1];
    s.max_x_m = sides[2];
    s.max_y_m = sides[3];
  }
  for (const Json& json : list_of(scene, "objects")) {
    s.objects.push_back(object_of(json));
    s.object_numbers[s.objects.back().id] = static_cast<std::uint32_t>(s.objects.size() - 1);
    s.object_region.push_back(kNoRegion);
    Motion& motion = s.object_motion.emplace_back();
    const Json& q = list_of(json, "q_WB");
    for (std::size_t k = 0; k < motion.q_WB.size(); ++k) motion.q_WB[k] = item_of(q, k, motion.q_WB[k]);
  }
  for (const Json& json : list_of(scene, "lights")) {
    const auto color = color_of(list_of(json, "color"));
    s.lights.push_back({hal::text_of(json, "id"), number_of(json, "x"), number_of(json, "y"), number_of(json, "z"),
                        number_of(json, "intensity", 1.0), color});
  }
  s.regions = regions_of(list_of(scene, "borders"));
  s.regions.front().listed = true;
}

SceneVersion scene_version(const SpaceStores& s) noexcept {
  Mark movables, lights;
  for (const Object& o : s.objects) {
    if (o.movable) movables.add((std::uint64_t{o.version} << 1) | (o.alive ? 1U : 0U));
  }
  movables.add(std::uint64_t{s.objects.size()});
  for (const LightSource& light : s.lights) {
    for (const double value : {light.x_m, light.y_m, light.z_m, light.intensity}) lights.add(value);
    lights.add((std::uint64_t{light.color.r} << 24) | (std::uint64_t{light.color.g} << 16) |
               (std::uint64_t{light.color.b} << 8) | (light.alive ? 1U : 0U));
  }
  return {s.immovables_version, s.object_leds_version, movables.mark(), lights.mark()};
}

namespace {

Json driver_json(const hal::Driver& driver) {
  Json json = {{"row", driver.row}, {"field", driver.field}, {"index", driver.index}};
  if (driver.as_switch) json["off"] = driver.off;
  return json;
}

hal::Driver driver_of(const Json& json) {
  return {hal::text_of(json, "row"), hal::text_of(json, "field"), static_cast<std::int64_t>(number_of(json, "index")),
          hal::member_of(json, "off") != nullptr, number_of(json, "off")};
}

hal::Appearance::Point point_of(const Json& json, const char* key, hal::Appearance::Point otherwise = {}) {
  const Json& said = list_of(json, key);
  for (std::size_t i = 0; i < otherwise.size(); ++i) otherwise[i] = item_of(said, i, otherwise[i]);
  return otherwise;
}

std::string color_text(const Json& json) {
  const std::string color = hal::text_of(json, "color");
  return hal::is_color(color) ? color : std::string();
}

Json look_json(const hal::Appearance& look) {
  Json json = {{"joints", Json::array()}, {"links", Json::array()}, {"lamps", Json::array()}};
  const auto add = [&json](const char* list, Json one, const std::string& on, const std::string& color) {
    if (!on.empty()) one["on"] = on;
    if (!color.empty()) one["color"] = color;
    json[list].push_back(std::move(one));
  };
  for (const hal::Appearance::Joint& j : look.joints) {
    add("joints",
        {{"name", j.name},
         {"slides", j.slides},
         {"at", j.at_m},
         {"axis", j.axis},
         {"by", driver_json(j.by)},
         {"scale", j.scale}},
        j.on, {});
  }
  for (const hal::Appearance::Link& l : look.links) {
    Json one = {{"name", l.name}, {"shape", l.shape}, {"low", l.low_m}, {"high", l.high_m}};
    if (!l.held.row.empty()) one["held"] = driver_json(l.held);
    if (l.turned_rad != 0.0) one["turned"] = l.turned_rad;
    if (l.fine) one["fine"] = true;
    add("links", std::move(one), l.on, l.color);
  }
  for (const hal::Appearance::Lamp& l : look.lamps)
    add("lamps", {{"at", l.at_m}, {"by", driver_json(l.by)}}, l.on, l.color);
  if (!look.upper.empty()) json["upper"] = look.upper;
  if (look.whole) json["whole"] = true;
  return json;
}

hal::LookPart look_of(const Json& json) {
  static constexpr std::size_t kMost = 256;  // of each; a damaged record may say anything
  hal::LookPart look;
  const auto each = [&json](const char* list, const auto& take) {
    const Json& all = list_of(json, list);
    for (std::size_t i = 0; i < std::min(kMost, all.size()); ++i)
      take(all[i], hal::text_of(all[i], "on"), driver_of(hal::object_of(all[i], "by")));
  };
  each("joints", [&look](const Json& one, const std::string& on, const hal::Driver& by) {
    look.joints.push_back({hal::text_of(one, "name"), flag_of(one, "slides"), point_of(one, "at"),
                           point_of(one, "axis", {0.0, 0.0, 1.0}), by, number_of(one, "scale", 1.0), on});
  });
  each("links", [&look](const Json& one, const std::string& on, const hal::Driver&) {
    look.links.push_back({hal::text_of(one, "name"), hal::text_of(one, "shape"), point_of(one, "low"),
                          point_of(one, "high"), on, color_text(one), driver_of(hal::object_of(one, "held")),
                          number_of(one, "turned"), flag_of(one, "fine")});
  });
  each("lamps", [&look](const Json& one, const std::string& on, const hal::Driver& by) {
    look.lamps.push_back({point_of(one, "at"), on, by, color_text(one)});
  });
  look.upper = hal::text_of(json, "upper");
  look.whole = flag_of(json, "whole");
  return look;
}

}  // namespace

Json body_json(const hal::RobotKind& kind) {
  Json body = {
      {"radius", kind.body.radius_m}, {"height", kind.body.height_m}, {"look", look_json(hal::appearance_of(kind))}};
  if (const auto* const rotors = kind.flight(); rotors != nullptr) body["rotor_arm"] = rotors->rotor_arm_m;
  return body;
}

hal::RobotKind kind_of_body(std::string name, const Json& body) {
  constexpr double kUnknown_m = 0.05;
  hal::RobotKind kind;
  kind.name = std::move(name);
  kind.body.radius_m = std::max(1e-3, number_of(body, "radius", kUnknown_m));
  kind.body.height_m = number_of(body, "height", kUnknown_m);
  if (const double arm_m = number_of(body, "rotor_arm"); arm_m > 0.0)
    kind.locomotion = hal::Quadrotor{.rotor_arm_m = arm_m};
  if (const Json* const look = hal::member_of(body, "look"); look != nullptr) {
    kind.add(look_of(*look));
    return kind;
  }
  std::vector<hal::Mount> leds;
  for (const Json& led : list_of(body, "leds"))
    leds.push_back({0.0, item_of(led, 0), item_of(led, 1), item_of(led, 2)});
  const auto said = [&body](const char* key) { return flag_of(body, key) ? 1.0 : number_of(body, key); };
  hal::add_former_parts(kind, said, std::move(leds));
  return kind;
}

bool looks_alike(const hal::RobotKind& a, const hal::RobotKind& b) {
  const auto arm_m = [](const hal::RobotKind& kind) { return kind.flies() ? kind.flight()->rotor_arm_m : 0.0; };
  return a.body.radius_m == b.body.radius_m && a.body.height_m == b.body.height_m && arm_m(a) == arm_m(b) &&
         hal::appearance_of(a) == hal::appearance_of(b);
}

std::vector<std::uint32_t> living_rows(const SpaceStores& s) {
  std::vector<std::uint32_t> rows;
  rows.reserve(s.living.size());
  for (std::size_t row = 0; row < s.bodies.size(); ++row) {
    if ((s.bodies.flags[row] & kAlive) != 0) rows.push_back(static_cast<std::uint32_t>(row));
  }
  return rows;
}

bool came_earlier(const SpaceStores& s, std::uint32_t a, std::uint32_t b) noexcept {
  const std::uint32_t first = s.bodies.entity[a], second = s.bodies.entity[b];
  return std::pair(s.robots[first].generation, first) < std::pair(s.robots[second].generation, second);
}

Json members_json(const Space& space, std::span<const std::uint32_t> rows, KindBodies& made) {
  const SpaceStores& s = space.stores();
  Json ids = Json::array(), kinds = Json::array(), kind = Json::array(), real = Json::array(), bodies = Json::array();
  std::map<const hal::RobotKind*, std::size_t> known;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::uint32_t entity = s.bodies.entity[rows[i]];
    ids.push_back(space.robot_name({entity, s.robots[entity].generation}));
    const hal::RobotKind& its = s.kind_of_row(rows[i]);
    const auto [entry, fresh] = known.emplace(&its, 0);
    if (fresh) {  // some robots have a kind of their own that looks like the others'
      const auto [known_body, new_body] = made.try_emplace(&its);
      if (new_body) known_body->second = body_json(its);
      const Json& body = known_body->second;
      std::size_t& number = entry->second;
      while (number < kinds.size() && !(kinds[number] == Json(its.name) && bodies[number] == body)) ++number;
      if (number == kinds.size()) {
        kinds.push_back(its.name);
        bodies.push_back(body);
      }
    }
    kind.push_back(entry->second);
    if ((s.bodies.flags[rows[i]] & kExternal) != 0) real.push_back(i);
  }
  Json members = {{"ids", std::move(ids)},
                  {"kinds", std::move(kinds)},
                  {"kind", std::move(kind)},
                  {"real", std::move(real)},
                  {"bodies", std::move(bodies)}};
  std::vector<std::size_t> order(rows.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto earlier = [&](std::size_t a, std::size_t b) { return came_earlier(s, rows[a], rows[b]); };
  if (!std::is_sorted(order.begin(), order.end(), earlier)) {
    std::sort(order.begin(), order.end(), earlier);
    members["order"] = order;
  }
  return members;
}

namespace {

constexpr std::array<const char*, 4> kShapes = {"line", "polygon", "circle", "text"};

}  // namespace

Json sketch_json(const Sketch& sketch) {
  Json shapes = Json::array();
  for (const Sketch::Shape& shape : sketch.shapes()) {
    Json json = {{"kind", kShapes[static_cast<std::size_t>(shape.kind)]},
                 {"color", {shape.pen.color.r, shape.pen.color.g, shape.pen.color.b}},
                 {"width", shape.pen.width_m},
                 {"filled", shape.pen.filled},
                 {"opacity", shape.pen.opacity}};
    for (const Sketch::Point& p : shape.points) json["points"].push_back({p.x_m, p.y_m, p.z_m});
    if (shape.kind == Sketch::Shape::Kind::Circle) json["radius"] = shape.radius_m;
    if (shape.kind == Sketch::Shape::Kind::Text) json["text"] = shape.text;
    shapes.push_back(std::move(json));
  }
  return {{"shapes", std::move(shapes)}};
}

Sketch sketch_of_json(const Json& json) {
  Sketch sketch;
  for (const Json& shape : list_of(json, "shapes")) {
    std::vector<Sketch::Point> points;
    for (const Json& p : list_of(shape, "points")) points.push_back({item_of(p, 0), item_of(p, 1), item_of(p, 2)});
    if (points.empty()) continue;
    const std::string kind = hal::text_of(shape, "kind");
    const Sketch::Pen pen{color_of(list_of(shape, "color")), number_of(shape, "width"), flag_of(shape, "filled"),
                          number_of(shape, "opacity", 1.0)};
    if (kind == kShapes[0]) sketch.path(points, pen);
    if (kind == kShapes[1]) sketch.polygon(points, pen);
    if (kind == kShapes[2]) sketch.circle(points[0], number_of(shape, "radius"), pen);
    const Json* const text = hal::member_of(shape, "text");
    if (kind == kShapes[3] && text != nullptr && text->is_string())
      sketch.text(points[0], hal::text_of(shape, "text"), pen);
  }
  return sketch;
}

std::uint64_t sketch_mark(const Sketch& sketch) noexcept {
  Mark mark;
  for (const Sketch::Shape& shape : sketch.shapes()) {
    const Sketch::Pen& pen = shape.pen;
    mark.add((std::uint64_t{shape.points.size()} << 32) | (static_cast<std::uint64_t>(shape.kind) << 25) |
             (std::uint64_t{pen.filled} << 24) | (std::uint64_t{pen.color.r} << 16) |
             (std::uint64_t{pen.color.g} << 8) | pen.color.b);
    for (const Sketch::Point& p : shape.points) {
      for (const double value : {p.x_m, p.y_m, p.z_m}) mark.add(value);
    }
    for (const double value : {shape.radius_m, pen.width_m, pen.opacity}) mark.add(value);
    mark.add(std::string_view(shape.text));
  }
  return mark.mark();
}

hal::Json areas_json(const SafetyConfig& safety) {
  hal::Json all = hal::Json::array();
  for (const auto& [kind, areas] : {std::pair{"fence", &safety.fences}, std::pair{"keep_out", &safety.keep_outs},
                                    std::pair{"zone", &safety.zones}}) {
    for (const SafetyArea& area : *areas) {
      hal::Json json = {
          {"kind", kind}, {"id", area.id}, {"from", area.from_m}, {"to", area.to_m}, {"corners", hal::Json::array()}};
      for (const Point2& p : area.corners) json["corners"].push_back({p[0], p[1]});
      if (area.max_speed_m_s > 0.0) json["max_speed"] = area.max_speed_m_s;
      all.push_back(std::move(json));
    }
  }
  return all;
}

SafetyConfig areas_of_json(const hal::Json& areas) {
  SafetyConfig safety;
  if (!areas.is_array()) return safety;
  for (const hal::Json& a : areas) {
    SafetyArea area{
        hal::text_of(a, "id"), {}, hal::number_of(a, "from"), hal::number_of(a, "to"), hal::number_of(a, "max_speed")};
    for (const hal::Json& corner : hal::list_of(a, "corners"))
      area.corners.push_back({hal::item_of(corner, 0), hal::item_of(corner, 1)});
    const std::string kind = hal::text_of(a, "kind");
    auto& list = kind == "fence" ? safety.fences : kind == "keep_out" ? safety.keep_outs : safety.zones;
    if (area.corners.size() > 2) list.push_back(std::move(area));
  }
  return safety;
}

}  // namespace tandem::core
