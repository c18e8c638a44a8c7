#include "core/space/body_index.hpp"

#include <algorithm>

namespace tandem::core {
namespace {

constexpr double kCellsPerBody = 5.0;  // more cells cost their clearing, fewer cost candidates
constexpr std::size_t kFewestCells = 64;

}  // namespace

void BodyIndex::set_area(double min_x_m, double min_y_m, double max_x_m, double max_y_m, double reach_m) {
  min_x_m_ = min_x_m;
  min_y_m_ = min_y_m;
  max_x_m_ = max_x_m;
  max_y_m_ = max_y_m;
  reach_m_ = reach_m;
  planned_for_ = 0;
}

void BodyIndex::prepare(std::size_t rows, std::size_t living) {
  displacement_m_ = 0.0;
  if (planned_for_ == 0 || living > 2 * planned_for_ || 4 * living < planned_for_) {
    planned_for_ = std::max<std::size_t>(1, living);
    const double width = max_x_m_ - min_x_m_;
    const double depth = max_y_m_ - min_y_m_;
    const double cells = std::max(kCellsPerBody * static_cast<double>(living), static_cast<double>(kFewestCells));
    // Cells are never smaller than what is looked for every tick, and never more than a few a body.
    cell_m_ = std::max(reach_m_, std::sqrt(width * depth / cells));
    per_cell_ = 1.0 / cell_m_;
    columns_ = std::max(1U, static_cast<std::uint32_t>(std::ceil(width * per_cell_)));
    lines_ = std::max(1U, static_cast<std::uint32_t>(std::ceil(depth * per_cell_)));
    start_.assign(static_cast<std::size_t>(columns_) * lines_ + 1, 0);
  }
  cell_of_row_.resize(rows);
  staged_.resize(rows);
  entries_.resize(living);
}

void BodyIndex::sort(std::size_t rows, ThreadPool& pool) {
  // Each part owns a band of cells. It reads every row's cell and counts, then places, those of its own band, in the
  // order of rows: a stable counting sort without shared counters, whose result does not depend on the number of parts.
  const std::size_t cells = start_.size() - 1;
  const std::size_t parts = rows < 2 * kGrain ? 1 : pool.size();
  const auto band = [&](std::size_t part) { return static_cast<std::uint32_t>(cells * part / parts); };
  const auto for_each_row_of = [&](std::size_t part, auto&& visit) {
    const std::uint32_t first = band(part);
    const std::uint32_t width = band(part + 1) - first;
    for (std::size_t row = 0; row < rows; ++row) {
      const std::uint32_t cell = cell_of_row_[row];
      if (cell - first < width) visit(row, cell);
    }
  };

  // start_[c + 1] counts cell c; the running sum then makes it the end of c, and placing backwards its beginning.
  pool.run_parts(parts, [&](std::size_t part) {
    std::fill(start_.begin() + band(part) + 1, start_.begin() + band(part + 1) + 1, 0U);
    for_each_row_of(part, [&](std::size_t, std::uint32_t cell) { ++start_[cell + 1]; });
  });
  std::uint32_t sum = 0;
  start_[0] = 0;
  for (std::size_t c = 1; c <= cells; ++c) {
    const std::uint32_t count = start_[c];
    start_[c] = sum;  // for now the beginning of cell c - 1
    sum += count;
  }
  pool.run_parts(parts, [&](std::size_t part) {
    for_each_row_of(part, [&](std::size_t row, std::uint32_t cell) { entries_[start_[cell + 1]++] = staged_[row]; });
  });
  // Each start_[c + 1] has moved from the beginning of c to its end, which is what queries read.
}

}  // namespace tandem::core
