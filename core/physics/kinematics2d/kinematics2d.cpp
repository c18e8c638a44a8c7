#include "core/physics/kinematics2d/kinematics2d.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace tandem::core {
namespace {

constexpr std::size_t kGrain = 1024;
constexpr double kLargestTurn_rad = 0.5;  // of one sub-step: where the series below are exact to 1e-13
constexpr double kLargestHop = 0.5;       // of one sub-step, in body radii: nothing is jumped over
constexpr double kSlack_m = 0.02;         // bodies nearer than this may come to touch within the passes of one tick

/// Rolls rows [begin, end) of one block along their arcs.
void roll(Bodies& b, std::size_t begin, std::size_t end, double wheel_base_m, double dt_s) noexcept {
  double* __restrict x = b.x_m.data();
  double* __restrict y = b.y_m.data();
  double* __restrict c = b.cos_h.data();
  double* __restrict s = b.sin_h.data();
  double* __restrict rolled_left = b.left_m.data();
  double* __restrict rolled_right = b.right_m.data();
  const double* __restrict left = b.left_m_s.data();
  const double* __restrict right = b.right_m_s.data();
  const double per_base = 1.0 / wheel_base_m;
  for (std::size_t i = begin; i < end; ++i) {
    const double l = left[i] * dt_s;
    const double r = right[i] * dt_s;
    rolled_left[i] += l;
    rolled_right[i] += r;
    const double way = 0.5 * (l + r);
    const double d = (r - l) * per_base;  // turned in this step
    const double d2 = d * d;
    // sin(d) / d and (1 - cos(d)) / d
    const double sinc =
        1.0 - d2 * (1.0 / 6 - d2 * (1.0 / 120 - d2 * (1.0 / 5040 - d2 * (1.0 / 362880 - d2 / 39916800.0))));
    const double cosc = d * (0.5 - d2 * (1.0 / 24 - d2 * (1.0 / 720 - d2 * (1.0 / 40320 - d2 / 3628800.0))));
    const double forward = way * sinc;  // chord of the arc, in the frame of the heading before
    const double aside = way * cosc;
    const double c0 = c[i];
    const double s0 = s[i];
    x[i] += c0 * forward - s0 * aside;
    y[i] += s0 * forward + c0 * aside;
    const double sin_d = d * sinc;
    const double cos_d = 1.0 - d * cosc;
    const double c1 = c0 * cos_d - s0 * sin_d;
    const double s1 = s0 * cos_d + c0 * sin_d;
    const double k = 1.5 - 0.5 * (c1 * c1 + s1 * s1);  // one Newton step keeps the heading a unit vector
    c[i] = c1 * k;
    s[i] = s1 * k;
  }
}

/// How many sub-steps keep turns and hops small at the robot's highest speed.
int sub_steps(const hal::DataSheet& sheet, double tick_s) noexcept {
  const double turn = 2.0 * sheet.max_wheel_speed_m_s / sheet.wheel_base_m * tick_s / kLargestTurn_rad;
  const double hop = sheet.max_wheel_speed_m_s * tick_s / (kLargestHop * sheet.body_radius_m);
  return std::max(1, static_cast<int>(std::ceil(std::max(turn, hop))));
}

/// Whether this engine moves the bodies of a region.
bool mine(const SpaceStores& stores, std::uint16_t region) noexcept {
  return region != kNoRegion && !stores.regions[region].listed;
}

/// How far a disc at (x, y) must go to be clear of its region's walls.
std::pair<double, double> out_of_walls(const Region& region, double x, double y, double radius_m) noexcept {
  double px = 0.0;
  double py = 0.0;
  for (std::size_t i = 0; i < region.sides.size(); ++i) {
    const RegionSide& a = region.sides[i];
    if (!a.wall) continue;
    const RegionSide& b = region.sides[(i + 1) % region.sides.size()];
    const double length = std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
    const double inward_x = -(b.y_m - a.y_m) / length;
    const double inward_y = (b.x_m - a.x_m) / length;
    double nx = 0.0;
    double ny = 0.0;
    const double d = distance_to_segment(x + px, y + py, a.x_m, a.y_m, b.x_m, b.y_m, nx, ny);
    if (d >= radius_m) continue;
    const double along_x = x + px - nx;
    const double along_y = y + py - ny;
    const double inside = along_x * inward_x + along_y * inward_y;
    const bool at_end = std::fabs(std::fabs(inside) - d) > 1e-9 * radius_m;
    if (at_end && d > 0.0) {  // round the wall's end
      px += along_x / d * (radius_m - d);
      py += along_y / d * (radius_m - d);
    } else {
      px += inward_x * (radius_m - inside);
      py += inward_y * (radius_m - inside);
    }
  }
  return {px, py};
}

void raise_to(std::atomic<double>& largest, double value) noexcept {
  double seen = largest.load(std::memory_order_relaxed);
  while (value > seen && !largest.compare_exchange_weak(seen, value, std::memory_order_relaxed)) {
  }
}

}  // namespace

