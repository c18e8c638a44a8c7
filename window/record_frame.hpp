// Frames of a record.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "core/record/record_moments.hpp"
#include "window/frame.hpp"

namespace tandem::window {

class RecordFrames {
 public:
  /// The number of the layer that shows what hooks drew.
  static constexpr std::uint32_t kDrawings = 0;

  /// Fills `frame`, which is empty, with where `moments` stands. What hooks drew is in it where it differs from the
  /// frame before, or `drawings` asks for it. Damage in the record shows as what is missing.
  void fill(const core::RecordMoments& moments, bool drawings, Frame& frame);

 private:
  /// Rows of a stream by member; looked up again when either has other members.
  struct Lookup {
    const core::RecordMembers* members = nullptr;
    const core::RecordMembers* of = nullptr;
    std::vector<std::size_t> row;  // kNone: it has none
  };
  const std::vector<std::size_t>& rows_of(Lookup& lookup, const core::RecordRows& rows);
  void plan(const core::RecordMembers& members, const core::RecordRows* leds);
  void look_at_scene(const core::RecordMoments& moments);

  const core::RecordMembers* planned_ = nullptr;
  bool had_leds_ = false;
  std::shared_ptr<const FrameMembers> members_;
  std::uint32_t members_count_ = 0, scenes_count_ = 0;
  Lookup leds_, turrets_, grippers_, halts_, attitudes_;
  std::shared_ptr<const FrameScene> scene_;
  std::uint64_t scene_number_ = 0, floor_number_ = 0, sketch_number_ = 0;
  std::unordered_map<std::string, std::uint32_t> movables_;  // places in the scene by id
};

}  // namespace tandem::window
