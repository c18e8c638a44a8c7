#include "mixed_reality/fence/nearby.hpp"

#include <algorithm>
#include <cmath>

#include "core/space/stores.hpp"

namespace tandem::mixed_reality {
namespace {

/// The point of an object's outline nearest to a place outside of it.
Obstacle nearest_of(const core::Object& o, double x_m, double y_m) noexcept {
  if (o.kind == core::Object::Kind::Cylinder) return {o.x_m, o.y_m, o.radius_m, {}};
  const double x = x_m - o.x_m, y = y_m - o.y_m;
  const double near_x = std::clamp(o.cos_h * x + o.sin_h * y, -o.half_x_m, o.half_x_m);
  const double near_y = std::clamp(o.cos_h * y - o.sin_h * x, -o.half_y_m, o.half_y_m);
  return {o.x_m + o.cos_h * near_x - o.sin_h * near_y, o.y_m + o.sin_h * near_x + o.cos_h * near_y, 0.0, {}};
}

}  // namespace

void find_obstacles(const core::Space& space, core::RobotId robot, const core::Pose& pose, double within_m,
                    std::vector<Obstacle>& out) noexcept {
  out.clear();
  const hal::RobotKind& kind = space.kind(robot);
  const double top_m = pose.z_m + kind.body.height_m;
  const auto take = [&](const Obstacle& obstacle) {
    const double x = obstacle.x_m - pose.x_m, y = obstacle.y_m - pose.y_m;
    const double distance_m = std::sqrt(x * x + y * y) - obstacle.beyond_m;
    if (distance_m <= 0.0 || distance_m - kind.body.radius_m > within_m || out.size() == out.capacity()) return;
    out.push_back(obstacle);
  };
  for (const core::Object& o : space.objects()) {
    if (o.alive && o.z_low_m < top_m && o.z_high_m > pose.z_m) take(nearest_of(o, pose.x_m, pose.y_m));
  }
  const core::SpaceStores& stores = space.stores();
  const core::Bodies& b = stores.bodies;
  for (std::size_t row = 0; row < b.size(); ++row) {
    if ((b.flags[row] & (core::kAlive | core::kExternal)) != core::kAlive || b.entity[row] == robot.index) continue;
    const double x = b.x_m[row] - pose.x_m, y = b.y_m[row] - pose.y_m;
    const double reach_m = within_m + kind.body.radius_m + static_cast<double>(b.radius_m[row]);
    if (x * x + y * y > reach_m * reach_m) continue;
    const double low_m = stores.base_m(row);
    if (low_m >= top_m || low_m + stores.kind_of_row(row).body.height_m <= pose.z_m) continue;
    const core::Velocity v = space.velocity({b.entity[row], stores.robots[b.entity[row]].generation});
    take({b.x_m[row], b.y_m[row], static_cast<double>(b.radius_m[row]), {v.v_m_s[0], v.v_m_s[1]}});
  }
}

}  // namespace tandem::mixed_reality
