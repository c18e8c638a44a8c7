// Figures by gnuplot, a program of its own that needs to be there only when something is drawn.
#pragma once
#include <cstddef>
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

/// The size of a figure, and its letters, in points of an SVG: 96 an inch. A PNG has two pixels a point.
struct FigurePage {
  double width = 640.0, height = 480.0;
  const char* font = "Arial";
  double font_size = 15.0;
};
/// The line of a script that sets the terminal for such a page, on white.
std::string gnuplot_terminal(FigureFormat format, const FigurePage& page);
/// Sizes of letters in PNGs and PDFs are of 1/72 inch.
inline constexpr double kFontPoint = 0.75;

/// Colours that people with any colour vision tell apart [Okabe and Ito 2008], and gnuplot's numbers of shapes for
/// print without colours, over and over.
const char* figure_colour(std::size_t number) noexcept;
int figure_shape(std::size_t number) noexcept;

/// In single quotes, as gnuplot reads it: what could end the text or the line is left out.
std::string gnuplot_text(const std::string& text);

}  // namespace tandem::core
