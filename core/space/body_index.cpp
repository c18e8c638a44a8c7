#include "core/space/body_index.hpp"

#include <algorithm>

namespace tandem::core {
namespace {

constexpr double kCellsPerBody = 5.0;  // more cells cost their clearing, fewer cost candidates
constexpr std::size_t kFewestCells = 64;
constexpr std::uint32_t kMostColumnsInOne = 512;  // the lines of a wider grid lie too far apart for the caches
constexpr std::uint32_t kStripShift = 6;  // 2^6 columns: few queries cross, and a strip's line is a few hundred bytes

}  // namespace

void BodyIndex::set_area(double min_x_m, double min_y_m, double max_x_m, double max_y_m, double reach_m) {
  min_x_m_ = min_x_m;
  min_y_m_ = min_y_m;
  max_x_m_ = max_x_m;
  max_y_m_ = max_y_m;
  reach_m_ = reach_m;
  planned_for_ = 0;
}

void BodyIndex::prepare(std::size_t rows, std::size_t living, std::size_t threads) {
  displacement_m_ = 0.0;
  if (planned_for_ == 0 || living > 2 * planned_for_ || 4 * living < planned_for_) {
    planned_for_ = std::max<std::size_t>(1, living);
    plan();
  }
  cell_of_row_.resize(rows);
  living_ = living;
  entries_.resize(living + kReadAhead);
  counted_.resize(threads + 1);
}

void BodyIndex::plan() {
  const double width = max_x_m_ - min_x_m_;
  const double depth = max_y_m_ - min_y_m_;
  const double cells = std::max(kCellsPerBody * static_cast<double>(planned_for_), static_cast<double>(kFewestCells));
  // Cells are never smaller than what is looked for every tick, and never more than a few a body.
  cell_m_ = std::max(reach_m_, std::sqrt(width * depth / cells));
  per_cell_ = 1.0 / cell_m_;
  columns_ = std::max(1U, static_cast<std::uint32_t>(std::ceil(width * per_cell_)));
  lines_ = std::max(1U, static_cast<std::uint32_t>(std::ceil(depth * per_cell_)));
  const bool one = columns_ <= kMostColumnsInOne;
  strip_shift_ = one ? 31 : kStripShift;
  strip_columns_ = one ? columns_ : 1U << kStripShift;
  strip_cells_ = strip_columns_ * lines_;
  start_.assign(static_cast<std::size_t>(((columns_ - 1) >> strip_shift_) + 1) * strip_cells_ + 1, 0);
}

}  // namespace tandem::core
