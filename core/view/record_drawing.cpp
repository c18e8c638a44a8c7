#include "core/view/record_drawing.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <unordered_map>
#include <utility>

#include "core/record/floor_image.hpp"
#include "core/record/scene_json.hpp"
#include "core/space/mechanisms.hpp"
#include "hal/device/leds.hpp"
#include "hal/finite.hpp"
#include "hal/json/json_access.hpp"
#include "hal/time.hpp"
#include "hal/unit.hpp"

namespace tandem::core {
namespace {

using hal::flag_of;
using hal::item_of;
using hal::Json;
using hal::list_of;
using hal::number_of;
using hal::text_of;

std::uint8_t channel(const Json& json, std::size_t index) {
  return static_cast<std::uint8_t>(std::clamp(item_of(json, index), 0.0, 255.0));
}

Drawing::Kind kind_of(std::string name, const Json& body) {
  constexpr double kUnknown_m = 0.05;
  Drawing::Kind kind;
  kind.name = std::move(name);
  kind.radius_m = std::max(1e-3, number_of(body, "radius", kUnknown_m));
  kind.height_m = number_of(body, "height");
  kind.rotor_arm_m = number_of(body, "rotor_arm");
  kind.gripper_reach_m = number_of(body, "gripper_reach");
  kind.leds_on_turret = flag_of(body, "leds_on_turret");
  for (const Json& led : list_of(body, "leds"))
    kind.leds.push_back({item_of(led, 0), item_of(led, 1), item_of(led, 2)});
  return kind;
}

/// One field of a table, by the robots' ids; of tables that are not there, nothing.
class ById {
 public:
  ById(const RecordRows* rows, const char* field) : rows_(rows) {
    if (rows == nullptr) return;
    field_ = field_of(*rows, field);
    for (std::size_t i = 0; field_ && i < rows->size(); ++i) by_id_.emplace(rows->members().ids[i], i);
  }
  /// How many values a robot has; 0: it is not in the table.
  std::size_t count(const std::string& id) const {
    return by_id_.contains(id) ? rows_->stream().fields[*field_].count : 0;
  }
  double value(const std::string& id, std::size_t index = 0) const {
    const auto row = by_id_.find(id);
    return row == by_id_.end() ? 0.0 : hal::finite_or(rows_->value(*field_, row->second, index), 0.0);
  }

