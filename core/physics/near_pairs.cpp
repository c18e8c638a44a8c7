#include "core/physics/near_pairs.hpp"

#include <algorithm>
#include <cmath>

namespace tandem::core {
namespace {

constexpr std::size_t kNeighbours = 12;  // of a body in a packed crowd
constexpr double kCellsPerBody = 4.0;    // at most: sweeping empty cells costs, too

/// At least doubles what must grow: numbers of bodies that creep up cost few allocations.
void make_room(std::vector<std::uint32_t>& list, std::size_t count) {
  if (list.capacity() < count) list.reserve(std::max(count, 2 * list.capacity()));
}

}  // namespace

void NearPairs::reserve(std::size_t bodies) {
  cell_of_.reserve(bodies);
  sorted_.reserve(bodies);
  start_.reserve(bodies + 1);
  make_room(list_, kNeighbours * bodies);
  make_room(cell_start_, static_cast<std::size_t>(kCellsPerBody * static_cast<double>(bodies)) + 18);
}

void NearPairs::sort_into_cells(const Cylinders& bodies) {
  const std::size_t n = bodies.x_m.size();
  const auto [west, east] = std::minmax_element(bodies.x_m.begin(), bodies.x_m.end());
  const auto [south, north] = std::minmax_element(bodies.y_m.begin(), bodies.y_m.end());
  double reach_m = 0.0;
  for (std::size_t i = 0; i < n; ++i) reach_m = std::max(reach_m, bodies.radius_m[i] + bodies.hop_m[i]);
  const double width = *east - *west;
  const double depth = *north - *south;
  // Two that may touch lie in the same cell or in adjacent ones.
  double cell_m = std::max(2.0 * reach_m, 1e-6);
  const double most = kCellsPerBody * static_cast<double>(n) + 16.0;
  while ((width / cell_m + 1.0) * (depth / cell_m + 1.0) > most) cell_m *= 1.5;
  min_x_m_ = *west;
  min_y_m_ = *south;
  per_cell_ = 1.0 / cell_m;
  columns_ = static_cast<std::uint32_t>(width * per_cell_) + 1;
  lines_ = static_cast<std::uint32_t>(depth * per_cell_) + 1;

  cell_of_.resize(n);
  sorted_.resize(n);
  make_room(cell_start_, static_cast<std::size_t>(most) + 2);
  cell_start_.assign(static_cast<std::size_t>(columns_) * lines_ + 1, 0);
  for (std::size_t i = 0; i < n; ++i) {
    const auto column = std::min(columns_ - 1, static_cast<std::uint32_t>((bodies.x_m[i] - min_x_m_) * per_cell_));
    const auto line = std::min(lines_ - 1, static_cast<std::uint32_t>((bodies.y_m[i] - min_y_m_) * per_cell_));
    cell_of_[i] = line * columns_ + column;
    ++cell_start_[cell_of_[i] + 1];
  }
  for (std::size_t c = 1; c < cell_start_.size(); ++c) cell_start_[c] += cell_start_[c - 1];
  for (std::size_t i = 0; i < n; ++i) sorted_[cell_start_[cell_of_[i]]++] = static_cast<std::uint32_t>(i);
  for (std::size_t c = cell_start_.size() - 1; c > 0; --c) cell_start_[c] = cell_start_[c - 1];
  cell_start_[0] = 0;
}

void NearPairs::find(const Cylinders& bodies) {
  const std::size_t n = bodies.x_m.size();
  start_.resize(n + 1);
  start_[0] = 0;
  list_.clear();
  make_room(list_, kNeighbours * n);  // crowds gather and part without allocations
  if (n == 0) return;
  sort_into_cells(bodies);
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t column = cell_of_[i] % columns_;
    const std::uint32_t line = cell_of_[i] / columns_;
    for (std::uint32_t l = line == 0 ? 0 : line - 1; l <= std::min(line + 1, lines_ - 1); ++l) {
      const std::uint32_t first = l * columns_ + (column == 0 ? 0 : column - 1);
      const std::uint32_t last = l * columns_ + std::min(column + 1, columns_ - 1);
      for (std::uint32_t s = cell_start_[first]; s < cell_start_[last + 1]; ++s) {
        const std::uint32_t k = sorted_[s];
        const double dx = bodies.x_m[k] - bodies.x_m[i];
        const double dy = bodies.y_m[k] - bodies.y_m[i];
        const double hops = bodies.hop_m[i] + bodies.hop_m[k];
        const double reach = bodies.radius_m[i] + bodies.radius_m[k] + hops;
        if (dx * dx + dy * dy >= reach * reach || k == i) continue;
        const double up = bodies.z_m[k] - bodies.z_m[i];
        if (up >= bodies.height_m[i] + hops || -up >= bodies.height_m[k] + hops) continue;
        list_.push_back(k);
      }
    }
    std::sort(list_.begin() + start_[i], list_.end());
    start_[i + 1] = static_cast<std::uint32_t>(list_.size());
  }
}

}  // namespace tandem::core
