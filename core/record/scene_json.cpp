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
#include "hal/device/gripper.hpp"
#include "hal/device/leds.hpp"
#include "hal/json/json_access.hpp"

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

Json body_json(const hal::RobotKind& kind) {
  Json body = {{"radius", kind.body.radius_m}, {"height", kind.body.height_m}};
  if (const auto* const rotors = std::get_if<hal::Quadrotor>(&kind.locomotion)) body["rotor_arm"] = rotors->rotor_arm_m;
  if (const auto* const gripper = kind.part<hal::GripperPart>(); gripper != nullptr)
    body["gripper_reach"] = gripper->reach_m;
  if (const auto* const leds = kind.part<hal::LedsPart>(); leds != nullptr) {
    body["leds_on_turret"] = leds->on_turret;
    for (const hal::Mount& led : leds->mounts) body["leds"].push_back({led.x_m, led.y_m, led.z_m});
  }
  return body;
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

Json members_json(const Space& space, std::span<const std::uint32_t> rows) {
  const SpaceStores& s = space.stores();
  Json ids = Json::array(), kinds = Json::array(), kind = Json::array(), real = Json::array(), bodies = Json::array();
  std::map<std::string_view, std::size_t> known;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::uint32_t entity = s.bodies.entity[rows[i]];
    ids.push_back(space.robot_name({entity, s.robots[entity].generation}));
    const hal::RobotKind& its = s.kind_of_row(rows[i]);
    const auto [entry, fresh] = known.emplace(its.name, known.size());
    if (fresh) {
      kinds.push_back(its.name);
      bodies.push_back(body_json(its));
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
  for (const Json& shape : hal::list_of(json, "shapes")) {
    std::vector<Sketch::Point> points;
    for (const Json& p : hal::list_of(shape, "points"))
      points.push_back({hal::item_of(p, 0), hal::item_of(p, 1), hal::item_of(p, 2)});
    if (points.empty()) continue;
    const Json& color = hal::list_of(shape, "color");
    const auto channel = [&color](std::size_t i) {
      return static_cast<std::uint8_t>(std::clamp(hal::item_of(color, i), 0.0, 255.0));
    };
    const Sketch::Pen pen{{channel(0), channel(1), channel(2)},
                          hal::number_of(shape, "width"),
                          hal::flag_of(shape, "filled"),
                          hal::number_of(shape, "opacity", 1.0)};
    const std::string kind = hal::text_of(shape, "kind");
    const Json* const text = hal::member_of(shape, "text");
    if (kind == kShapes[0]) sketch.path(points, pen);
    if (kind == kShapes[1]) sketch.polygon(points, pen);
    if (kind == kShapes[2]) sketch.circle(points[0], hal::number_of(shape, "radius"), pen);
    if (kind == kShapes[3] && text != nullptr && text->is_string())
      sketch.text(points[0], text->get<std::string>(), pen);
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

}  // namespace tandem::core
