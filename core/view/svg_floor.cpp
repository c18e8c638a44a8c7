#include "core/view/svg_floor.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/record/floor_image.hpp"
#include "core/view/svg_text.hpp"

namespace tandem::core {
namespace {

/// The squares that a floor is drawn by.
struct FloorGrid {
  FloorGrid(const Drawing& d, const PictureLook& look) {
    const PictureLook::Area arena = d.arena();
    const PictureLook::Area shown = look.region.value_or(arena);
    x_m = std::max(arena.min_x_m, shown.min_x_m);
    y_m = std::max(arena.min_y_m, shown.min_y_m);
    const double width_m = std::min(arena.max_x_m, shown.max_x_m) - x_m;
    const double depth_m = std::min(arena.max_y_m, shown.max_y_m) - y_m;
    const double longer_m = std::max(width_m, depth_m);
    cell_m = longer_m / std::clamp(std::round(longer_m * d.floor_pixels_per_m), 1.0, static_cast<double>(look.size_px));
    columns = std::max(1, static_cast<int>(std::ceil(width_m / cell_m - 1e-9)));
    lines = std::max(1, static_cast<int>(std::ceil(depth_m / cell_m - 1e-9)));
  }
  double middle_x_m(int column) const { return x_m + (column + 0.5) * cell_m; }
  double middle_y_m(int line) const { return y_m + (line + 0.5) * cell_m; }

  double x_m = 0.0, y_m = 0.0, cell_m = 1.0;
  int columns = 1, lines = 1;
};

}  // namespace

std::string floor_picture(const Drawing& drawing, const PictureLook& look) {
  if (!drawing.floor) return {};
  const FloorGrid grid(drawing, look);
  FloorImage image{static_cast<std::size_t>(grid.columns), static_cast<std::size_t>(grid.lines)};
  for (int line = grid.lines - 1; line >= 0; --line) {
    for (int column = 0; column < grid.columns; ++column) {
      const double level = std::clamp(drawing.floor(grid.middle_x_m(column), grid.middle_y_m(line)), 0.0, 1.0);
      image.pixels.push_back(static_cast<std::uint8_t>(std::lround(255.0 * level)));
      if (drawing.floor_color)
        image.colors.push_back(drawing.floor_color(grid.middle_x_m(column), grid.middle_y_m(line)));
    }
  }
  Svg svg;
  svg << "<image class=\"floor\" preserveAspectRatio=\"none\" transform=\"translate(" << grid.x_m << " "
      << grid.y_m + grid.lines * grid.cell_m << ") scale(1 -1)\" width=\"" << grid.columns * grid.cell_m
      << "\" height=\"" << grid.lines * grid.cell_m << "\" href=\"data:image/png;base64," << hal::base64(png_of(image))
      << "\"/>\n";
  return svg.take();
}

void keep_floor(Drawing& drawing, const PictureLook& look) {
  if (!drawing.floor) return;
  const FloorGrid grid(drawing, look);
  struct Kept {
    FloorGrid grid;
    std::vector<float> levels;
    std::vector<hal::Rgb> colors;
    std::size_t cell(double x_m, double y_m) const {
      const auto place = [](double at, int most) { return std::clamp(static_cast<int>(std::floor(at)), 0, most - 1); };
      const int column = place((x_m - grid.x_m) / grid.cell_m, grid.columns);
      const int line = place((y_m - grid.y_m) / grid.cell_m, grid.lines);
      return static_cast<std::size_t>(line * grid.columns + column);
    }
  };
  const auto kept = std::make_shared<Kept>(Kept{grid, {}, {}});
  for (int line = 0; line < grid.lines; ++line) {
    for (int column = 0; column < grid.columns; ++column) {
      const double x_m = grid.middle_x_m(column), y_m = grid.middle_y_m(line);
      kept->levels.push_back(static_cast<float>(drawing.floor(x_m, y_m)));
      if (drawing.floor_color) kept->colors.push_back(drawing.floor_color(x_m, y_m));
    }
  }
  if (drawing.floor_color)
    drawing.floor_color = [kept](double x_m, double y_m) { return kept->colors[kept->cell(x_m, y_m)]; };
  drawing.floor = [kept](double x_m, double y_m) { return static_cast<double>(kept->levels[kept->cell(x_m, y_m)]); };
}

}  // namespace tandem::core
