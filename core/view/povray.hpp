// Scenes for POV-Ray: a drawing in perspective, with bodies, lit LEDs, lamps and shadows.
#pragma once
#include <string>

#include "core/view/drawing.hpp"
#include "hal/result.hpp"

namespace tandem::core {

/// `drawing` as a scene of POV-Ray 3.7, seen from the south and above; of `look`, the region and the size count.
std::string to_povray(const Drawing& drawing, const PictureLook& look = {});

/// Renders a scene that lies in the file `scene` as `png`, `width_px` × 3/4 of that. Error: povray is not installed, or
/// gives up; with its words.
hal::Status render_povray(const std::string& scene, const std::string& png, int width_px);

/// Whether povray is there. Error: how to install it.
hal::Status can_render_povray();

}  // namespace tandem::core
