#include "core/space/region_map.hpp"

#include <algorithm>
#include <cmath>

namespace tandem::core {
namespace {

constexpr double kCell_m = 0.25;
constexpr double kMostCells = 1e6;
constexpr double kHalfDiagonal = 0.7072;  // of a cell, in its sides; rounded up

/// From (x, y) to the nearest side, whether it lies inside or outside.
double to_outline(const Region& region, double x, double y) noexcept {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < region.sides.size(); ++i) {
    const RegionSide& a = region.sides[i];
    const RegionSide& b = region.sides[(i + 1) % region.sides.size()];
    double nx = 0.0;
    double ny = 0.0;
    nearest = std::min(nearest, distance_to_segment(x, y, a.x_m, a.y_m, b.x_m, b.y_m, nx, ny));
  }
  return nearest;
}

}  // namespace

void RegionMap::build(const std::vector<Region>& regions, double min_x_m, double min_y_m, double max_x_m,
                      double max_y_m, double margin_m) {
  min_x_m_ = min_x_m;
  min_y_m_ = min_y_m;
  max_x_m_ = max_x_m;
  max_y_m_ = max_y_m;
  margin_m_ = margin_m;
  const double width = std::max(max_x_m - min_x_m, 1e-3);
  const double depth = std::max(max_y_m - min_y_m, 1e-3);
  cell_m_ = std::max(kCell_m, std::sqrt(width * depth / kMostCells));
  per_cell_ = 1.0 / cell_m_;
  columns_ = std::max(1U, static_cast<std::uint32_t>(std::ceil(width * per_cell_)));
  lines_ = std::max(1U, static_cast<std::uint32_t>(std::ceil(depth * per_cell_)));
  const std::size_t cells = static_cast<std::size_t>(columns_) * lines_;
  region_kind_.clear();
  for (const Region& region : regions) region_kind_.push_back(region.air ? 1 : 0);

  const double near = margin_m + kHalfDiagonal * cell_m_;  // from a cell's centre
  struct Near {
    std::size_t cell;
    std::uint16_t region;
    bool inside;  // the whole cell and its surroundings
  };
  std::vector<Near> found;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    const Region& region = regions[r];
    const bool all = region.everywhere();
    const auto index = static_cast<std::uint16_t>(r);
    const std::uint32_t x0 = all ? 0 : clamped((region.min_x_m - near - min_x_m) * per_cell_, columns_);
    const std::uint32_t x1 = all ? columns_ - 1 : clamped((region.max_x_m + near - min_x_m) * per_cell_, columns_);
    const std::uint32_t y0 = all ? 0 : clamped((region.min_y_m - near - min_y_m) * per_cell_, lines_);
    const std::uint32_t y1 = all ? lines_ - 1 : clamped((region.max_y_m + near - min_y_m) * per_cell_, lines_);
    for (std::uint32_t y = y0; y <= y1; ++y) {
      for (std::uint32_t x = x0; x <= x1; ++x) {
        const std::size_t cell = static_cast<std::size_t>(y) * columns_ + x;
        const double cx = min_x_m + (x + 0.5) * cell_m_;
        const double cy = min_y_m + (y + 0.5) * cell_m_;
        const double gap = all ? near : to_outline(region, cx, cy);
        const bool contains = region.contains(cx, cy);
        // A cell at the arena's edge also answers for what lies beyond it.
        const bool edge = x == 0 || y == 0 || x + 1 == columns_ || y + 1 == lines_;
        if (contains || gap <= near || edge) found.push_back({cell, index, contains && gap >= near});
      }
    }
  }

  start_.assign(cells + 1, 0);
  for (const Near& n : found) ++start_[n.cell + 1];
  for (std::size_t c = 0; c < cells; ++c) start_[c + 1] += start_[c];
  list_.resize(found.size());
  std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
  for (auto& alone : alone_) alone.assign(cells, kNoRegion);
  std::vector<std::uint8_t> count[2];
  for (auto& c : count) c.assign(cells, 0);
  for (const Near& n : found) {  // regions in rising order, so every cell's list is
    list_[next[n.cell]++] = n.region;
    const std::uint8_t kind = region_kind_[n.region];
    count[kind][n.cell] = static_cast<std::uint8_t>(std::min(2, count[kind][n.cell] + 1));
    alone_[kind][n.cell] = count[kind][n.cell] == 1 && n.inside ? n.region : kNoRegion;
  }
}

}  // namespace tandem::core
