#include "core/space/object_index.hpp"

#include <algorithm>
#include <cmath>

namespace tandem::core {
namespace {

constexpr double kCell_m = 0.25;
constexpr double kMostCells = 4e6;
constexpr double kCellsPerMovable = 16.0;  // what is cleared every tick grows with what is in it
constexpr double kFewestMostCells = 1024.0;

/// Half extents of the upright rectangle around a shape.
std::pair<double, double> extents(const Object& s) {
  if (s.kind == Object::Kind::Cylinder) return {s.radius_m, s.radius_m};
  return {std::fabs(s.cos_h) * s.half_x_m + std::fabs(s.sin_h) * s.half_y_m,
          std::fabs(s.sin_h) * s.half_x_m + std::fabs(s.cos_h) * s.half_y_m};
}

/// Narrows [t0, t1] to where |o + t d| <= half; false when nothing is left.
bool clip(double o, double d, double half, double& t0, double& t1) noexcept {
  if (std::fabs(d) < 1e-12) return std::fabs(o) <= half;
  double a = (-half - o) / d;
  double b = (half - o) / d;
  if (a > b) std::swap(a, b);
  t0 = std::max(t0, a);
  t1 = std::min(t1, b);
  return t0 <= t1;
}

}  // namespace

void ObjectIndex::build(const std::vector<Object>& objects, bool movable, double min_x_m, double min_y_m,
                        double max_x_m, double max_y_m, double reach_m) {
  build_of(
      objects, [movable](const Object& o) { return o.alive && o.movable == movable; }, movable,
      {min_x_m, min_y_m, max_x_m, max_y_m}, reach_m);
}

void ObjectIndex::build_lit(const std::vector<Object>& objects, bool fresh_each_tick, double min_x_m, double min_y_m,
                            double max_x_m, double max_y_m, double reach_m) {
  build_of(
      objects, [](const Object& o) { return o.lit(); }, fresh_each_tick, {min_x_m, min_y_m, max_x_m, max_y_m}, reach_m);
}

template <class Listed>
void ObjectIndex::build_of(const std::vector<Object>& objects, Listed&& listed, bool each_tick, const Area& area,
                           double reach_m) {
  const auto [min_x_m, min_y_m, max_x_m, max_y_m] = area;
  const auto count = static_cast<double>(std::count_if(objects.begin(), objects.end(), listed));
  const double most_cells = each_tick ? std::max(kFewestMostCells, kCellsPerMovable * count) : kMostCells;
  min_x_m_ = min_x_m;
  min_y_m_ = min_y_m;
  reach_m_ = reach_m;
  const double width = std::max(max_x_m - min_x_m, 1e-3);
  const double depth = std::max(max_y_m - min_y_m, 1e-3);
  cell_m_ = count == 0.0 ? std::max(width, depth) : std::max(kCell_m, std::sqrt(width * depth / most_cells));
  per_cell_ = 1.0 / cell_m_;
  columns_ = std::max(1U, static_cast<std::uint32_t>(std::ceil(width * per_cell_)));
  lines_ = std::max(1U, static_cast<std::uint32_t>(std::ceil(depth * per_cell_)));

  const std::size_t cells = static_cast<std::size_t>(columns_) * lines_;
  const auto for_each_cell_of = [&](const Object& s, auto&& visit) {
    const auto [ex, ey] = extents(s);
    // A cell at the edge also stands for what lies beyond it, so the rectangle is clamped, not cut.
    const std::uint32_t x0 = at(s.x_m - ex - reach_m - min_x_m_, columns_);
    const std::uint32_t x1 = at(s.x_m + ex + reach_m - min_x_m_, columns_);
    const std::uint32_t y0 = at(s.y_m - ey - reach_m - min_y_m_, lines_);
    const std::uint32_t y1 = at(s.y_m + ey + reach_m - min_y_m_, lines_);
    for (std::uint32_t y = y0; y <= y1; ++y) {
      for (std::uint32_t x = x0; x <= x1; ++x) {
        const double cx = min_x_m_ + (x + 0.5) * cell_m_;
        const double cy = min_y_m_ + (y + 0.5) * cell_m_;
        double nx = 0.0;
        double ny = 0.0;
        const bool edge = x == 0 || y == 0 || x + 1 == columns_ || y + 1 == lines_;
        if (!edge && signed_distance(s, cx, cy, nx, ny) > reach_m + 0.7072 * cell_m_) continue;
        visit(static_cast<std::size_t>(y) * columns_ + x);
      }
    }
  };

  start_.assign(cells + 1, 0);
  for (const Object& o : objects) {
    if (listed(o)) for_each_cell_of(o, [&](std::size_t cell) { ++start_[cell + 1]; });
  }
  listed_.assign(cells / 64 + 1, 0);
  for (std::size_t c = 0; c < cells; ++c) {
    if (start_[c + 1] != 0) listed_[c / 64] |= std::uint64_t{1} << (c % 64);
  }
  for (std::size_t c = 0; c < cells; ++c) start_[c + 1] += start_[c];
  list_.resize(start_[cells]);
  next_.assign(start_.begin(), start_.end() - 1);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (!listed(objects[i])) continue;
    for_each_cell_of(objects[i], [&](std::size_t cell) { list_[next_[cell]++] = static_cast<std::uint32_t>(i); });
  }
  clearances_.clear();
  if (!each_tick) find_clearances();
}

