// Drawings as straight segments, for viewers in space.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/space/sketch.hpp"

namespace tandem::core {

/// From one point of W to another, in metres. Its bytes are those of the protocol to viewers on little-endian machines.
struct Segment {
  float x1 = 0.0F, y1 = 0.0F, z1 = 0.0F;
  float x2 = 0.0F, y2 = 0.0F, z2 = 0.0F;
  std::uint8_t r = 0, g = 0, b = 0, a = 255;
};
static_assert(sizeof(Segment) == 28);

/// Texts left out. Circles become polygons, no corner of which is missing more than 1 % of the radius; fillings are not
/// shown.
std::vector<Segment> segments_of(const Sketch& sketch);

struct PlacedText {
  Sketch::Point at;
  std::string text;
  hal::Rgb color;
};

/// The texts alone.
std::vector<PlacedText> texts_of(const Sketch& sketch);

}  // namespace tandem::core
