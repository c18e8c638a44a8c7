// Draws figures with gnuplot, a program of its own that needs to be there only when something is drawn.
#pragma once
#include <string>

#include "app/bench/figure.hpp"
#include "hal/result.hpp"

namespace tandem::app {

enum class PictureKind { Svg, Png };

/// By the file's ending; an error names the endings that there are.
hal::Result<PictureKind> picture_kind(const std::string& path);

/// Whether a figure can be drawn to `path`, found out before hours of measuring. An error says which package to
/// install, or what is wrong with the folder.
hal::Status can_draw(const std::string& path);

/// The script that writes the figure to gnuplot's standard output.
std::string gnuplot_script(const Figure& figure, PictureKind kind);

/// Writes the whole file or none of it; one that is there is replaced. An error quotes gnuplot.
hal::Status draw(const Figure& figure, const std::string& path);

}  // namespace tandem::app
