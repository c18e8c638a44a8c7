#include "window/space_frame.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/record/floor_image.hpp"
#include "core/space/stores.hpp"
#include "core/view/layers/segments.hpp"

namespace tandem::window {

using core::SpaceStores;
using hal::Json;

void SpaceFrames::plan(const core::Space& space) {
  const SpaceStores& s = space.stores();
  generations_ = s.generations;
  living_ = s.living.size();
  planned_ = true;

  rows_ = core::living_rows(s);
  in_order_ = rows_.size() == s.bodies.size();
  member_of_row_.assign(s.bodies.size(), 0);
  auto members = std::make_shared<FrameMembers>();
  members->number = members_count_ + 1;
  core::KindBodies bodies;
  members->json = core::members_json(space, rows_, bodies);
  members->first_led = members->first_value = {0};
  looks_ = std::make_unique<core::Looks>(space);
  lamps_.clear();
  values_.clear();
  for (std::uint32_t i = 0; i < rows_.size(); ++i) {
    member_of_row_[rows_[i]] = i;
    const std::uint32_t entity = s.bodies.entity[rows_[i]];
    const core::RobotId robot{entity, s.robots[entity].generation};
    const std::size_t before = lamps_.size();
    looks_->add_lamps(robot, lamps_);
    const std::uint32_t first = members->first_led.back();
    for (std::size_t run = before; run < lamps_.size(); ++run) lamps_[run].first += first;
    const std::size_t count = lamps_.size() > before ? looks_->appearance(robot).lamps.size() : 0;
    members->first_led.push_back(first + static_cast<std::uint32_t>(count));
    looks_->add_values(robot, values_);
    members->first_value.push_back(static_cast<std::uint32_t>(values_.size()));
  }
  // Who came back to where they were before are no others.
  const bool same = members_ != nullptr && members_->first_led == members->first_led &&
                    members_->first_value == members->first_value && members_->json == members->json;
  if (same) return;
  ++members_count_;
  members_ = std::move(members);
}

void SpaceFrames::look_at_scene(const SpaceStores& s, bool settled) {
  const core::SceneVersion version = core::scene_version(s);
  const std::uint64_t mark = core::floor_mark(s);
  const auto now = std::chrono::steady_clock::now();
  const bool other_floor = mark != floor_mark_ && (settled || scene_ == nullptr || now - floor_copied_ >= kFloorEvery);
  const bool same = scene_ != nullptr && version == scene_version_ && s.objects.size() == objects_;
  if (same && !other_floor) return;
  auto scene = std::make_shared<FrameScene>();
  scene->number = ++scenes_count_;
  scene->json = same ? scene_->json : core::scene_json(s);
  if (scene_ != nullptr) scene->floor = scene_->floor;
  if (other_floor) {
    scene->floor = mark != 0 ? std::make_shared<const core::FloorImage>(core::floor_image(s)) : nullptr;
    floor_mark_ = mark;
    floor_copied_ = now;
  }
  scene_version_ = version;
  objects_ = s.objects.size();
  movables_.clear();
  movable_places_.clear();
  for (std::uint32_t number = 0, place = 0; number < s.objects.size(); ++number) {
    if (!s.objects[number].alive) continue;
    if (s.objects[number].movable) {
      movables_.push_back(number);
      movable_places_.push_back(place);
    }
    ++place;
  }
  scene_ = std::move(scene);
}

void SpaceFrames::fill(const core::Space& space, hal::Tick done, std::int64_t ticks_per_second, bool settled,
                       Frame& frame) {
  const SpaceStores& s = space.stores();
  if (!planned_ || s.generations != generations_ || s.living.size() != living_) plan(space);
  look_at_scene(s, settled);
  frame.tick = done;
  frame.time_s = static_cast<double>(done) / static_cast<double>(ticks_per_second);
  frame.scene = scene_;
  frame.members = members_;

  const core::Bodies& b = s.bodies;
  const std::size_t count = rows_.size();
  const auto gather = [&](const core::LargeVector<double>& from, std::vector<double>& to) {
    if (in_order_) {
      to.assign(from.begin(), from.begin() + static_cast<std::ptrdiff_t>(count));
    } else {
      to.resize(count);
      for (std::size_t i = 0; i < count; ++i) to[i] = from[rows_[i]];
    }
  };
  gather(b.x_m, frame.x_m);
  gather(b.y_m, frame.y_m);
  gather(b.cos_h, frame.cos_h);
  gather(b.sin_h, frame.sin_h);
  if (!b.motion.empty()) {
    frame.z_m.resize(count);
    frame.q_WB.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      const core::Motion& motion = b.motion[rows_[i]];
      frame.z_m[i] = static_cast<float>(motion.z_m);
      for (std::size_t k = 0; k < 4; ++k) frame.q_WB[i][k] = static_cast<float>(motion.q_WB[k]);
    }
  }
  frame.leds.assign(members_->first_led.back(), hal::kBlack);
  for (const core::LampRun& run : lamps_) run.read(frame.leds.data());
  frame.values.resize(values_.size());
  for (std::size_t i = 0; i < values_.size(); ++i) frame.values[i] = static_cast<float>(values_[i].value());
  for (const core::RobotBlock& block : s.blocks) {
    for (std::size_t slot = 0; slot < block.used; ++slot) {
      if (block.halted[slot] == 0) continue;
      const std::size_t row = block.first_row + slot;
      if ((b.flags[row] & core::kAlive) != 0) frame.halted.push_back(member_of_row_[row]);
    }
  }
  frame.objects.resize(movables_.size());
  for (std::size_t i = 0; i < movables_.size(); ++i) {
    const core::Object& o = s.objects[movables_[i]];
    frame.objects[i] = {movable_places_[i], o.x_m, o.y_m, o.z_low_m, std::atan2(o.sin_h, o.cos_h)};
  }
}

std::vector<Json> add_layers(core::LayerSet& layers, const core::Observation& now, std::vector<std::size_t>& before,
                             Frame& frame) {
  std::vector<Json> panels;
  std::vector<std::size_t> drawn;
  if (layers.any_on()) {
    for (core::LayerPicture& picture : layers.show(now)) {
      frame.layers.push_back(
          {static_cast<std::uint32_t>(picture.layer), core::segments_of(picture.sketch), texts_json(picture.sketch)});
      drawn.push_back(picture.layer);
      if (!picture.panel) continue;
      const std::string_view name = layers.types()[picture.layer]->name;
      Json rows = Json::array();
      for (const core::Panel::Row& row : picture.panel->rows())
        rows.push_back({{"label", row.label}, {"value", row.value}, {"unit", row.unit}});
      panels.push_back({{"type", "panel"},
                        {"layer", name},
                        {"tick", frame.tick},
                        {"title", picture.panel->title().empty() ? std::string(name) : picture.panel->title()},
                        {"rows", std::move(rows)}});
    }
  }
  for (const std::size_t index : before) {
    if (std::find(drawn.begin(), drawn.end(), index) == drawn.end())
      frame.layers.push_back({static_cast<std::uint32_t>(index), {}, {}});
  }
  before = std::move(drawn);
  return panels;
}

}  // namespace tandem::window
