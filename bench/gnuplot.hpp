// Draws figures with gnuplot, a program of its own that needs to be there only when something is drawn.
#pragma once
#include <string>

#include "bench/figure.hpp"
#include "hal/output_file.hpp"
#include "hal/result.hpp"

namespace tandem::bench {

enum class PictureKind { Svg, Png };

/// By the file's ending; an error names the endings that there are.
hal::Result<PictureKind> picture_kind(const std::string& path);

/// Whether a figure can be drawn, found out before hours of measuring. An error says which package to install.
hal::Status can_draw();

/// The script that writes the figure to gnuplot's standard output.
std::string gnuplot_script(const Figure& figure, PictureKind kind);

/// Draws into `file`, by its ending, and commits it. An error quotes gnuplot.
hal::Status draw(const Figure& figure, hal::OutputFile& file);

}  // namespace tandem::bench
