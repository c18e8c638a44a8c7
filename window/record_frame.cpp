#include "window/record_frame.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/record/floor_image.hpp"
#include "core/record/scene_json.hpp"
#include "core/space/mechanisms.hpp"
#include "core/view/layers/segments.hpp"
#include "hal/finite.hpp"
#include "hal/json/json_access.hpp"

namespace tandem::window {
namespace {

using core::RecordMembers;
using core::RecordRows;
using hal::Json;

constexpr std::size_t kNone = static_cast<std::size_t>(-1);

const RecordRows* either(const RecordRows* one, const RecordRows* other) {
  return one != nullptr ? one : other;
}
const RecordRows* leds_in(const core::RecordMoments& moments) {
  return either(moments.rows("actuator leds"), moments.rows("look leds"));
}

/// One field of rows, 0 where there is none.
class Values {
 public:
  Values(const RecordRows* rows, std::string_view field) : rows_(rows) {
    if (rows != nullptr) field_ = core::field_of(*rows, field);
  }
  explicit operator bool() const { return field_.has_value(); }
  std::size_t count(std::size_t row) const { return field_ && row < rows_->size() ? rows_->used(*field_, row) : 0; }
  double at(std::size_t row, std::size_t index = 0) const {
    return index < count(row) ? hal::finite_or(rows_->value(*field_, row, index), 0.0) : 0.0;
  }

 private:
  const RecordRows* rows_;
  std::optional<std::size_t> field_;
};

std::size_t leds_of_kind(const Json& bodies, std::size_t kind) {
  return bodies.is_array() && kind < bodies.size() ? hal::list_of(bodies[kind], "leds").size() : 0;
}

}  // namespace

const std::vector<std::size_t>& RecordFrames::rows_of(Lookup& lookup, const RecordRows& rows) {
  if (lookup.members == planned_ && lookup.of == &rows.members()) return lookup.row;
  lookup = {planned_, &rows.members(), {}};
  std::unordered_map<std::string_view, std::size_t> by_id;
  for (std::size_t i = 0; i < rows.members().ids.size(); ++i) by_id.emplace(rows.members().ids[i], i);
  lookup.row.reserve(planned_->ids.size());
  for (const std::string& id : planned_->ids) {
    const auto found = by_id.find(id);
    lookup.row.push_back(found == by_id.end() ? kNone : found->second);
  }
  return lookup.row;
}

void RecordFrames::plan(const RecordMembers& from, const RecordRows* leds) {
  planned_ = &from;
  had_leds_ = leds != nullptr;
  auto members = std::make_shared<FrameMembers>();
  members->number = ++members_count_;
  Json kinds = Json::array(), real = Json::array();
  for (std::size_t i = 0; i < from.ids.size(); ++i) {
    while (kinds.size() <= from.kind[i]) kinds.push_back("");
    kinds[from.kind[i]] = from.kinds[i];
    if (from.real[i]) real.push_back(i);
  }
  Json bodies = Json::array();
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    const bool known = from.bodies.is_array() && k < from.bodies.size() && from.bodies[k].is_object();
    bodies.push_back(known ? from.bodies[k] : Json{{"radius", 0.05}, {"height", 0.05}});
  }
  members->json = {{"ids", from.ids}, {"kinds", kinds}, {"kind", from.kind}, {"real", real}, {"bodies", bodies}};
  members->first_led = {0};
  const Values rgb(leds, "rgb");
  for (std::size_t i = 0; i < from.ids.size(); ++i) {
    const std::size_t row = leds != nullptr ? rows_of(leds_, *leds)[i] : kNone;
    const std::size_t count = std::min(leds_of_kind(bodies, from.kind[i]), rgb.count(row) / 3);
    members->first_led.push_back(members->first_led.back() + static_cast<std::uint32_t>(count));
  }
  members_ = std::move(members);
}

void RecordFrames::look_at_scene(const core::RecordMoments& moments) {
  if (scene_ != nullptr && scene_number_ == moments.scene_number() && floor_number_ == moments.floor_number()) return;
  auto scene = std::make_shared<FrameScene>();
  scene->number = ++scenes_count_;
  scene->json = moments.scene().is_object() ? moments.scene() : Json::object();
  const bool same_floor = scene_ != nullptr && floor_number_ == moments.floor_number();
  if (same_floor) {
    scene->floor = scene_->floor;
  } else if (!moments.floor_png().empty()) {
    if (auto floor = core::floor_of_png(moments.floor_png()); floor.ok())
      scene->floor = std::make_shared<const core::FloorImage>(std::move(floor).value());
  }
  scene_number_ = moments.scene_number();
  floor_number_ = moments.floor_number();
  movables_.clear();
  std::uint32_t number = 0;
  for (const Json& object : hal::list_of(scene->json, "objects")) {
    if (const Json* const id = hal::member_of(object, "id"); id != nullptr && id->is_string())
      movables_[id->get<std::string>()] = number;
    ++number;
  }
  scene_ = std::move(scene);
}