 private:
  const RecordRows* rows_;
  std::optional<std::size_t> field_;
  std::unordered_map<std::string_view, std::size_t> by_id_;
};

const RecordRows* either(const RecordRows* first, const RecordRows* second) {
  return first != nullptr ? first : second;
}

/// Values of a row of poses.
struct Place {
  Place(const RecordRows& rows, std::size_t row) {
    double* const values[] = {&x_m, &y_m, &z_m, &heading_rad};
    const char* const names[] = {"x", "y", "z", "heading"};
    for (std::size_t i = 0; i < 4; ++i) *values[i] = hal::finite_or(rows.value(*field_of(rows, names[i]), row), 0.0);
  }
  double x_m = 0.0, y_m = 0.0, z_m = 0.0, heading_rad = 0.0;
};

}  // namespace

std::vector<Drawing::Area> areas_of_json(const Json& areas) {
  std::vector<Drawing::Area> all;
  if (!areas.is_array()) return all;
  for (const Json& a : areas) {
    Drawing::Area area;
    const std::string kind = text_of(a, "kind");
    area.kind = kind == "fence"      ? Drawing::Area::Kind::Fence
                : kind == "keep_out" ? Drawing::Area::Kind::KeepOut
                                     : Drawing::Area::Kind::Zone;
    area.id = text_of(a, "id");
    area.from_m = number_of(a, "from");
    area.to_m = number_of(a, "to");
    area.max_speed_m_s = number_of(a, "max_speed");
    for (const Json& corner : list_of(a, "corners")) area.corners.push_back({item_of(corner, 0), item_of(corner, 1)});
    if (area.corners.size() > 2) all.push_back(std::move(area));
  }
  return all;
}

Json to_json(const std::vector<Drawing::Area>& areas) {
  Json all = Json::array();
  for (const Drawing::Area& area : areas) {
    const char* const kind = area.kind == Drawing::Area::Kind::Fence     ? "fence"
                             : area.kind == Drawing::Area::Kind::KeepOut ? "keep_out"
                                                                         : "zone";
    Json json = {{"kind", kind}, {"id", area.id}, {"from", area.from_m}, {"to", area.to_m}, {"corners", Json::array()}};
    for (const Drawing::Point& p : area.corners) json["corners"].push_back({p.x_m, p.y_m});
    if (area.max_speed_m_s > 0.0) json["max_speed"] = area.max_speed_m_s;
    all.push_back(std::move(json));
  }
  return all;
}

RecordDrawings::RecordDrawings(RecordMoments moments) : moments_(std::move(moments)) {
  const Json& start = moments_.start();
  const Json* const seed = hal::member_of(start, "seed");
  title_ = text_of(start, "experiment", "?") + ", seed " +
           (seed != nullptr && seed->is_number_unsigned() ? std::to_string(seed->get<std::uint64_t>()) : "?");
}

hal::Result<RecordDrawings> RecordDrawings::open(const std::string& path) {
  auto moments = RecordMoments::open(path);
  if (!moments.ok()) return moments.error();
  return RecordDrawings(std::move(moments).value());
}

const PictureLook::Area& RecordDrawings::arena() {
  take_scene();
  return arena_;
}

/// Brings all but the robots up to date.
void RecordDrawings::take_scene() {
  if (scene_number_ == moments_.scene_number() && floor_number_ == moments_.floor_number()) return;
  scene_number_ = moments_.scene_number();
  floor_number_ = moments_.floor_number();
  const Json& scene = moments_.scene();
  if (const auto arena = scene.find("arena"); arena != scene.end()) {
    const PictureLook::Area read{number_of(*arena, "min_x", -1.0), number_of(*arena, "min_y", -1.0),
                                 number_of(*arena, "max_x", 1.0), number_of(*arena, "max_y", 1.0)};
    if (read.min_x_m < read.max_x_m && read.min_y_m < read.max_y_m) arena_ = read;
  }
  scene_ = Drawing();
  scene_.min_x_m = arena_.min_x_m;
  scene_.min_y_m = arena_.min_y_m;
  scene_.max_x_m = arena_.max_x_m;
  scene_.max_y_m = arena_.max_y_m;
  movables_.clear();
  for (const Json& o : list_of(scene, "objects")) {
    const bool box = text_of(o, "shape", "box") == "box";
    const bool movable = flag_of(o, "movable");
    if (movable) movables_.push_back({text_of(o, "id"), box, box ? scene_.boxes.size() : scene_.cylinders.size()});
    if (box) {
      scene_.boxes.push_back({number_of(o, "x"), number_of(o, "y"), number_of(o, "heading"),
                              0.5 * number_of(o, "size_x"), 0.5 * number_of(o, "size_y"), movable, number_of(o, "z"),
                              number_of(o, "height")});
    } else {
      scene_.cylinders.push_back({number_of(o, "x"), number_of(o, "y"), number_of(o, "radius"), movable,
                                  number_of(o, "z"), number_of(o, "height")});
    }
  }
  for (const Json& b : list_of(scene, "borders")) {
    const bool wall = b.is_array() && b.size() > 4 && b[4].is_boolean() && b[4].get<bool>();
    scene_.borders.push_back({item_of(b, 0), item_of(b, 1), item_of(b, 2), item_of(b, 3), wall});
  }
  scene_.areas = areas_of_json(list_of(moments_.start(), "areas"));
  for (const Json& light : list_of(scene, "lights")) {
    const Json& color = list_of(light, "color");
    scene_.lights.push_back({number_of(light, "x"),
                             number_of(light, "y"),
                             {channel(color, 0), channel(color, 1), channel(color, 2)},
                             number_of(light, "z")});
  }
  if (moments_.floor_png().empty()) return;
  auto read = floor_of_png(moments_.floor_png());
  if (!read.ok()) return;
  scene_.floor_mark = floor_number_;
  scene_.floor = [area = arena_, image = std::make_shared<const FloorImage>(std::move(read).value())](double x_m,
                                                                                                      double y_m) {
    return image->at((x_m - area.min_x_m) / (area.max_x_m - area.min_x_m),
                     (y_m - area.min_y_m) / (area.max_y_m - area.min_y_m));
  };
}

std::vector<Trails::Place> RecordDrawings::places() const {
  const RecordRows& poses = moments_.poses();
  std::vector<Trails::Place> places;
  places.reserve(poses.size());
  for (const std::size_t row : poses.members().order) {
    const Place place(poses, row);
    places.push_back({std::hash<std::string>()(poses.members().ids[row]), place.x_m, place.y_m});
  }
  return places;
}

Drawing RecordDrawings::drawing(const PictureLook& look, const Trails* trails) {
  take_scene();
  Drawing d = scene_;
  const hal::TimeNs time_ns = hal::time_of_tick(ticks_done(), ticks_per_second());
  d.title = title_ + ", t = " + hal::format_number(hal::to_seconds(time_ns)) + " s";

  const RecordRows& poses = moments_.poses();
  const RecordMembers& members = poses.members();
  std::vector<std::optional<std::uint32_t>> kinds;  // by the record's
  const ById leds(either(moments_.rows("actuator leds"), moments_.rows("look leds")), "rgb");
  const ById turrets(either(moments_.rows("look turret"), moments_.rows("sensor turret_encoder")), "angle");
  const ById grippers(moments_.rows("look gripper"), "joint"), halts(moments_.rows("look halted"), "by");
  for (const std::size_t i : members.order) {
    const std::string& id = members.ids[i];
    const std::size_t kind = members.kind[i];
    if (kinds.size() <= kind) kinds.resize(kind + 1);
    if (!kinds[kind]) {
      kinds[kind] = static_cast<std::uint32_t>(d.kinds.size());
      d.kinds.push_back(kind_of(members.kinds[i], kind < members.bodies.size() ? members.bodies[kind] : Json()));
    }
    const Place place(poses, i);
    Drawing::Robot robot;
    robot.x_m = place.x_m;
    robot.y_m = place.y_m;
    robot.z_m = place.z_m;
    robot.heading_rad = place.heading_rad;
    robot.kind = *kinds[kind];
    robot.first_light = static_cast<std::uint32_t>(d.lit.size());
    robot.turret_rad = turrets.value(id);
    robot.halted = halts.value(id) != 0.0;
    robot.holding = grippers.count(id) > 0 && grippers.value(id) != static_cast<double>(GripState::kNothing);
    const std::size_t mounted = std::min(d.kinds[robot.kind].leds.size(), leds.count(id) / 3);
    for (std::uint32_t led = 0; led < mounted; ++led) {
      const auto part = [&](std::size_t c) {
        return static_cast<std::uint8_t>(std::clamp(leds.value(id, 3 * led + c), 0.0, 255.0));
      };
      const hal::Rgb color{part(0), part(1), part(2)};
      if (color == hal::kBlack) continue;
      d.lit.push_back({led, color});
      ++robot.lights;
    }
    if (members.real[i]) d.real.push_back({d.robots.size(), id, ""});
    d.robots.push_back(robot);
    if (look.ids) d.ids.push_back(id);
  }

  if (const RecordRows* const objects = moments_.rows("object pose")) {
    std::unordered_map<std::string_view, std::size_t> at;
    for (std::size_t i = 0; i < objects->size(); ++i) at.emplace(objects->members().ids[i], i);
    for (const Thing& thing : movables_) {
      const auto row = at.find(thing.id);
      if (row == at.end()) continue;
      const Place place(*objects, row->second);
      if (thing.box) {
        Drawing::Box& box = d.boxes[thing.index];
        box.x_m = place.x_m;
        box.y_m = place.y_m;
        box.z_m = place.z_m;
        box.heading_rad = place.heading_rad;
      } else {
        Drawing::Cylinder& cylinder = d.cylinders[thing.index];
        cylinder.x_m = place.x_m;
        cylinder.y_m = place.y_m;
        cylinder.z_m = place.z_m;
      }
    }
  }
  d.shapes = sketch_of_json(moments_.sketch()).shapes();
  if (trails != nullptr) {
    std::vector<std::uint64_t> who;
    for (const Trails::Place& place : places()) who.push_back(place.who);
    trails->add_to(d, who, ticks_done());
  }
  return d;
}

}  // namespace tandem::core
