// The legend of pictures.
#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/view/drawing.hpp"

namespace tandem::core {

inline constexpr std::string_view kRealColor = "#e8590c";
inline constexpr std::string_view kWallColor = "#59626e";
inline constexpr std::string_view kMovableColor = "#d8b384";
inline constexpr std::string_view kBorderColor = "#3b5bdb";
inline constexpr double kInTheAir_m = 0.02;  ///< robots above that fly

/// One entry: a symbol of at most 18 px around its place, and a text.
struct LegendEntry {
  std::string symbol;
  std::string text;
};

/// Of the things in the picture: kinds, real and halted robots, lit LEDs, heights, paths, lamps, objects, borders.
std::vector<LegendEntry> legend_of(const Drawing& drawing, const PictureLook& look, bool full_detail,
                                   const std::function<bool(const Drawing::Robot&)>& shows);

/// Of a robot in the air, to the centimetre.
std::string height_text(double z_m);

bool any_objects(const Drawing& drawing, bool movable);

}  // namespace tandem::core
