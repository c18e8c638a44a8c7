#include "core/placement/placement.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "core/random/random.hpp"

namespace tandem::core {
namespace {

/// What is in the way: a disc, or a rectangle with a heading.
struct Obstacle {
  double x_m, y_m;
  double radius_m;            // of the disc, or of the circle around the rectangle
  bool is_box = false;
  double half_x_m = 0.0, half_y_m = 0.0;
  double cos_h = 1.0, sin_h = 0.0;
  std::uint32_t robot = 0;    // index + 1 of the placed robot, 0: an object
  std::uint32_t item = 0;
};

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

bool overlap(const Obstacle& a, const Obstacle& b) {
  const double far = a.radius_m + b.radius_m;
  const double dx = a.x_m - b.x_m;
  const double dy = a.y_m - b.y_m;
  if (dx * dx + dy * dy >= far * far) return false;
  if (a.is_box && b.is_box) return boxes_overlap(a, b);
  if (a.is_box) return point_to_box(a, b.x_m, b.y_m) < b.radius_m;
  if (b.is_box) return point_to_box(b, a.x_m, a.y_m) < a.radius_m;
  return true;
}

/// Obstacles by cell of a hashed grid; a large one is listed in every cell that it touches.
class Occupancy {
 public:
  explicit Occupancy(double cell_m) : per_cell_(1.0 / cell_m) {}

  void reserve(std::size_t n) {
    obstacles_.reserve(n);
    cells_.reserve(2 * n);
  }

  const Obstacle* hit(const Obstacle& o) const {
    const Obstacle* found = nullptr;
    for_each_cell(o, [&](std::uint64_t key) {
      const auto cell = cells_.find(key);
      for (std::uint32_t i = cell == cells_.end() ? kNone : cell->second; i != kNone && found == nullptr; i = links_[i].next) {
        const Obstacle& other = obstacles_[links_[i].obstacle];
        if (overlap(o, other)) found = &other;
      }
      return found == nullptr;
    });
    return found;
  }

  void add(const Obstacle& o) {
    obstacles_.push_back(o);
    const auto index = static_cast<std::uint32_t>(obstacles_.size() - 1);
    for_each_cell(o, [&](std::uint64_t key) {
      const auto [cell, fresh] = cells_.try_emplace(key, kNone);
      links_.push_back({index, cell->second});
      cell->second = static_cast<std::uint32_t>(links_.size() - 1);
      return true;
    });
  }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;
  struct Link {
    std::uint32_t obstacle;
    std::uint32_t next;
  };

  template <class Visit>
  void for_each_cell(const Obstacle& o, Visit&& visit) const {
    double ex = o.radius_m;
    double ey = o.radius_m;
    if (o.is_box) {
      ex = std::fabs(o.cos_h) * o.half_x_m + std::fabs(o.sin_h) * o.half_y_m;
      ey = std::fabs(o.sin_h) * o.half_x_m + std::fabs(o.cos_h) * o.half_y_m;
    }
    const auto at = [&](double v) { return static_cast<std::int64_t>(std::floor(std::clamp(v * per_cell_, -1e9, 1e9))); };
    const std::int64_t x1 = at(o.x_m + ex);
    const std::int64_t y1 = at(o.y_m + ey);
    for (std::int64_t y = at(o.y_m - ey); y <= y1; ++y) {
      for (std::int64_t x = at(o.x_m - ex); x <= x1; ++x) {
        const std::uint64_t key = (static_cast<std::uint64_t>(y) << 32) ^ (static_cast<std::uint64_t>(x) & 0xFFFFFFFFU);
        if (!visit(key)) return;
      }
    }
  }

