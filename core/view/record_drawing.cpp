#include "core/view/record_drawing.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <unordered_map>
#include <utility>

#include "hal/device/leds.hpp"
#include "hal/time.hpp"
#include "hal/unit.hpp"

namespace tandem::core {
namespace {

using hal::Json;

// Anybody may have written a record: what is missing or no number is taken for `otherwise`.
double number_or(const Json& json, double otherwise) {
  if (!json.is_number()) return otherwise;
  const auto value = json.get<double>();
  return std::isfinite(value) ? value : otherwise;
}
double number(const Json& json, const char* key, double otherwise = 0.0) {
  const auto found = json.is_object() ? json.find(key) : json.end();
  return json.is_object() && found != json.end() ? number_or(*found, otherwise) : otherwise;
}
double item(const Json& json, std::size_t index) {
  return json.is_array() && index < json.size() ? number_or(json[index], 0.0) : 0.0;
}
std::string text(const Json& json, const char* key, const char* otherwise) {
  const auto found = json.is_object() ? json.find(key) : json.end();
  return json.is_object() && found != json.end() && found->is_string() ? found->get<std::string>() : otherwise;
}
bool is_true(const Json& json, const char* key) {
  const auto found = json.is_object() ? json.find(key) : json.end();
  return json.is_object() && found != json.end() && found->is_boolean() && found->get<bool>();
}
const Json& list(const Json& json, const char* key) {
  static const Json kNone = Json::array();
  const auto found = json.is_object() ? json.find(key) : json.end();
  return json.is_object() && found != json.end() && found->is_array() ? *found : kNone;
}
std::uint8_t channel(const Json& json, std::size_t index) {
  return static_cast<std::uint8_t>(std::clamp(item(json, index), 0.0, 255.0));
}

Drawing::Kind kind_of(std::string name, const Json& body) {
  constexpr double kUnknown_m = 0.05;
  Drawing::Kind kind;
  kind.name = std::move(name);
  kind.radius_m = std::max(1e-3, number(body, "radius", kUnknown_m));
  kind.height_m = number(body, "height");
  kind.rotor_arm_m = number(body, "rotor_arm");
  kind.gripper_reach_m = number(body, "gripper_reach");
  kind.leds_on_turret = is_true(body, "leds_on_turret");
  for (const Json& led : list(body, "leds")) kind.leds.push_back({item(led, 0), item(led, 1), item(led, 2)});
  return kind;
}

std::optional<std::size_t> field_of(const RecordRows& rows, std::string_view name) {
  const std::vector<RecordField>& fields = rows.stream().fields;
  for (std::size_t f = 0; f < fields.size(); ++f) {
    if (fields[f].name == name && !fields[f].used_by) return f;
  }
  return {};
}

/// The fields of a table of poses; nothing where one is missing.
struct PoseFields {
  explicit PoseFields(const RecordRows& rows) {
    const char* const names[] = {"x", "y", "z", "heading"};
    for (std::size_t i = 0; i < 4; ++i) {
      const auto field = field_of(rows, names[i]);
      whole = whole && field && rows.stream().fields[*field].count > 0;
      if (field) at[i] = *field;
    }
  }
  bool whole = true;
  std::size_t at[4] = {};
};

double finite(double value) {
  return std::isfinite(value) ? value : 0.0;
}

/// Where the rows of other members are that have the same ids.
std::unordered_map<std::string_view, std::size_t> rows_by_id(const std::optional<RecordRows>& rows) {
  std::unordered_map<std::string_view, std::size_t> by_id;
  for (std::size_t i = 0; rows && i < rows->size(); ++i) by_id.emplace(rows->members().ids[i], i);
  return by_id;
}

}  // namespace

RecordDrawings::RecordDrawings(RecordReader reader) : reader_(std::move(reader)) {
  const Json& start = reader_.start();
  const auto seed = start.find("seed");
  title_ = text(start, "experiment", "?") + ", seed " +
           (seed != start.end() && seed->is_number_unsigned() ? std::to_string(seed->get<std::uint64_t>()) : "?");
  ticks_per_second_ = std::clamp<std::int64_t>(std::llround(number(start, "ticks_per_second", 10.0)), 1, 1'000'000);
}

hal::Result<RecordDrawings> RecordDrawings::open(const std::string& path) {
  auto reader = RecordReader::open(path);
  if (!reader.ok()) return reader.error();
  RecordDrawings drawings(std::move(reader).value());
  if (!drawings.next()) return hal::Error{"record '" + path + "' holds no poses of robots"};
  return drawings;
}

void RecordDrawings::take_scene(const Json& scene) {
  if (const auto arena = scene.find("arena"); arena != scene.end()) {
    const PictureLook::Area read{number(*arena, "min_x", -1.0), number(*arena, "min_y", -1.0),
                                 number(*arena, "max_x", 1.0), number(*arena, "max_y", 1.0)};
    if (read.min_x_m < read.max_x_m && read.min_y_m < read.max_y_m) arena_ = read;
  }
  scene_ = Drawing();
  scene_.min_x_m = arena_.min_x_m;
  scene_.min_y_m = arena_.min_y_m;
  scene_.max_x_m = arena_.max_x_m;
  scene_.max_y_m = arena_.max_y_m;
  movables_.clear();
  for (const Json& o : list(scene, "objects")) {
    const bool box = text(o, "shape", "box") == "box";
    const bool movable = is_true(o, "movable");
    if (movable) movables_.push_back({text(o, "id", ""), box, box ? scene_.boxes.size() : scene_.cylinders.size()});
    if (box) {
      scene_.boxes.push_back({number(o, "x"), number(o, "y"), number(o, "heading"), 0.5 * number(o, "size_x"),
                              0.5 * number(o, "size_y"), movable, number(o, "z"), number(o, "height")});
    } else {
      scene_.cylinders.push_back(
          {number(o, "x"), number(o, "y"), number(o, "radius"), movable, number(o, "z"), number(o, "height")});
    }
  }
  for (const Json& b : list(scene, "borders")) {
    const bool wall = b.is_array() && b.size() > 4 && b[4].is_boolean() && b[4].get<bool>();
    scene_.borders.push_back({item(b, 0), item(b, 1), item(b, 2), item(b, 3), wall});
  }
  for (const Json& light : list(scene, "lights")) {
    const Json& color = list(light, "color");
    scene_.lights.push_back({number(light, "x"),
                             number(light, "y"),
                             {channel(color, 0), channel(color, 1), channel(color, 2)},
                             number(light, "z")});
  }
}

void RecordDrawings::take(RecordEntry entry) {
  if (entry.type == RecordBlock::Scene) take_scene(entry.json);
  if (!entry.rows) return;
  const RecordStream& stream = entry.rows->stream();
  if (stream.name == "pose" && stream.set == "pose")
    (stream.of == "robot" ? poses_ : objects_) = std::move(entry.rows);
  else if (stream.name == hal::RingLeds::kName && stream.set == "actuator")
    leds_ = std::move(entry.rows);
  else if (stream.name == "turret_encoder" && stream.set == "sensor")
    turrets_ = std::move(entry.rows);
}

// A tick is over when a block of another one comes.
bool RecordDrawings::next() {
  bool found = false;
  for (;;) {
    std::optional<RecordEntry> entry = std::exchange(ahead_, std::nullopt);
    if (!entry) entry = reader_.next();
    if (!entry) return found;
    if (found && entry->tick != tick_) {
      ahead_ = std::move(entry);
      return true;
    }
    const bool poses = entry->rows && entry->rows->stream().title() == "pose" && PoseFields(*entry->rows).whole;
    if (poses) {
      tick_ = entry->tick;
      objects_.reset();
      leds_.reset();
      turrets_.reset();
      found = true;
    } else if (entry->rows && entry->rows->stream().title() == "pose") {
      continue;
    }
    take(std::move(*entry));
  }
}

std::vector<Trails::Place> RecordDrawings::places() const {
  const PoseFields fields(*poses_);
  std::vector<Trails::Place> places(poses_->size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    places[i] = {std::hash<std::string>()(poses_->members().ids[i]), finite(poses_->value(fields.at[0], i)),
                 finite(poses_->value(fields.at[1], i))};
  }
  return places;
}

Drawing RecordDrawings::drawing(const PictureLook& look, const Trails* trails) const {
  Drawing d = scene_;
  const hal::TimeNs time_ns = hal::time_of_tick(ticks_done(), ticks_per_second_);
  d.title = title_ + ", t = " + hal::format_number(hal::to_seconds(time_ns)) + " s";

  const RecordMembers& members = poses_->members();
  const PoseFields fields(*poses_);
  std::vector<std::optional<std::uint32_t>> kinds;  // by the record's
  const auto leds_at = rows_by_id(leds_), turrets_at = rows_by_id(turrets_);
  const auto rgb = leds_ ? field_of(*leds_, "rgb") : std::nullopt;
  const auto angle = turrets_ ? field_of(*turrets_, "angle") : std::nullopt;
  for (std::size_t i = 0; i < poses_->size(); ++i) {
    const std::size_t kind = members.kind[i];
    if (kinds.size() <= kind) kinds.resize(kind + 1);
    if (!kinds[kind]) {
      kinds[kind] = static_cast<std::uint32_t>(d.kinds.size());
      d.kinds.push_back(kind_of(members.kinds[i], kind < members.bodies.size() ? members.bodies[kind] : Json()));
    }
    Drawing::Robot robot;
    robot.x_m = finite(poses_->value(fields.at[0], i));
    robot.y_m = finite(poses_->value(fields.at[1], i));
    robot.z_m = finite(poses_->value(fields.at[2], i));
    robot.heading_rad = finite(poses_->value(fields.at[3], i));
    robot.kind = *kinds[kind];
    robot.first_light = static_cast<std::uint32_t>(d.lit.size());
    if (const auto row = leds_at.find(members.ids[i]); rgb && row != leds_at.end()) {
      const std::size_t mounted = std::min(d.kinds[robot.kind].leds.size(), leds_->stream().fields[*rgb].count / 3);
      for (std::uint32_t led = 0; led < mounted; ++led) {
        const auto part = [&](std::size_t c) {
          return static_cast<std::uint8_t>(std::clamp(leds_->value(*rgb, row->second, 3 * led + c), 0.0, 255.0));
        };
        const hal::Rgb color{part(0), part(1), part(2)};
        if (color == hal::kBlack) continue;
        d.lit.push_back({led, color});
        ++robot.lights;
      }
    }
    if (const auto row = turrets_at.find(members.ids[i]); angle && row != turrets_at.end())
      robot.turret_rad = finite(turrets_->value(*angle, row->second));
    d.robots.push_back(robot);
    if (look.ids) d.ids.push_back(members.ids[i]);
    if (members.real[i]) d.real.push_back({i, members.ids[i], ""});
  }

  const auto objects_at = rows_by_id(objects_);
  for (const Thing& thing : movables_) {
    const auto row = objects_at.find(thing.id);
    if (row == objects_at.end()) continue;
    const PoseFields f(*objects_);
    if (!f.whole) break;
    const auto value = [&](std::size_t field) { return finite(objects_->value(f.at[field], row->second)); };
    if (thing.box) {
      Drawing::Box& box = d.boxes[thing.index];
      box.x_m = value(0);
      box.y_m = value(1);
      box.z_m = value(2);
      box.heading_rad = value(3);
    } else {
      Drawing::Cylinder& cylinder = d.cylinders[thing.index];
      cylinder.x_m = value(0);
      cylinder.y_m = value(1);
      cylinder.z_m = value(2);
    }
  }
  if (trails != nullptr) {
    std::vector<std::uint64_t> who;
    for (const Trails::Place& place : places()) who.push_back(place.who);
    trails->add_to(d, who, ticks_done());
  }
  return d;
}

}  // namespace tandem::core
