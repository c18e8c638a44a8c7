// The floor as a piece of an SVG document.
#pragma once
#include <string>

#include "core/view/drawing.hpp"

namespace tandem::core {

/// Runs of equal shade, one path a shade; nothing where the floor is uniform.
std::string floor_shades(const Drawing& drawing, const PictureLook& look);

}  // namespace tandem::core
