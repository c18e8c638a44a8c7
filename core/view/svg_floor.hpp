// The floor as a piece of an SVG document.
#pragma once
#include <string>

#include "core/view/drawing.hpp"

namespace tandem::core {

/// An image, as fine as the floor or the page, whichever is coarser; nothing where the floor is uniform.
std::string floor_picture(const Drawing& drawing, const PictureLook& look);

}  // namespace tandem::core