  double per_cell_;
  std::vector<Obstacle> obstacles_;
  std::vector<Link> links_;
  std::unordered_map<std::uint64_t, std::uint32_t> cells_;
};

Obstacle disc(double x, double y, double radius) { return {x, y, radius, false, 0.0, 0.0, 1.0, 0.0, 0, 0}; }

Obstacle obstacle_of(const ObjectItem& item, const Vec3& p, double yaw) {
  if (item.shape == ShapeKind::Cylinder) return disc(p[0], p[1], item.size[0]);
  const double hx = 0.5 * item.size[0];
  const double hy = 0.5 * item.size[1];
  return {p[0], p[1], std::hypot(hx, hy), true, hx, hy, std::cos(yaw), std::sin(yaw), 0, 0};
}

/// Draws the `trial`-th triple for entity `index` of the item that starts on `line`.
Vec3 drawn(const Distribution& d, std::uint64_t seed, std::uint32_t key, Stream stream, std::int64_t index, std::uint32_t trial) {
  const auto bits = draw(seed, key, stream, index, trial & 0xFFFFFFU);
  switch (d.method) {
    case Distribution::Method::Constant: return d.values;
    case Distribution::Method::Uniform: {
      Vec3 v{};
      for (std::size_t i = 0; i < 3; ++i) v[i] = d.min[i] + to_unit(bits[i]) * (d.max[i] - d.min[i]);
      return v;
    }
    case Distribution::Method::Gaussian: {
      const auto xy = to_normal(bits[0], bits[1]);
      const auto z = to_normal(bits[2], bits[3]);
      return {d.mean[0] + d.std_dev[0] * xy[0], d.mean[1] + d.std_dev[1] * xy[1], d.mean[2] + d.std_dev[2] * z[0]};
    }
    case Distribution::Method::Grid: {
      // West to east, then south to north, then up; centred.
      const std::int64_t nx = d.layout[0];
      const std::int64_t ny = d.layout[1];
      const std::array<std::int64_t, 3> at{index % nx, index / nx % ny, index / (nx * ny)};
      Vec3 v{};
      for (std::size_t i = 0; i < 3; ++i) {
        v[i] = d.center[i] + (static_cast<double>(at[i]) - 0.5 * (d.layout[i] - 1)) * d.distances[i];
      }
      return v;
    }
  }
  return {};
}

class Placer {
 public:
  Placer(const Scenario& scenario, std::uint64_t seed, RadiusOf radius_of, Problems& problems)
      : scenario_(scenario), seed_(seed), radius_of_(radius_of), problems_(problems), occupancy_(cell_size()) {}

  Placements run() {
    robots_by_item_.resize(scenario_.robots.size());
    occupancy_.reserve(total());
    place_fixed();
    place_distributed();
    Placements out;
    std::size_t robots = 0;
    for (const auto& part : robots_by_item_) robots += part.size();
    out.robots.reserve(robots);
    for (auto& part : robots_by_item_) out.robots.insert(out.robots.end(), part.begin(), part.end());
    std::stable_sort(objects_.begin(), objects_.end(), [](const auto& a, const auto& b) { return a.item < b.item; });
    out.objects = std::move(objects_);
    out.lights = std::move(lights_);
    return out;
  }

