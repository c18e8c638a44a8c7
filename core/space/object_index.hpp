// Index of boxes and cylinders: a grid whose cells list what lies within reach of any point in them.
#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/space/space.hpp"

namespace tandem::core {

/// Built for the immovable things once, for the movable ones every tick; then only read.
class ObjectIndex {
 public:
  /// Lists the living things whose `movable` is as asked. `reach_m`: how far from a point a thing may lie to be listed
  /// for it. A second build over as many things allocates nothing.
  void build(const std::vector<Object>& objects, bool movable, double min_x_m, double min_y_m, double max_x_m,
             double max_y_m, double reach_m);

  /// Lists the living things that have a lit LED. `fresh_each_tick`: there are movable ones among them.
  void build_lit(const std::vector<Object>& objects, bool fresh_each_tick, double min_x_m, double min_y_m,
                 double max_x_m, double max_y_m, double reach_m);

  /// Indices into the shapes; superset of those within `reach()` of (x, y), in rising order.
  std::span<const std::uint32_t> near(double x_m, double y_m) const noexcept {
    const std::size_t cell = cell_at(x_m, y_m);
    if ((listed_[cell / 64] >> (cell % 64) & 1) == 0) return {};
    return {list_.data() + start_[cell], start_[cell + 1] - start_[cell]};
  }
  /// No listed thing lies nearer to (x, y) than this; 0 where that is not known, as among movable things.
  double clearance_m(double x_m, double y_m) const noexcept {
    if (list_.empty()) return std::numeric_limits<double>::infinity();
    return clearances_.empty() ? 0.0 : clearances_[cell_at(x_m, y_m)];
  }
  double reach() const noexcept { return reach_m_; }
  double cell_size() const noexcept { return cell_m_; }
  bool empty() const noexcept { return list_.empty(); }
  /// Of its arrays.
  std::size_t bytes() const noexcept {
    return (start_.size() + list_.size() + next_.size()) * sizeof(std::uint32_t) +
           listed_.size() * sizeof(std::uint64_t) + clearances_.size() * sizeof(float);
  }
  void remember(auto& archive) {
    archive(min_x_m_, min_y_m_, reach_m_, cell_m_, per_cell_, columns_, lines_, start_, list_, listed_, clearances_,
            next_);
  }

 private:
  struct Area {
    double min_x_m, min_y_m, max_x_m, max_y_m;
  };
  template <class Listed>
  void build_of(const std::vector<Object>& objects, Listed&& listed, bool each_tick, const Area& area, double reach_m);

  std::size_t cell_at(double x_m, double y_m) const noexcept {
    return static_cast<std::size_t>(at(y_m - min_y_m_, lines_)) * columns_ + at(x_m - min_x_m_, columns_);
  }
  void find_clearances();

  std::uint32_t at(double offset_m, std::uint32_t count) const noexcept {
    const double c = offset_m * per_cell_;
    const double last = static_cast<double>(count - 1);
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(c > 0.0 ? (c < last ? c : last) : 0.0));
  }

  double min_x_m_ = 0.0, min_y_m_ = 0.0;
  double reach_m_ = 0.0, cell_m_ = 1.0, per_cell_ = 1.0;
  std::uint32_t columns_ = 1, lines_ = 1;
  std::vector<std::uint32_t> start_{0, 0};
  std::vector<std::uint32_t> list_;
  std::vector<std::uint64_t> listed_{0};  // a bit a cell: it lists something. Stays in the cache where start_ does not
  std::vector<float> clearances_;         // by cell, in m; empty where things move
  std::vector<std::uint32_t> next_;       // while building
};

/// Distance from (x, y) to the outline of `shape` seen from above; negative inside. `nx, ny` is the unit vector from
/// the shape towards the point (outwards), in W.
double signed_distance(const Object& shape, double x_m, double y_m, double& nx, double& ny) noexcept;

/// True when the straight line from a to b (x, y, z in W) passes through `shape`.
bool blocks(const Object& shape, double ax, double ay, double az, double bx, double by, double bz) noexcept;

}  // namespace tandem::core
