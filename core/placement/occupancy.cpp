#include "core/placement/occupancy.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tandem::core {
namespace {

constexpr double kMostCells = 64.0;  // for which one obstacle is listed

std::uint64_t key_of(std::int64_t x, std::int64_t y) noexcept {
  return (static_cast<std::uint64_t>(y) << 32) ^ (static_cast<std::uint64_t>(x) & 0xFFFFFFFFU);
}

std::size_t hash_of(std::uint64_t key) noexcept {  // the finaliser of MurmurHash3
  key = (key ^ (key >> 33)) * 0xFF51AFD7ED558CCDULL;
  key = (key ^ (key >> 33)) * 0xC4CEB9FE1A85EC53ULL;
  return key ^ (key >> 33);
}

double point_to_box(const Obstacle& box, double x, double y) {
  const double rx = x - box.x_m;
  const double ry = y - box.y_m;
  const double ox = std::max(std::fabs(box.cos_h * rx + box.sin_h * ry) - box.half_x_m, 0.0);
  const double oy = std::max(std::fabs(-box.sin_h * rx + box.cos_h * ry) - box.half_y_m, 0.0);
  return std::hypot(ox, oy);
}

/// Separating-axis test of two rectangles.
bool boxes_overlap(const Obstacle& a, const Obstacle& b) {
  const double dx = b.x_m - a.x_m;
  const double dy = b.y_m - a.y_m;
  const auto apart = [&](double ux, double uy) {
    const auto reach = [&](const Obstacle& o) {
      return std::fabs(ux * o.cos_h + uy * o.sin_h) * o.half_x_m + std::fabs(-ux * o.sin_h + uy * o.cos_h) * o.half_y_m;
    };
    return std::fabs(dx * ux + dy * uy) >= reach(a) + reach(b);
  };
  return !(apart(a.cos_h, a.sin_h) || apart(-a.sin_h, a.cos_h) || apart(b.cos_h, b.sin_h) || apart(-b.sin_h, b.cos_h));
}

// --- tilted bodies ---

using Vector = Solid::Vector;

double dot(const Vector& a, const Vector& b) noexcept {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vector cross(const Vector& a, const Vector& b) noexcept {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Solid solid_of(const Obstacle& o) noexcept {
  if (o.leans != nullptr) return *o.leans;
  const double half_height_m = 0.5 * (o.z_high_m - o.z_low_m);
  Solid s;
  s.axes = {{{o.cos_h, o.sin_h, 0.0}, {-o.sin_h, o.cos_h, 0.0}, {0.0, 0.0, 1.0}}};
  s.middle_m = {o.x_m, o.y_m, o.z_low_m + half_height_m};
  s.half_m = {o.is_box ? o.half_x_m : o.radius_m, o.is_box ? o.half_y_m : o.radius_m, half_height_m};
  s.round = !o.is_box;
  return s;
}

/// Separating-axis test: complete for two boxes. For a cylinder the ways from its axis to the corners and to the
/// middle of the other are tried, too.
bool solids_overlap(const Solid& a, const Solid& b) noexcept {
  constexpr double kTouching_m = 1e-9;
  const Vector way{b.middle_m[0] - a.middle_m[0], b.middle_m[1] - a.middle_m[1], b.middle_m[2] - a.middle_m[2]};
  const auto apart = [&](Vector u) {
    const double size = std::sqrt(dot(u, u));
    if (size < 1e-9) return false;
    for (double& x : u) x /= size;
    return std::fabs(dot(way, u)) >= half_extent(a, u) + half_extent(b, u) - kTouching_m;
  };
  for (const Vector& u : a.axes) {
    if (apart(u)) return false;
  }
  for (const Vector& v : b.axes) {
    if (apart(v)) return false;
    for (const Vector& u : a.axes) {
      if (apart(cross(u, v))) return false;
    }
  }
  for (const auto& [round, other] : {std::pair{&a, &b}, std::pair{&b, &a}}) {
    if (!round->round) continue;
    const Vector& axis = round->axes[2];
    for (const double sx : {-1.0, 0.0, 1.0}) {
      for (const double sy : {-1.0, 0.0, 1.0}) {
        for (const double sz : {-1.0, 0.0, 1.0}) {
          Vector to{};
          for (std::size_t i = 0; i < 3; ++i)
            to[i] = other->middle_m[i] - round->middle_m[i] + sx * other->half_m[0] * other->axes[0][i] +
                    sy * other->half_m[1] * other->axes[1][i] + sz * other->half_m[2] * other->axes[2][i];
          const double along = dot(to, axis);
          for (std::size_t i = 0; i < 3; ++i) to[i] -= along * axis[i];
          if (apart(to)) return false;
        }
      }
    }
  }
  return true;
}

}  // namespace

double half_extent(const Solid& s, const Solid::Vector& along) noexcept {
  const double up = dot(s.axes[2], along);
  const double end_m = s.half_m[2] * std::fabs(up);
  if (s.round) return end_m + s.half_m[0] * std::sqrt(std::max(0.0, 1.0 - up * up));
  return end_m + s.half_m[0] * std::fabs(dot(s.axes[0], along)) + s.half_m[1] * std::fabs(dot(s.axes[1], along));
}

Obstacle bounds_of(const Solid& leans) noexcept {
  const double half_z_m = half_extent(leans, {0.0, 0.0, 1.0});
  Obstacle o = box_at(leans.middle_m[0], leans.middle_m[1], 2.0 * half_extent(leans, {1.0, 0.0, 0.0}),
                      2.0 * half_extent(leans, {0.0, 1.0, 0.0}), 0.0);
  o.z_low_m = leans.middle_m[2] - half_z_m;
  o.z_high_m = leans.middle_m[2] + half_z_m;
  o.leans = &leans;
  return o;
}

bool overlap(const Obstacle& a, const Obstacle& b) noexcept {
  if (a.leans != nullptr || b.leans != nullptr) return solids_overlap(solid_of(a), solid_of(b));
  const bool on_ground = (a.is_robot && !a.flies && !b.is_robot) || (b.is_robot && !b.flies && !a.is_robot);
  if (!on_ground && (a.z_high_m <= b.z_low_m || b.z_high_m <= a.z_low_m) && a.z_high_m > a.z_low_m &&
      b.z_high_m > b.z_low_m)
    return false;
  const double far = a.radius_m + b.radius_m;
  const double dx = a.x_m - b.x_m;
  const double dy = a.y_m - b.y_m;
  if (dx * dx + dy * dy >= far * far) return false;
  if (a.is_box && b.is_box) return boxes_overlap(a, b);
  if (a.is_box) return point_to_box(a, b.x_m, b.y_m) < b.radius_m;
  if (b.is_box) return point_to_box(b, a.x_m, a.y_m) < a.radius_m;
  return true;
}

Obstacle disc_at(double x_m, double y_m, double radius_m) noexcept {
  Obstacle o;
  o.x_m = x_m;
  o.y_m = y_m;
  o.radius_m = radius_m;
  return o;
}

Obstacle box_at(double x_m, double y_m, double size_x_m, double size_y_m, double yaw_rad) noexcept {
  Obstacle o = disc_at(x_m, y_m, 0.5 * std::hypot(size_x_m, size_y_m));
  o.is_box = true;
  o.half_x_m = 0.5 * size_x_m;
  o.half_y_m = 0.5 * size_y_m;
  o.cos_h = std::cos(yaw_rad);
  o.sin_h = std::sin(yaw_rad);
  return o;
}

Occupancy::Occupancy(double cell_m) {
  for (Level& level : levels_) {
    level.per_cell = 1.0 / cell_m;
    cell_m *= 2.0;
  }
}

void Occupancy::reserve(std::size_t n) {
  obstacles_.reserve(n);
  levels_[0].links.reserve(3 * n);
  grow(levels_[0], 4 * n);
}

Occupancy::Cells Occupancy::cells_of(const Obstacle& o, double per_cell) noexcept {
  double ex = o.radius_m;
  double ey = o.radius_m;
  if (o.is_box) {
    ex = std::fabs(o.cos_h) * o.half_x_m + std::fabs(o.sin_h) * o.half_y_m;
    ey = std::fabs(o.sin_h) * o.half_x_m + std::fabs(o.cos_h) * o.half_y_m;
  }
  const auto at = [&](double v) { return static_cast<std::int64_t>(std::floor(std::clamp(v * per_cell, -2e9, 2e9))); };
  return {at(o.x_m - ex), at(o.y_m - ey), at(o.x_m + ex), at(o.y_m + ey)};
}

Occupancy::Slot& Occupancy::slot_of(std::vector<Slot>& table, std::uint64_t key) noexcept {
  const std::size_t mask = table.size() - 1;
  std::size_t i = hash_of(key) & mask;
  while (table[i].head != kNone && table[i].key != key) i = (i + 1) & mask;
  return table[i];
}

const Occupancy::Slot& Occupancy::slot_of(const std::vector<Slot>& table, std::uint64_t key) noexcept {
  const std::size_t mask = table.size() - 1;
  std::size_t i = hash_of(key) & mask;
  while (table[i].head != kNone && table[i].key != key) i = (i + 1) & mask;
  return table[i];
}

void Occupancy::grow(Level& level, std::size_t slots) {
  std::size_t size = 64;
  while (size < slots) size *= 2;
  if (size <= level.table.size()) return;
  std::vector<Slot> table(size);
  for (const Slot& slot : level.table) {
    if (slot.head != kNone) slot_of(table, slot.key) = slot;
  }
  level.table = std::move(table);
}

void Occupancy::add(const Obstacle& o) {
  const auto index = static_cast<std::uint32_t>(obstacles_.size());
  obstacles_.push_back(o);
  std::size_t l = 0;
  while (l + 1 < kLevels && cells_of(o, levels_[l].per_cell).count() > kMostCells) ++l;
  levels_used_ = std::max(levels_used_, l + 1);
  Level& level = levels_[l];
  level.members.push_back(index);
  const Cells cells = cells_of(o, level.per_cell);
  for (std::int64_t y = cells.y0; y <= cells.y1; ++y) {
    for (std::int64_t x = cells.x0; x <= cells.x1; ++x) {
      if (2 * (level.used + 1) > level.table.size()) grow(level, 4 * (level.used + 1));
      Slot& slot = slot_of(level.table, key_of(x, y));
      if (slot.head == kNone) ++level.used;
      slot.key = key_of(x, y);
      level.links.push_back({index, slot.head});
      slot.head = static_cast<std::uint32_t>(level.links.size() - 1);
    }
  }
}

const Obstacle* Occupancy::hit(const Obstacle& o) const {
  return hit(o, nullptr);
}

const Obstacle* Occupancy::hit(const Obstacle& o, const Filter& counts) const {
  for (std::size_t l = 0; l < levels_used_; ++l) {
    if (levels_[l].members.empty()) continue;
    if (const Obstacle* found = hit(levels_[l], o, counts); found != nullptr) return found;
  }
  return nullptr;
}

const Obstacle* Occupancy::hit(const Level& level, const Obstacle& o, const Filter& counts) const {
  const Cells cells = cells_of(o, level.per_cell);
  if (cells.count() > static_cast<double>(level.members.size())) {  // something huge among few
    for (const std::uint32_t i : level.members) {
      if (overlap(o, obstacles_[i]) && (!counts || counts(obstacles_[i]))) return &obstacles_[i];
    }
    return nullptr;
  }
  for (std::int64_t y = cells.y0; y <= cells.y1; ++y) {
    for (std::int64_t x = cells.x0; x <= cells.x1; ++x) {
      for (std::uint32_t i = slot_of(level.table, key_of(x, y)).head; i != kNone; i = level.links[i].next) {
        const Obstacle& other = obstacles_[level.links[i].obstacle];
        if (overlap(o, other) && (!counts || counts(other))) return &other;
      }
    }
  }
  return nullptr;
}

}  // namespace tandem::core