 private:
  double cell_size() const {
    double cell = 0.02;
    for (const RobotItem& r : scenario_.robots) cell = std::max(cell, 2.0 * radius_of_(r.kind));
    // A grid finer than the bodies need would list a long wall in millions of cells.
    return std::max(cell, std::max(scenario_.arena_size[0], scenario_.arena_size[1]) / 20'000.0);
  }

  std::size_t total() const {
    std::size_t n = scenario_.objects.size();
    for (const RobotItem& r : scenario_.robots) n += r.distribute ? static_cast<std::size_t>(r.distribute->quantity) : 1;
    return n;
  }

  void problem(int line, std::string message) { problems_.push_back({scenario_.file, line, std::move(message), false}); }

  bool inside(double x, double y) const {
    return std::fabs(x - scenario_.arena_center[0]) <= 0.5 * scenario_.arena_size[0] &&
           std::fabs(y - scenario_.arena_center[1]) <= 0.5 * scenario_.arena_size[1];
  }

  std::string name_of(const Obstacle& o) const {
    return o.robot != 0 ? "robot '" + scenario_.robots[o.item].id + "'" : "object '" + scenario_.objects[o.item].id + "'";
  }

  void place_fixed() {
    for (std::size_t i = 0; i < scenario_.objects.size(); ++i) {
      const ObjectItem& item = scenario_.objects[i];
      if (item.distribute) continue;
      // Immovable things may overlap one another: walls meet at corners.
      Obstacle o = obstacle_of(item, item.placement.p_W, item.placement.yaw_rad);
      o.item = static_cast<std::uint32_t>(i);
      occupancy_.add(o);
      objects_.push_back({item.placement.p_W, item.placement.yaw_rad, static_cast<std::uint32_t>(i), -1});
    }
    for (std::size_t i = 0; i < scenario_.lights.size(); ++i) {
      if (!scenario_.lights[i].distribute) lights_.push_back({scenario_.lights[i].p_W, static_cast<std::uint32_t>(i), -1});
    }
    for (std::size_t i = 0; i < scenario_.robots.size(); ++i) {
      const RobotItem& item = scenario_.robots[i];
      if (item.distribute) continue;
      const Vec3& p = item.placement.p_W;
      const double radius = radius_of_(item.kind);
      if (radius < 0.0) continue;
      if (!inside(p[0], p[1])) {
        problem(item.line, "robot '" + item.id + "' is at (" + hal::format_number(p[0]) + ", " + hal::format_number(p[1]) +
                               "), outside the arena");
        continue;
      }
      Obstacle o = disc(p[0], p[1], radius);
      o.item = static_cast<std::uint32_t>(i);
      o.robot = 1;
      if (const Obstacle* other = occupancy_.hit(o); other != nullptr) {
        problem(item.line, "robot '" + item.id + "' overlaps " + name_of(*other) + "; move one of them");
        continue;
      }
      occupancy_.add(o);
      robots_by_item_[i].push_back({p[0], p[1], p[2], item.placement.yaw_rad, static_cast<std::uint32_t>(i), -1});
    }
  }

  void place_distributed() {
    for (std::size_t i = 0; i < scenario_.objects.size(); ++i) {
      const ObjectItem& item = scenario_.objects[i];
      if (!item.distribute) continue;
      distribute(*item.distribute, "object", item.id, [&](std::int64_t number, const Vec3& p, double yaw) {
        Obstacle o = obstacle_of(item, p, yaw);
        o.item = static_cast<std::uint32_t>(i);
        if (!inside(p[0], p[1]) || occupancy_.hit(o) != nullptr) return false;
        occupancy_.add(o);
        objects_.push_back({p, yaw, static_cast<std::uint32_t>(i), number});
        return true;
      });
    }
    for (std::size_t i = 0; i < scenario_.lights.size(); ++i) {
      const LightItem& item = scenario_.lights[i];
      if (!item.distribute) continue;
      distribute(*item.distribute, "light", item.id, [&](std::int64_t number, const Vec3& p, double) {
        lights_.push_back({p, static_cast<std::uint32_t>(i), number});
        return true;
      });
    }
    for (std::size_t i = 0; i < scenario_.robots.size(); ++i) {
      const RobotItem& item = scenario_.robots[i];
      const double radius = radius_of_(item.kind);
      if (!item.distribute || radius < 0.0) continue;
      robots_by_item_[i].reserve(static_cast<std::size_t>(item.distribute->quantity));
      distribute(*item.distribute, "robot", item.id, [&](std::int64_t number, const Vec3& p, double yaw) {
        Obstacle o = disc(p[0], p[1], radius);
        o.item = static_cast<std::uint32_t>(i);
        o.robot = 1;
        if (!inside(p[0], p[1]) || occupancy_.hit(o) != nullptr) return false;
        occupancy_.add(o);
        robots_by_item_[i].push_back({p[0], p[1], p[2], yaw, static_cast<std::uint32_t>(i), number});
        return true;
      });
    }
  }

  template <class Try>
  void distribute(const Distribute& d, const std::string& what, const std::string& id, Try&& try_place) {
    const std::uint32_t key = items_distributed_++;
    for (std::int64_t n = 0; n < d.quantity; ++n) {
      bool placed = false;
      const bool chance = d.position.method == Distribution::Method::Uniform || d.position.method == Distribution::Method::Gaussian;
      const std::int64_t trials = chance ? d.max_trials : 1;
      for (std::int64_t trial = 0; trial < trials && !placed; ++trial) {
        const auto t = static_cast<std::uint32_t>(trial);
        placed = try_place(d.base_num + n, drawn(d.position, seed_, key, Stream::Placement, n, t),
                           drawn(d.orientation, seed_, key, Stream::Orientation, n, t)[0]);
      }
      if (placed) continue;
      problem(d.line, "placed " + std::to_string(n) + " of " + std::to_string(d.quantity) + " of " + what + " '" + id + "': " +
                          (chance ? "no free place in " + std::to_string(d.max_trials) +
                                        " trials. Give more room, fewer of them, or more max_trials."
                                  : "the next place is taken or outside the arena"));
      return;
    }
  }

  const Scenario& scenario_;
  std::uint64_t seed_;
  RadiusOf radius_of_;
  Problems& problems_;
  Occupancy occupancy_;
  std::vector<std::vector<PlacedRobot>> robots_by_item_;
  std::vector<PlacedObject> objects_;
  std::vector<PlacedLight> lights_;
  std::uint32_t items_distributed_ = 0;
};

}  // namespace

Placements place(const Scenario& scenario, std::uint64_t seed, RadiusOf radius_of, Problems& problems) {
  return Placer(scenario, seed, radius_of, problems).run();
}

}  // namespace tandem::core
