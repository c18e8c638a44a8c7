#include "mixed_reality/fence/intrusion.hpp"

#include <algorithm>
#include <cmath>

#include "core/space/stores.hpp"

namespace tandem::mixed_reality {
namespace {

struct Overlap {
  double depth_m = 0.0, out_x = 0.0, out_y = 0.0;
};

/// Of a disc around (x, y) from another disc's centre, in W.
Overlap with_disc(double x, double y, double radius_m, double other_radius_m) noexcept {
  const double distance_m = std::sqrt(x * x + y * y);
  if (distance_m == 0.0) return {radius_m + other_radius_m, 1.0, 0.0};
  return {radius_m + other_radius_m - distance_m, x / distance_m, y / distance_m};
}

/// Of a disc around (x, y) in the frame of a rectangle.
Overlap with_box(double x, double y, double radius_m, double half_x_m, double half_y_m) noexcept {
  const double near_x = std::clamp(x, -half_x_m, half_x_m);
  const double near_y = std::clamp(y, -half_y_m, half_y_m);
  if (near_x != x || near_y != y) return with_disc(x - near_x, y - near_y, radius_m, 0.0);
  const double to_x_m = half_x_m - std::fabs(x);  // inside: out by the nearest side
  const double to_y_m = half_y_m - std::fabs(y);
  if (to_x_m < to_y_m) return {radius_m + to_x_m, std::copysign(1.0, x), 0.0};
  return {radius_m + to_y_m, 0.0, std::copysign(1.0, y)};
}

Overlap with_object(const core::Object& o, const core::Pose& pose, double radius_m) noexcept {
  const double x = pose.x_m - o.x_m;
  const double y = pose.y_m - o.y_m;
  if (o.kind == core::Object::Kind::Cylinder) return with_disc(x, y, radius_m, o.radius_m);
  const Overlap in_box =
      with_box(o.cos_h * x + o.sin_h * y, o.cos_h * y - o.sin_h * x, radius_m, o.half_x_m, o.half_y_m);
  return {in_box.depth_m, o.cos_h * in_box.out_x - o.sin_h * in_box.out_y,
          o.sin_h * in_box.out_x + o.cos_h * in_box.out_y};
}

}  // namespace

Intrusion intrusion_of(const core::Space& space, core::RobotId robot, const core::Pose& pose) noexcept {
  Intrusion deepest;
  const hal::RobotKind& kind = space.kind(robot);
  const double top_m = pose.z_m + kind.body.height_m;
  const auto take = [&deepest](const Overlap& overlap) {
    if (overlap.depth_m <= deepest.depth_m) return false;
    deepest = {overlap.depth_m, overlap.out_x, overlap.out_y, {}, {}};
    return true;
  };
  const std::vector<core::Object>& objects = space.objects();
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const core::Object& o = objects[i];
    if (!o.alive || o.z_low_m >= top_m || o.z_high_m <= pose.z_m) continue;
    if (take(with_object(o, pose, kind.body.radius_m))) deepest.object = space.object(i);
  }
  // Row by row: this looks at all robots in every tick.
  const core::SpaceStores& stores = space.stores();
  const core::Bodies& b = stores.bodies;
  for (std::size_t row = 0; row < b.size(); ++row) {
    const double x = pose.x_m - b.x_m[row];
    const double y = pose.y_m - b.y_m[row];
    const double within_m = kind.body.radius_m + static_cast<double>(b.radius_m[row]);
    if (x * x + y * y >= within_m * within_m) continue;
    if ((b.flags[row] & (core::kAlive | core::kExternal)) != core::kAlive || b.entity[row] == robot.index) continue;
    const double low_m = stores.base_m(row);
    if (low_m >= top_m || low_m + stores.kind_of_row(row).body.height_m <= pose.z_m) continue;
    if (take(with_disc(x, y, kind.body.radius_m, static_cast<double>(b.radius_m[row]))))
      deepest.robot = {b.entity[row], stores.robots[b.entity[row]].generation};
  }
  return deepest;
}

std::string name_of(const core::Space& space, const Intrusion& intrusion) {
  if (intrusion.robot.valid()) return space.robot_name(intrusion.robot);
  return space.contains(intrusion.object) ? space.objects()[intrusion.object.index].id : "";
}

}  // namespace tandem::mixed_reality
