// Finds the regions near a point: for most points with one look into a grid.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "core/space/region.hpp"

namespace tandem::core {

/// Built once for the regions of a run.
class RegionMap {
 public:
  /// Regions within `margin_m` of a point are near it.
  void build(const std::vector<Region>& regions, double min_x_m, double min_y_m, double max_x_m, double max_y_m,
             double margin_m);

  /// True when (x, y) lies in `region` and no other region of its sort (ground or air) is near.
  bool deep_inside(std::uint16_t region, double x_m, double y_m) const noexcept {
    return inside_area(x_m, y_m) && alone_[region_kind_[region]][cell_of(x_m, y_m)] == region;
  }
  /// Superset of the regions near (x, y), in rising order.
  std::span<const std::uint16_t> near(double x_m, double y_m) const noexcept {
    const std::size_t cell = cell_of(x_m, y_m);
    return {list_.data() + start_[cell], start_[cell + 1] - start_[cell]};
  }
  double margin() const noexcept { return margin_m_; }

 private:
  bool inside_area(double x_m, double y_m) const noexcept {
    return x_m >= min_x_m_ && x_m <= max_x_m_ && y_m >= min_y_m_ && y_m <= max_y_m_;
  }
  std::size_t cell_of(double x_m, double y_m) const noexcept {
    return static_cast<std::size_t>(clamped((y_m - min_y_m_) * per_cell_, lines_)) * columns_ +
           clamped((x_m - min_x_m_) * per_cell_, columns_);
  }
  static std::uint32_t clamped(double c, std::uint32_t count) noexcept {
    const double last = static_cast<double>(count - 1);
    return static_cast<std::uint32_t>(c > 0.0 ? (c < last ? c : last) : 0.0);  // NaN counts to cell 0
  }

  double min_x_m_ = 0.0, min_y_m_ = 0.0, max_x_m_ = 0.0, max_y_m_ = 0.0;
  double margin_m_ = 0.0, cell_m_ = 1.0, per_cell_ = 1.0;
  std::uint32_t columns_ = 1, lines_ = 1;
  std::vector<std::uint8_t> region_kind_;   // 0 ground, 1 air
  std::vector<std::uint16_t> alone_[2];     // by cell: the only region near any of its points, which all lie in it
  std::vector<std::uint32_t> start_{0, 0};  // of each cell's list
  std::vector<std::uint16_t> list_;
};

}  // namespace tandem::core