void RecordFrames::fill(const core::RecordMoments& moments, bool drawings, Frame& frame) {
  const RecordRows& poses = moments.poses();
  const RecordRows* const leds = leds_in(moments);
  if (planned_ != &poses.members() || had_leds_ != (leds != nullptr)) plan(poses.members(), leds);
  look_at_scene(moments);
  const std::size_t count = poses.size();
  frame.tick = moments.tick() + 1;
  frame.time_s = static_cast<double>(frame.tick) / static_cast<double>(moments.ticks_per_second());
  frame.scene = scene_;
  frame.members = members_;

  const Values x(&poses, "x"), y(&poses, "y"), z(&poses, "z"), heading(&poses, "heading");
  frame.z_m.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    frame.x_m.push_back(x.at(i));
    frame.y_m.push_back(y.at(i));
    frame.z_m[i] = static_cast<float>(z.at(i));
    frame.cos_h.push_back(std::cos(heading.at(i)));
    frame.sin_h.push_back(std::sin(heading.at(i)));
  }
  if (const RecordRows* const rows = moments.rows("attitude")) {
    const Values q(rows, "q_WB");
    const std::vector<std::size_t>& row = rows_of(attitudes_, *rows);
    frame.q_WB.assign(count, {1.0F, 0.0F, 0.0F, 0.0F});
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t k = 0; k < 4 && q.count(row[i]) == 4; ++k)
        frame.q_WB[i][k] = static_cast<float>(q.at(row[i], k));
    }
  }
  if (const RecordRows* const rows = either(moments.rows("look turret"), moments.rows("sensor turret_encoder"))) {
    const Values angle(rows, "angle");
    const std::vector<std::size_t>& row = rows_of(turrets_, *rows);
    if (members_->turrets.empty()) {  // known from here on
      auto with_turrets = std::make_shared<FrameMembers>(*members_);
      with_turrets->turrets.assign(count, 0);
      for (std::size_t i = 0; i < count; ++i) with_turrets->turrets[i] = row[i] != kNone ? 1 : 0;
      frame.members = members_ = std::move(with_turrets);
    }
    frame.turret_rad.resize(count);
    for (std::size_t i = 0; i < count; ++i) frame.turret_rad[i] = static_cast<float>(angle.at(row[i]));
  }
  if (leds != nullptr) {
    const Values rgb(leds, "rgb");
    const std::vector<std::size_t>& row = rows_of(leds_, *leds);
    const std::vector<std::uint32_t>& first = members_->first_led;
    frame.leds.resize(first.back());
    for (std::size_t i = 0; i < count; ++i) {
      for (std::uint32_t led = first[i]; led < first[i + 1]; ++led) {
        const auto part = [&](std::size_t c) {
          return static_cast<std::uint8_t>(std::clamp(rgb.at(row[i], 3 * std::size_t{led - first[i]} + c), 0.0, 255.0));
        };
        frame.leds[led] = {part(0), part(1), part(2)};
      }
    }
  }
  if (const RecordRows* const rows = moments.rows("look halted")) {
    const Values by(rows, "by");
    const std::vector<std::size_t>& row = rows_of(halts_, *rows);
    for (std::uint32_t i = 0; i < count; ++i) {
      if (by.at(row[i]) != 0.0) frame.halted.push_back(i);
    }
  }
  if (const RecordRows* const rows = moments.rows("look gripper")) {
    const Values joint(rows, "joint");
    const std::vector<std::size_t>& row = rows_of(grippers_, *rows);
    for (std::uint32_t i = 0; i < count; ++i) {
      if (joint.count(row[i]) > 0 && joint.at(row[i]) != static_cast<double>(core::GripState::kNothing))
        frame.holding.push_back(i);
    }
  }
  if (const RecordRows* const rows = moments.rows("object pose")) {
    const Values ox(rows, "x"), oy(rows, "y"), oz(rows, "z"), oh(rows, "heading");
    for (std::size_t i = 0; i < rows->size(); ++i) {
      const auto place = movables_.find(rows->members().ids[i]);
      if (place != movables_.end()) frame.objects.push_back({place->second, ox.at(i), oy.at(i), oz.at(i), oh.at(i)});
    }
  }
  if (drawings || sketch_number_ != moments.sketch_number()) {
    sketch_number_ = moments.sketch_number();
    const core::Sketch sketch = core::sketch_of_json(moments.sketch());
    frame.layers.push_back({kDrawings, core::segments_of(sketch), texts_json(sketch)});
  }
}

}  // namespace tandem::window
