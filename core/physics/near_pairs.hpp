// Pairs of bodies of a region that may touch within a tick.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tandem::core {

/// Upright cylinders and how far each may move in the tick.
struct Cylinders {
  std::span<const double> x_m, y_m, z_m;  ///< of the middle of the base
  std::span<const double> radius_m, height_m;
  std::span<const double> hop_m;
};

/// A list of neighbours for every body, found with a uniform grid. A second search over as many bodies allocates
/// nothing.
class NearPairs {
 public:
  /// For so many bodies, in a crowd.
  void reserve(std::size_t bodies);
  void find(const Cylinders& bodies);
  /// Those that may touch body `i` before all have moved by their hops, in rising order.
  std::span<const std::uint32_t> of(std::size_t i) const noexcept {
    return {list_.data() + start_[i], start_[i + 1] - start_[i]};
  }

 private:
  void sort_into_cells(const Cylinders& bodies);

  double min_x_m_ = 0.0, min_y_m_ = 0.0, per_cell_ = 1.0;
  std::uint32_t columns_ = 1, lines_ = 1;
  std::vector<std::uint32_t> cell_of_, cell_start_, sorted_;
  std::vector<std::uint32_t> start_{0}, list_;
};

}  // namespace tandem::core
