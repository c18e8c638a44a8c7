#include "core/view/gnuplot.hpp"

#include <filesystem>
#include <iterator>

#include "hal/program.hpp"
#include "hal/unit.hpp"

namespace tandem::core {
namespace {

namespace fs = std::filesystem;

/// Runs gnuplot without the user's settings. @returns what it drew
hal::Result<std::string> run_gnuplot(const std::string& script) {
  const std::string program = hal::find_program("gnuplot");
  if (program.empty())
    return hal::Error{"figures are drawn by gnuplot, which is not installed: sudo apt-get install gnuplot-nox"};
  auto end = hal::run_program(program, {"-d"}, script);
  if (!end.ok()) return end.error();
  if (end->code != 0) return hal::Error{"gnuplot gave up" + (end->errors.empty() ? std::string() : ": " + end->errors)};
  return std::move(end).value().output;
}

}  // namespace

hal::Result<FigureFormat> figure_format(const std::string& path) {
  const std::string ending = fs::path(path).extension();
  if (ending == ".svg") return FigureFormat::Svg;
  if (ending == ".png") return FigureFormat::Png;
  if (ending == ".pdf") return FigureFormat::Pdf;
  return hal::Error{"'" + path + "' must end in .svg, .png or .pdf"};
}

hal::Status can_draw_figures() {
  const auto drawn = run_gnuplot("exit\n");
  return drawn.ok() ? hal::Status{} : drawn.error();
}

hal::Status draw_figure(const std::string& script, hal::OutputFile& file) {
  auto picture = run_gnuplot(script);
  if (!picture.ok()) return picture.error();
  const hal::Status written = file.write(*picture);
  return written.ok() ? file.commit() : written;
}

std::string gnuplot_terminal(FigureFormat format, const FigurePage& page) {
  constexpr double kPngScale = 2.0, kPointsPerInch = 96.0;
  const auto size = [&](double scale, const char* unit) {
    return " size " + hal::format_number(page.width * scale) + unit + "," + hal::format_number(page.height * scale) +
           unit;
  };
  const auto rest = [&](double point, const char* more) {
    return std::string(" enhanced font '") + page.font + "," + hal::format_number(page.font_size * point) + "'" + more +
           " background '#ffffff'\n";
  };
  if (format == FigureFormat::Svg) return "set terminal svg" + size(1.0, "") + rest(1.0, "");
  if (format == FigureFormat::Pdf)
    return "set terminal pdfcairo" + size(1.0 / kPointsPerInch, "in") + rest(kFontPoint, "");
  return "set terminal pngcairo" + size(kPngScale, "") + rest(kFontPoint, " fontscale 2 linewidth 2 pointscale 2");
}

const char* figure_colour(std::size_t number) noexcept {
  static constexpr const char* kAll[] = {"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"};
  return kAll[number % std::size(kAll)];
}

int figure_shape(std::size_t number) noexcept {
  static constexpr int kAll[] = {7, 5, 9, 13, 11, 6, 4, 8, 12, 10};
  return kAll[number % std::size(kAll)];
}

std::string gnuplot_text(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' || c == '`' || static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  return out + "'";
}

}  // namespace tandem::core
