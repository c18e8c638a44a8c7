// Figures by gnuplot, a program of its own that needs to be there only when something is drawn.
#pragma once
#include <string>

#include "hal/output_file.hpp"
#include "hal/result.hpp"

namespace tandem::core {

enum class FigureFormat { Svg, Png, Pdf };

/// By the file's ending; an error names the endings that there are.
hal::Result<FigureFormat> figure_format(const std::string& path);

/// Whether a figure can be drawn, found out before hours of measuring. An error says which package to install.
hal::Status can_draw_figures();

/// Draws what the script says into `file`, and commits it. The script sets its terminal; neither the user's settings
/// nor a shell take part. An error quotes gnuplot.
hal::Status draw_figure(const std::string& script, hal::OutputFile& file);

/// In single quotes, as gnuplot reads it: what could end the text or the line is left out.
std::string gnuplot_text(const std::string& text);

}  // namespace tandem::core
