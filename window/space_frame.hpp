// Frames of a space: copied by the thread that steps, a few nanoseconds a robot.
#pragma once
#include <chrono>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/record/scene_json.hpp"
#include "core/space/looks.hpp"
#include "core/space/space.hpp"
#include "core/view/layers/layer_set.hpp"
#include "hal/time.hpp"
#include "window/frame.hpp"

namespace tandem::window {

class SpaceFrames {
 public:
  /// A floor that changes all the time is copied twice a second, unless frames are `settled`.
  static constexpr std::chrono::milliseconds kFloorEvery{500};

  /// Fills `frame`, which is empty, with the space as it is after `done` ticks. Layers are left to `add_layers`.
  /// @param settled nothing moves: this frame may stay for long
  void fill(const core::Space& space, hal::Tick done, std::int64_t ticks_per_second, bool settled, Frame& frame);

 private:
  void plan(const core::Space& space);
  void look_at_scene(const core::SpaceStores& stores, bool settled);

  bool planned_ = false;
  std::uint32_t generations_ = 0;
  std::size_t living_ = 0, objects_ = 0;
  std::shared_ptr<const FrameMembers> members_;
  // By member; they stay where they are until members change.
  std::vector<std::uint32_t> rows_;
  bool in_order_ = false;  // rows_[i] == i
  std::vector<std::uint32_t> member_of_row_;
  std::vector<core::LampRun> lamps_;  // numbered among those of all members
  std::vector<core::DrivenValue> values_;
  std::unique_ptr<core::Looks> looks_;

  core::SceneVersion scene_version_;
  std::uint64_t floor_mark_ = 0;
  std::chrono::steady_clock::time_point floor_copied_;
  std::shared_ptr<const FrameScene> scene_;
  std::vector<std::uint32_t> movables_, movable_places_;  // numbers of objects, and where the scene has them
  std::uint32_t members_count_ = 0, scenes_count_ = 0;
};

/// What the layers show goes into `frame`; the messages "panel" of those that have one are returned. Those that were
/// on in `before`, and are not any more, are shown empty; `before` is brought up to date.
std::vector<hal::Json> add_layers(core::LayerSet& layers, const core::Observation& now,
                                  std::vector<std::size_t>& before, Frame& frame);

}  // namespace tandem::window
