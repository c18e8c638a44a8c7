// Who is near whom: a uniform grid over the arena, rebuilt by counting sort every tick.
#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/schedule/thread_pool.hpp"

namespace tandem::core {

/// One body as its neighbours see it: a disc. 24 bytes, so that a neighbour costs one cache line.
struct IndexEntry {
  double x_m = 0.0;
  double y_m = 0.0;
  float radius_m = 0.0F;
  std::uint32_t row_and_flag = 0;  ///< row; highest bit: not moved by contacts

  static constexpr std::uint32_t kFixedFlag = 0x8000'0000U;
  std::uint32_t row() const noexcept { return row_and_flag & ~kFixedFlag; }
  bool fixed() const noexcept { return (row_and_flag & kFixedFlag) != 0; }
};

/// Bodies sorted by cell, cells in rows from west to east: the cells of one row that a query touches are one run of
/// entries. Within a cell, entries stand in the order of their rows: nothing depends on the number of threads.
class BodyIndex {
 public:
  /// The grid covers the rectangle; bodies beyond it count to the nearest cell. `reach_m` is the longest distance at
  /// which bodies are looked for every tick.
  void set_area(double min_x_m, double min_y_m, double max_x_m, double max_y_m, double reach_m);

  /// Sorts anew the bodies whose `row_and_flag` is not `kSkip`. `fill(row)` gives row's entry.
  template <class Fill>
  void rebuild(std::size_t rows, std::size_t living, ThreadPool& pool, Fill&& fill) {
    prepare(rows, living);
    pool.run(rows, kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t row = begin; row < end; ++row) {
        staged_[row] = fill(row);
        cell_of_row_[row] = staged_[row].row_and_flag == kSkip ? kNoCell : cell_of(staged_[row].x_m, staged_[row].y_m);
      }
    });
    sort(rows, pool);
  }

  static constexpr std::uint32_t kSkip = 0x7FFF'FFFFU;

  std::size_t size() const noexcept { return entries_.size(); }
  const IndexEntry* entries() const noexcept { return entries_.data(); }
  IndexEntry* entries() noexcept { return entries_.data(); }

  /// Bodies may have been moved in place by up to this since the last rebuild; queries widen by it.
  void set_displacement(double displacement_m) noexcept { displacement_m_ = displacement_m; }
  double displacement() const noexcept { return displacement_m_; }
  double cell_size() const noexcept { return cell_m_; }

  /// Calls `visit(const IndexEntry&)` for every body whose centre may be within `radius_m` of (x, y); some are farther.
  template <class Visit>
  [[gnu::always_inline]] inline void for_each_near(double x_m, double y_m, double radius_m,
                                                   Visit&& visit) const noexcept {
    const double r = radius_m + displacement_m_;
    const std::uint32_t x0 = column(x_m - r);
    const std::uint32_t x1 = column(x_m + r);
    const std::uint32_t y0 = line(y_m - r);
    const std::uint32_t y1 = line(y_m + r);
    for (std::uint32_t y = y0; y <= y1; ++y) {
      const std::size_t base = static_cast<std::size_t>(y) * columns_;
      const std::uint32_t last = start_[base + x1 + 1];
      for (std::uint32_t i = start_[base + x0]; i < last; ++i) visit(entries_[i]);
    }
  }

 private:
  static constexpr std::size_t kGrain = 2048;
  static constexpr std::uint32_t kNoCell = 0xFFFF'FFFFU;

  std::uint32_t column(double x_m) const noexcept { return clamp_cell((x_m - min_x_m_) * per_cell_, columns_); }
  std::uint32_t line(double y_m) const noexcept { return clamp_cell((y_m - min_y_m_) * per_cell_, lines_); }
  static std::uint32_t clamp_cell(double c, std::uint32_t count) noexcept {
    const double last = static_cast<double>(count - 1);
    const double clamped = c > 0.0 ? (c < last ? c : last) : 0.0;  // NaN counts to cell 0
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(clamped));
  }
  std::uint32_t cell_of(double x_m, double y_m) const noexcept { return line(y_m) * columns_ + column(x_m); }

  void prepare(std::size_t rows, std::size_t living);
  void sort(std::size_t rows, ThreadPool& pool);

  double min_x_m_ = 0.0, min_y_m_ = 0.0, max_x_m_ = 1.0, max_y_m_ = 1.0;
  double reach_m_ = 0.1;
  double cell_m_ = 1.0;
  double per_cell_ = 1.0;
  double displacement_m_ = 0.0;
  std::uint32_t columns_ = 1;
  std::uint32_t lines_ = 1;
  std::size_t planned_for_ = 0;       // number of bodies that the cell size was chosen for
  std::vector<std::uint32_t> start_;  // first entry of each cell, and one past the last
  std::vector<std::uint32_t> cell_of_row_;
  std::vector<IndexEntry> staged_;   // by row
  std::vector<IndexEntry> entries_;  // sorted
};

}  // namespace tandem::core
