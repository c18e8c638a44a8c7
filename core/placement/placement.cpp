#include "core/placement/placement.hpp"

#include <algorithm>
#include <cmath>
#include <deque>

#include "core/placement/occupancy.hpp"
#include "core/random/random.hpp"
#include "hal/angle.hpp"
#include "hal/rounded.hpp"
#include "hal/vector.hpp"

namespace tandem::core {
namespace {

constexpr double kUpright = 1e-6;  // |x| + |y| of a quaternion up to which a body counts as upright

/// The same angle in (-pi, pi].
Obstacle obstacle_of(const ObjectItem& item, std::uint32_t index, const Vec3& p, double yaw_rad) noexcept {
  Obstacle o = item.shape == ShapeKind::Cylinder ? disc_at(p[0], p[1], item.size[0])
                                                 : box_at(p[0], p[1], item.size[0], item.size[1], yaw_rad);
  o.z_low_m = p[2];
  o.z_high_m = p[2] + item.size[2];
  o.item = index;
  return o;
}

/// The rotations about z, then y, then x.
hal::Quaternion turn_of(const Placement& at, double yaw_rad) noexcept {
  hal::Quaternion q = hal::about_z(yaw_rad);
  if (at.pitch_rad != 0.0)
    q = q * hal::Quaternion(hal::cos(0.5 * at.pitch_rad), 0.0, hal::sin(0.5 * at.pitch_rad), 0.0);
  if (at.roll_rad != 0.0) q = q * hal::Quaternion(hal::cos(0.5 * at.roll_rad), hal::sin(0.5 * at.roll_rad), 0.0, 0.0);
  return q;
}

/// Of something tilted: it turns about the middle of its base, as in ARGoS.
Solid solid_of(const ObjectItem& item, const hal::Quaternion& q_WB) noexcept {
  const hal::Matrix3 axes = q_WB.toRotationMatrix();
  const bool round = item.shape == ShapeKind::Cylinder;
  Solid s;
  for (int i = 0; i < 3; ++i) s.axes[static_cast<std::size_t>(i)] = hal::array_of(hal::Vector3(axes.col(i)));
  s.middle_m = hal::array_of(hal::Vector3(hal::vector_of(item.placement.p_W) + 0.5 * item.size[2] * axes.col(2)));
  s.half_m = {round ? item.size[0] : 0.5 * item.size[0], round ? item.size[0] : 0.5 * item.size[1], 0.5 * item.size[2]};
  s.round = round;
  return s;
}

/// Draws the `trial`-th triple for entity `index` of the item that starts on `line`.
Vec3 drawn(const Distribution& d, std::uint64_t seed, std::uint32_t key, Stream stream, std::int64_t index,
           std::uint32_t trial) {
  const auto bits = draw(seed, key, stream, index, trial & 0xFFFFFFU);
  switch (d.method) {
    case Distribution::Method::Constant:
      return d.values;
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
  Placer(const Scenario& scenario, std::uint64_t seed, const SizeOf& size_of, Problems& problems)
      : scenario_(scenario),
        seed_(seed),
        problems_(problems),
        size_(sizes(scenario, size_of)),
        occupancy_(cell_size()) {}

  Placements run() {
    robots_by_item_.resize(scenario_.robots.size());
    occupancy_.reserve(expected());
    place_fixed();
    place_distributed();
    return collected();
  }

 private:
  /// What to place by chance: one item of one kind.
  struct Task {
    enum class Kind { Object, Light, Robot } kind;
    std::uint32_t item;
    const Distribute* distribute;
  };

  /// A drawn place: taken, or why not.
  struct Attempt {
    bool placed = false;
    const Obstacle* other = nullptr;  // null and not placed: outside the arena
  };

  static std::vector<BodySize> sizes(const Scenario& scenario, const SizeOf& size_of) {
    std::vector<BodySize> out;
    for (const RobotItem& r : scenario.robots) out.push_back(size_of(r.kind));
    return out;
  }

  double cell_size() const {
    double cell_m = 0.02;
    for (const BodySize& size : size_) cell_m = std::max(cell_m, 2.0 * size.radius_m);
    return cell_m;
  }

  /// How many bodies there will be, but not more than fit.
  std::size_t expected() const {
    double n = static_cast<double>(scenario_.objects.size());
    for (const RobotItem& r : scenario_.robots) n += r.distribute ? static_cast<double>(r.distribute->quantity) : 1.0;
    const double fit = scenario_.arena_size[0] * scenario_.arena_size[1] / (cell_size() * cell_size());
    return static_cast<std::size_t>(std::clamp(std::min(n, fit), 0.0, 1e7));
  }

  void problem(int line, std::string message) {
    problems_.push_back({scenario_.file, line, std::move(message), false});
  }

  bool inside(const Vec3& p) const {
    return std::fabs(p[0] - scenario_.arena_center[0]) <= 0.5 * scenario_.arena_size[0] &&
           std::fabs(p[1] - scenario_.arena_center[1]) <= 0.5 * scenario_.arena_size[1];
  }

  static std::string text_of(const Vec3& p) { return hal::place_text(p[0], p[1]); }

  std::string name_of(const Obstacle& o) const {
    const std::string& id = o.is_robot ? scenario_.robots[o.item].id : scenario_.objects[o.item].id;
    const int line = o.is_robot ? scenario_.robots[o.item].line : scenario_.objects[o.item].line;
    const bool many =
        (o.is_robot ? scenario_.robots[o.item].distribute : scenario_.objects[o.item].distribute).has_value();
    const char* kind = o.is_robot ? "robot" : scenario_.objects[o.item].shape == ShapeKind::Box ? "box" : "cylinder";
    return std::string(many ? "a " : "") + kind + " '" + id + (many ? "…" : "") + "'" +
           (line > 0 ? " of line " + std::to_string(line) : "");
  }

  // --- what has a place of its own ---

  void place_fixed() {
    // What stands still may overlap its like: walls meet at corners.
    for (const bool movable : {false, true}) {
      for (std::uint32_t i = 0; i < scenario_.objects.size(); ++i) {
        const ObjectItem& item = scenario_.objects[i];
        if (!item.distribute && item.movable == movable) place_fixed_object(i, item);
      }
    }
    for (std::uint32_t i = 0; i < scenario_.lights.size(); ++i) {
      if (!scenario_.lights[i].distribute) lights_.push_back({scenario_.lights[i].p_W, i, -1});
    }
    for (std::uint32_t i = 0; i < scenario_.robots.size(); ++i) {
      if (!scenario_.robots[i].distribute && size_[i].radius_m >= 0.0) place_fixed_robot(i, scenario_.robots[i]);
    }
  }

  void place_fixed_object(std::uint32_t i, const ObjectItem& item) {
    const double yaw = hal::wrapped(item.placement.yaw_rad);
    const hal::Quaternion q_WB = turn_of(item.placement, yaw);
    Obstacle o = obstacle_of(item, i, item.placement.p_W, yaw);
    if (std::fabs(q_WB.x()) + std::fabs(q_WB.y()) > kUpright) {
      o = bounds_of(leaning_.emplace_back(solid_of(item, q_WB)));
      o.item = i;
    }
    if (item.movable && !inside(item.placement.p_W))
      return problem(item.line, name_of(o) + " is at " + text_of(item.placement.p_W) + ", outside the arena");
    const Obstacle* other = item.movable ? occupancy_.hit(o) : nullptr;
    if (other != nullptr) problem(item.line, name_of(o) + " overlaps " + name_of(*other) + "; move one of them");
    occupancy_.add(o);
    objects_.push_back({item.placement.p_W, yaw, q_WB, i, -1});
  }

  Obstacle robot_at(const Vec3& p, std::uint32_t i) const {
    Obstacle o = disc_at(p[0], p[1], size_[i].radius_m);
    o.is_robot = true;
    o.flies = size_[i].flies;
    o.z_low_m = p[2];
    o.z_high_m = p[2] + size_[i].height_m;
    o.item = i;
    return o;
  }

  void place_fixed_robot(std::uint32_t i, const RobotItem& item) {
    const Vec3& p = item.placement.p_W;
    const Obstacle o = robot_at(p, i);
    if (!inside(p)) {
      problem(item.line, "robot '" + item.id + "' is at " + text_of(p) + ", outside the arena");
    } else if (p[2] < 0.0) {
      problem(item.line, "robot '" + item.id + "' is at a height of " + hal::rounded(p[2]) +
                             " m, below the ground; <body position> is where its base stands");
    } else if (const Obstacle* other = occupancy_.hit(o); other != nullptr) {
      problem(item.line, "robot '" + item.id + "' overlaps " + name_of(*other) + "; move one of them");
    } else {
      occupancy_.add(o);
      robots_by_item_[i].push_back({p[0], p[1], p[2], hal::wrapped(item.placement.yaw_rad), i, -1});
    }
  }

  // --- what is distributed ---

  std::vector<Task> tasks() const {
    std::vector<Task> out;
    const auto add = [&](const auto& items, typename Task::Kind kind) {
      for (std::uint32_t i = 0; i < items.size(); ++i) {
        if (items[i].distribute) out.push_back({kind, i, &*items[i].distribute});
      }
    };
    add(scenario_.objects, Task::Kind::Object);
    add(scenario_.lights, Task::Kind::Light);
    add(scenario_.robots, Task::Kind::Robot);
    std::stable_sort(out.begin(), out.end(),
                     [](const Task& a, const Task& b) { return a.distribute->order < b.distribute->order; });
    return out;
  }

  void place_distributed() {
    std::uint32_t key = 0;
    for (const Task& task : tasks()) {
      const std::uint32_t i = task.item;
      if (task.kind == Task::Kind::Light) {
        distribute(task, key, "light", scenario_.lights[i].id, [&](std::int64_t number, const Vec3& p, double) {
          lights_.push_back({p, i, number});
          return Attempt{true};
        });
      } else if (task.kind == Task::Kind::Object) {
        const ObjectItem& item = scenario_.objects[i];
        distribute(task, key, item.shape == ShapeKind::Box ? "box" : "cylinder", item.id,
                   [&](std::int64_t number, const Vec3& p, double yaw) {
                     const Attempt attempt = occupy(p, obstacle_of(item, i, p, yaw));
                     if (attempt.placed) objects_.push_back({p, yaw, hal::about_z(yaw), i, number});
                     return attempt;
                   });
      } else if (size_[i].radius_m >= 0.0) {
        robots_by_item_[i].reserve(std::min(static_cast<std::size_t>(task.distribute->quantity), expected()));
        distribute(task, key, "robot", scenario_.robots[i].id, [&](std::int64_t number, const Vec3& p, double yaw) {
          const Attempt attempt = occupy(p, robot_at(p, i));
          if (attempt.placed) robots_by_item_[i].push_back({p[0], p[1], p[2], yaw, i, number});
          return attempt;
        });
      }
      ++key;
    }
  }

  Attempt occupy(const Vec3& p, const Obstacle& o) {
    if (!inside(p)) return {};
    if (const Obstacle* other = occupancy_.hit(o); other != nullptr) return {false, other};
    occupancy_.add(o);
    return {true};
  }

  template <class Try>
  void distribute(const Task& task, std::uint32_t key, const std::string& what, const std::string& id,
                  Try&& try_place) {
    const Distribute& d = *task.distribute;
    const bool chance =
        d.position.method == Distribution::Method::Uniform || d.position.method == Distribution::Method::Gaussian;
    for (std::int64_t n = 0; n < d.quantity; ++n) {
      Attempt attempt;
      Vec3 p{};
      const std::int64_t trials = chance ? d.max_trials : 1;
      for (std::int64_t trial = 0; trial < trials && !attempt.placed; ++trial) {
        const auto t = static_cast<std::uint32_t>(trial);
        p = drawn(d.position, seed_, key, Stream::Placement, n, t);
        attempt =
            try_place(d.base_num + n, p, hal::wrapped(drawn(d.orientation, seed_, key, Stream::Orientation, n, t)[0]));
      }
      if (attempt.placed) continue;
      const std::string last =
          text_of(p) + (attempt.other != nullptr ? " is taken by " + name_of(*attempt.other) : " is outside the arena");
      return problem(d.line, "placed " + std::to_string(n) + " of " + std::to_string(d.quantity) + " of " + what +
                                 " '" + id + "': " +
                                 (chance ? "no free place in " + std::to_string(d.max_trials) + " trials (" + last +
                                               "); give more room, fewer of them, or more max_trials"
                                         : last));
    }
  }

  Placements collected() {
    Placements out;
    std::size_t robots = 0;
    for (const auto& part : robots_by_item_) robots += part.size();
    out.robots.reserve(robots);
    for (auto& part : robots_by_item_) out.robots.insert(out.robots.end(), part.begin(), part.end());
    const auto by_item = [](const auto& a, const auto& b) { return a.item < b.item; };
    std::stable_sort(objects_.begin(), objects_.end(), by_item);
    std::stable_sort(lights_.begin(), lights_.end(), by_item);
    out.objects = std::move(objects_);
    out.lights = std::move(lights_);
    return out;
  }

  const Scenario& scenario_;
  std::uint64_t seed_;
  Problems& problems_;
  std::vector<BodySize> size_;  // by item of Scenario::robots
  std::deque<Solid> leaning_;   // what is tilted; the occupancy points to them
  Occupancy occupancy_;
  std::vector<std::vector<PlacedRobot>> robots_by_item_;
  std::vector<PlacedObject> objects_;
  std::vector<PlacedLight> lights_;
};

}  // namespace

Placements place(const Scenario& scenario, std::uint64_t seed, const SizeOf& size_of, Problems& problems) {
  return Placer(scenario, seed, size_of, problems).run();
}

}  // namespace tandem::core
