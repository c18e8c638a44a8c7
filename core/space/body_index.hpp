// Neighbour search: a uniform grid over the arena, rebuilt by counting sort every tick.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "core/schedule/thread_pool.hpp"
#include "core/space/large_memory.hpp"

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

/// Bodies sorted by cell. The grid is cut into strips of columns, one after the other; within a strip, cells lie in
/// lines from west to east: so what is near in space is near in memory, and the cells of one line that a query touches
/// are one run of entries, or two where it crosses the edge of a strip. Within a cell, entries stand in the order of
/// their rows: nothing depends on the number of threads.
class BodyIndex {
 public:
  /// The grid covers the rectangle; bodies beyond it count to the nearest cell. `reach_m` is the longest distance at
  /// which bodies are looked for every tick.
  void set_area(double min_x_m, double min_y_m, double max_x_m, double max_y_m, double reach_m);

  /// Where the body of a row is, if it is to be found at all.
  struct Spot {
    double x_m = 0.0;
    double y_m = 0.0;
    bool there = false;
  };

  /// Sorts again. `spot(row)` says where each row's body is, and is called once for each; `living` of them are there.
  /// `fill(row)` gives the entry of one that is.
  template <class SpotOf, class Fill>
  void rebuild(std::size_t rows, std::size_t living, ThreadPool& pool, SpotOf&& spot, Fill&& fill);

  std::size_t size() const noexcept { return living_; }
  const IndexEntry* entries() const noexcept { return entries_.data(); }
  IndexEntry* entries() noexcept { return entries_.data(); }

  /// Bodies may have been moved in place by up to this since the last rebuild; queries widen by it.
  void set_displacement(double displacement_m) noexcept { displacement_m_ = displacement_m; }
  double displacement() const noexcept { return displacement_m_; }
  double cell_size() const noexcept { return cell_m_; }

  /// Calls `visit(first, past)`, indices into entries(), for runs that together hold every body whose centre may be
  /// within `radius_m` of (x, y); some are farther. In no order to rely on: for what does not depend on it.
  template <class Visit>
  [[gnu::always_inline]] inline void for_each_run_near(double x_m, double y_m, double radius_m,
                                                       Visit&& visit) const noexcept {
    const Window w = window(x_m, y_m, radius_m);
    std::uint32_t x = w.x0;
    for (;;) {  // strips: nearly always one
      const std::uint32_t past = past_strip(x);
      const std::uint32_t width = (past <= w.x1 ? past : w.x1 + 1) - x;
      const std::uint32_t* start = start_.data() + cell_at(x, w.y0);
      for (std::uint32_t y = w.y0; y <= w.y1; ++y, start += strip_columns_) visit(start[0], start[width]);
      if (past > w.x1) [[likely]]
        return;
      x = past;
    }
  }

  /// Calls `visit(const IndexEntry&)` for the same bodies one by one, by lines from south to north, cells from west to
  /// east, and rows of the arrays: an order that depends on the bodies alone.
  template <class Visit>
  void for_each_near(double x_m, double y_m, double radius_m, Visit&& visit) const noexcept {
    const Window w = window(x_m, y_m, radius_m);
    for (std::uint32_t y = w.y0; y <= w.y1; ++y) {
      std::uint32_t past = 0;
      for (std::uint32_t x = w.x0; x <= w.x1; x = past) {
        past = std::min(past_strip(x), w.x1 + 1);
        const std::uint32_t* start = start_.data() + cell_at(x, y);
        for (std::uint32_t i = start[0]; i < start[past - x]; ++i) visit(entries_[i]);
      }
    }
  }

  /// Of its arrays.
  std::size_t bytes() const noexcept {
    return (start_.size() + cell_of_row_.size() + counted_.size()) * sizeof(std::uint32_t) +
           entries_.size() * sizeof(IndexEntry);
  }

  void remember(auto& archive) {
    archive(min_x_m_, min_y_m_, max_x_m_, max_y_m_, reach_m_, cell_m_, per_cell_, displacement_m_, columns_, lines_,
            strip_shift_, strip_columns_, strip_cells_, planned_for_, start_, cell_of_row_, counted_, living_,
            entries_);
  }

  /// So many entries may be read from any one on, be they a body's or not.
  static constexpr std::size_t kReadAhead = 2;

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
  std::uint32_t cell_at(std::uint32_t x, std::uint32_t y) const noexcept {
    const std::uint32_t strip = x >> strip_shift_;
    return strip * strip_cells_ + y * strip_columns_ + (x - (strip << strip_shift_));
  }

  /// The cells that a query touches, all inclusive.
  struct Window {
    std::uint32_t x0, x1, y0, y1;
  };
  Window window(double x_m, double y_m, double radius_m) const noexcept {
    const double r = radius_m + displacement_m_;
    return {column(x_m - r), column(x_m + r), line(y_m - r), line(y_m + r)};
  }
  /// The first column of the strip after that of column x.
  std::uint32_t past_strip(std::uint32_t x) const noexcept { return ((x >> strip_shift_) + 1) << strip_shift_; }

  void prepare(std::size_t rows, std::size_t living, std::size_t threads);
  void plan();

  double min_x_m_ = 0.0, min_y_m_ = 0.0, max_x_m_ = 1.0, max_y_m_ = 1.0;
  double reach_m_ = 0.1;
  double cell_m_ = 1.0;
  double per_cell_ = 1.0;
  double displacement_m_ = 0.0;
  std::uint32_t columns_ = 1;
  std::uint32_t lines_ = 1;
  std::uint32_t strip_shift_ = 31;  // a strip is 2^shift columns wide; 31: one strip of any width
  std::uint32_t strip_columns_ = 1;
  std::uint32_t strip_cells_ = 1;
  std::size_t planned_for_ = 0;       // number of bodies that the cell size was chosen for
  LargeVector<std::uint32_t> start_;  // first entry of each cell, and one past the last
  LargeVector<std::uint32_t> cell_of_row_;
  std::vector<std::uint32_t> counted_;  // bodies in each part's cells; then: in those before
  std::size_t living_ = 0;
  LargeVector<IndexEntry> entries_;  // sorted; the last kReadAhead are unused
};

template <class SpotOf, class Fill>
void BodyIndex::rebuild(std::size_t rows, std::size_t living, ThreadPool& pool, SpotOf&& spot, Fill&& fill) {
  prepare(rows, living, pool.size());
  pool.run(rows, kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const Spot at = spot(row);
      cell_of_row_[row] = at.there ? cell_at(column(at.x_m), line(at.y_m)) : kNoCell;
    }
  });

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

  // start_[c + 1] counts cell c; the running sum then makes it the beginning of c, and placing moves it to c's end.
  pool.run_parts(parts, [&](std::size_t part) {
    std::fill(start_.begin() + band(part) + 1, start_.begin() + band(part + 1) + 1, 0U);
    std::uint32_t count = 0;
    for_each_row_of(part, [&](std::size_t, std::uint32_t cell) {
      ++start_[cell + 1];
      ++count;
    });
    counted_[part] = count;
  });
  std::exclusive_scan(counted_.begin(), counted_.begin() + static_cast<std::ptrdiff_t>(parts), counted_.begin(), 0U);
  pool.run_parts(parts, [&](std::size_t part) {
    std::uint32_t sum = counted_[part];
    for (std::size_t c = band(part) + 1; c <= band(part + 1); ++c) {
      const std::uint32_t count = start_[c];
      start_[c] = sum;
      sum += count;
    }
    for_each_row_of(part, [&](std::size_t row, std::uint32_t cell) { entries_[start_[cell + 1]++] = fill(row); });
  });
}

}  // namespace tandem::core
