// Robots as pieces of an SVG document.
#pragma once
#include <string>

#include "core/view/drawing.hpp"
#include "core/view/svg_text.hpp"

namespace tandem::core {

inline constexpr std::string_view kTroubleColor = "#c92a2a";

/// A disc whose wedge points forward, at the origin; a plain dark one where the wedge would be too small to see.
std::string robot_symbol(std::size_t kind, double radius, double radius_px);
/// The same for the legend of pictures that show dots.
std::string dot_symbol(std::size_t kind);
/// A robot in its place, with what is to be seen of its kind: "#kind0" stands for its symbol.
std::string robot_body(const Drawing& drawing, const Drawing::Robot& robot);
/// All of them as dots.
std::string robot_dots(const Drawing& drawing);
/// A cross.
std::string halted_mark(double radius);

}  // namespace tandem::core