/// Counts the cells to the nearest one that lists something, diagonal steps as one: once from the lower left corner,
/// once from the upper right. A cell that lists nothing has nothing within reach of its points.
void ObjectIndex::find_clearances() {
  const std::size_t cells = static_cast<std::size_t>(columns_) * lines_;
  std::vector<std::uint32_t> steps(cells);
  for (std::size_t c = 0; c < cells; ++c)
    steps[c] = (listed_[c / 64] >> (c % 64) & 1) != 0 ? 0U : std::max(columns_, lines_);
  const auto pass = [&](std::size_t c, std::size_t x, std::size_t y, bool back) {
    const bool first = back ? x + 1 == columns_ : x == 0;
    const bool last = back ? x == 0 : x + 1 == columns_;
    const auto before = [&](std::size_t k) { return back ? c + k : c - k; };
    if (!first) steps[c] = std::min(steps[c], steps[before(1)] + 1);
    if (back ? y + 1 == lines_ : y == 0) return;
    steps[c] = std::min(steps[c], steps[before(columns_)] + 1);
    if (!first) steps[c] = std::min(steps[c], steps[before(columns_ + std::size_t{1})] + 1);
    if (!last) steps[c] = std::min(steps[c], steps[before(columns_ - std::size_t{1})] + 1);
  };
  for (std::size_t c = 0; c < cells; ++c) pass(c, c % columns_, c / columns_, false);
  for (std::size_t c = cells; c-- > 0;) pass(c, c % columns_, c / columns_, true);
  clearances_.resize(cells);
  for (std::size_t c = 0; c < cells; ++c)
    clearances_[c] = steps[c] == 0 ? 0.0F : static_cast<float>((steps[c] - 1) * cell_m_ + 0.999 * reach_m_);
}

double signed_distance(const Object& s, double x_m, double y_m, double& nx, double& ny) noexcept {
  const double rx = x_m - s.x_m;
  const double ry = y_m - s.y_m;
  if (s.kind == Object::Kind::Cylinder) {
    const double d = std::sqrt(rx * rx + ry * ry);
    nx = d > 0.0 ? rx / d : 1.0;
    ny = d > 0.0 ? ry / d : 0.0;
    return d - s.radius_m;
  }
  const double lx = s.cos_h * rx + s.sin_h * ry;  // in the box's frame
  const double ly = -s.sin_h * rx + s.cos_h * ry;
  const double ox = std::fabs(lx) - s.half_x_m;  // beyond the faces
  const double oy = std::fabs(ly) - s.half_y_m;
  double bx = 0.0;
  double by = 0.0;
  double distance = 0.0;
  if (ox > 0.0 && oy > 0.0) {  // nearest to a corner
    distance = std::sqrt(ox * ox + oy * oy);
    bx = std::copysign(ox / distance, lx);
    by = std::copysign(oy / distance, ly);
  } else if (ox > oy) {
    distance = ox;
    bx = std::copysign(1.0, lx);
  } else {
    distance = oy;
    by = std::copysign(1.0, ly);
  }
  nx = s.cos_h * bx - s.sin_h * by;
  ny = s.sin_h * bx + s.cos_h * by;
  return distance;
}

bool blocks(const Object& s, double ax, double ay, double az, double bx, double by, double bz) noexcept {
  double t0 = 0.0;
  double t1 = 1.0;
  const double half_z = 0.5 * (s.z_high_m - s.z_low_m);
  if (!clip(az - s.z_low_m - half_z, bz - az, half_z, t0, t1)) return false;
  const double ox = ax - s.x_m;
  const double oy = ay - s.y_m;
  const double dx = bx - ax;
  const double dy = by - ay;
  if (s.kind == Object::Kind::Box) {
    return clip(s.cos_h * ox + s.sin_h * oy, s.cos_h * dx + s.sin_h * dy, s.half_x_m, t0, t1) &&
           clip(-s.sin_h * ox + s.cos_h * oy, -s.sin_h * dx + s.cos_h * dy, s.half_y_m, t0, t1);
  }
  // The point of [t0, t1] nearest to the axis.
  const double length2 = dx * dx + dy * dy;
  double t = length2 > 0.0 ? -(ox * dx + oy * dy) / length2 : t0;
  t = std::min(std::max(t, t0), t1);
  const double px = ox + t * dx;
  const double py = oy + t * dy;
  return px * px + py * py <= s.radius_m * s.radius_m;
}

}  // namespace tandem::core