void Kinematics2d::advance(const PhysicsContext& context) {
  SpaceStores& stores = context.stores;
  const bool all_mine =
      std::none_of(stores.regions.begin(), stores.regions.end(), [](const Region& r) { return r.listed; });
  context.pool.run(stores.blocks.size(), 4, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const RobotBlock& block = stores.blocks[i];
      const hal::DataSheet& sheet = *stores.groups[block.group].sheet;
      if (sheet.flies) continue;  // never this engine's
      const int steps = sub_steps(sheet, context.tick_s);
      const std::size_t end = block.first_row + block.used;
      std::size_t row = block.first_row;
      while (row < end) {  // runs of rows that are this engine's: with one engine, all of them
        std::size_t next = all_mine ? end : row;
        while (!all_mine && next < end && mine(stores, stores.bodies.region[next])) ++next;
        for (int step = 0; step < steps && next > row; ++step)
          roll(stores.bodies, row, next, sheet.wheel_base_m, context.tick_s / steps);
        row = next;
        while (row < end && !mine(stores, stores.bodies.region[row])) ++row;
      }
    }
  });
}

void Kinematics2d::settle(const PhysicsContext& context) {
  SpaceStores& stores = context.stores;
  BodyIndex& index = stores.body_index;
  const std::size_t n = index.size();
  if (push_.size() < n) {
    push_.resize(n);
    active_.resize(n);
  }
  IndexEntry* entries = index.entries();

  bool walls = false;
  for (const Region& region : stores.regions) {
    for (const RegionSide& side : region.sides) walls = walls || (side.wall && !region.listed);
  }

  const bool heights = !stores.bodies.motion.empty();
  // Where entry i would be pushed to by what it overlaps; also finds out who is near anything at all.
  const auto resolve = [&](std::size_t i, bool first_pass, double largest_radius) noexcept {
    const IndexEntry& e = entries[i];
    double px = 0.0;
    double py = 0.0;
    bool near = false;
    const double r_i = static_cast<double>(e.radius_m);
    index.for_each_near(e.x_m, e.y_m, r_i + largest_radius + kSlack_m, [&](const IndexEntry& o) {
      const double dx = e.x_m - o.x_m;
      const double dy = e.y_m - o.y_m;
      const double touch = r_i + static_cast<double>(o.radius_m);
      const double d2 = dx * dx + dy * dy;
      if (d2 >= (touch + kSlack_m) * (touch + kSlack_m) || &o == &e) return;
      if (heights && o.fixed() && !stores.side_by_side(e.row(), o.row())) return;  // flies above
      near = true;
      if (d2 >= touch * touch) return;
      const double d = std::sqrt(d2);
      const double share = (touch - d) * (o.fixed() ? 1.0 : 0.5);
      if (d > 0.0) {
        px += dx / d * share;
        py += dy / d * share;
      } else {
        px += e.row() < o.row() ? -share : share;  // two on one spot part along x
      }
    });
    // Out of walls last: they do not give way.
    stores.for_each_object_near(e.x_m, e.y_m, [&](const Object& object) {
      double nx = 0.0;
      double ny = 0.0;
      const double gap = signed_distance(object, e.x_m + px, e.y_m + py, nx, ny) - r_i;
      near = near || gap < kSlack_m;
      if (gap >= 0.0) return;
      px -= nx * gap;
      py -= ny * gap;
    });
    if (walls && stores.bodies.region[e.row()] != kNoRegion) {
      const std::uint16_t region = stores.bodies.region[e.row()];
      const auto [wx, wy] = out_of_walls(stores.regions[region], e.x_m + px, e.y_m + py, r_i);
      px += wx;
      py += wy;
      near = true;
    }
    if (first_pass) active_[i] = near ? 1 : 0;
    push_[i] = {px, py};
  };

  double largest_radius = 0.0;
  for (const RobotGroup& group : stores.groups) largest_radius = std::max(largest_radius, group.sheet->body_radius_m);

  double displacement = 0.0;
  for (std::int64_t pass = 0; pass < params_.iterations; ++pass) {
    const bool first_pass = pass == 0;
    context.pool.run(n, kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (entries[i].fixed()) {
          active_[i] = 0;
        } else if (first_pass || active_[i] != 0) {
          resolve(i, first_pass, largest_radius);
        }
      }
    });
    std::atomic<double> longest{0.0};
    context.pool.run(n, 8 * kGrain, [&](std::size_t begin, std::size_t end) {
      double longest_here = 0.0;
      for (std::size_t i = begin; i < end; ++i) {
        if (active_[i] == 0) continue;
        const Push p = push_[i];
        const double length = std::fabs(p.x_m) + std::fabs(p.y_m);
        if (length == 0.0) continue;
        entries[i].x_m += p.x_m;
        entries[i].y_m += p.y_m;
        stores.bodies.x_m[entries[i].row()] = entries[i].x_m;
        stores.bodies.y_m[entries[i].row()] = entries[i].y_m;
        longest_here = std::max(longest_here, length);
      }
      raise_to(longest, longest_here);  // a maximum: the same in any order
    });
    if (longest.load() == 0.0) break;
    displacement += longest.load();
    index.set_displacement(displacement);
  }
}

}  // namespace tandem::core
