// One moment of a run or a record as plain data, for the viewers of a window.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/record/floor_image.hpp"
#include "core/view/layers/segments.hpp"
#include "hal/json/json.hpp"
#include "hal/rgb.hpp"
#include "hal/time.hpp"

namespace tandem::window {

/// Whose rows the arrays of a frame are, in their order.
struct FrameMembers {
  std::uint32_t number = 0;                ///< no two have the same
  hal::Json json;                          ///< the message "members" but for its type and number
  std::vector<std::uint32_t> first_led;    ///< by member, into Frame::leds; one more at the end
  std::vector<std::uint32_t> first_value;  ///< the same into Frame::values

  std::size_t size() const noexcept { return first_led.empty() ? 0 : first_led.size() - 1; }
};

/// What engines do not move.
struct FrameScene {
  std::uint32_t number = 0;                       ///< no two have the same
  hal::Json json;                                 ///< the message "scene" but for its type and its floor
  std::shared_ptr<const core::FloorImage> floor;  ///< null: a uniform one
};

struct FrameLayer {
  std::uint32_t index = 0;              ///< in the message "hello"
  std::vector<core::Segment> segments;  ///< replace those that were shown
  hal::Json texts;                      ///< of the message "texts": [{x, y, z, text, color}, …]; null: none
};

/// The texts of a drawing, for FrameLayer::texts.
hal::Json texts_json(const core::Sketch& sketch);

struct FrameObject {
  std::uint32_t number = 0;  ///< index into the scene's objects
  double x_m = 0.0, y_m = 0.0, z_m = 0.0, heading_rad = 0.0;
};

/// Lengths in m, in W. Arrays of members hold a value for each, or are empty where not needed.
struct Frame {
  hal::Tick tick = 0;  ///< ticks that were done
  double time_s = 0.0;
  std::shared_ptr<const FrameScene> scene;
  std::shared_ptr<const FrameMembers> members;
  std::vector<double> x_m, y_m, cos_h, sin_h;
  std::vector<float> z_m;                  ///< of their bases above the ground
  std::vector<std::array<float, 4>> q_WB;  ///< w, x, y, z, of members that lean
  std::vector<hal::Rgb> leds;              ///< by FrameMembers::first_led
  std::vector<float> values;               ///< by FrameMembers::first_value: what moves on them
  std::vector<std::uint32_t> halted;       ///< indices of members
  std::vector<FrameObject> objects;        ///< the movable ones
  std::vector<FrameLayer> layers;          ///< those that were drawn again

  /// Empty, with its memory kept.
  void clear() noexcept;
};

}  // namespace tandem::window
