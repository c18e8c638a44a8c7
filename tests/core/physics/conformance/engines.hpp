// What all kinds of physics engine promise alike, with the bars of each sort, and how scenes are watched.
#pragma once
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <string>
#include <vector>

#include "core/sim/engine_factory.hpp"
#include "core/space/stores.hpp"
#include "hal/robot/epuck.hpp"
#include "tests/core/scenes.hpp"

namespace tandem::core {

inline const double kRobotRadius_m = hal::epuck::kind().body.radius_m;
inline const double kWheelBase_m = hal::epuck::kind().drive()->wheel_base_m;

/// Kinds that move objects by forces.
inline std::vector<std::string> kinds_with_forces() {
  std::vector<std::string> kinds = test::engine_kinds();
  std::erase_if(kinds, [](const std::string& kind) { return !test::engine_traits(kind).forces; });
  return kinds;
}

/// How deep a body at rest may sit in another, in m: engines of three dimensions may give a little more.
inline double depth_bar_m(const std::string& kind) {
  return test::engine_traits(kind).plane ? 1e-3 : 2e-3;
}

/// One engine kind a test, by name.
class EveryEngine : public testing::TestWithParam<std::string> {
 protected:
  /// An arena of `size_m` squared that this engine looks after.
  Scene scene(double size_m = 4.0, const std::string& controller = "drive") const {
    Scene s(size_m, controller);
    s.engine(GetParam());
    return s;
  }
  double depth_m() const { return depth_bar_m(GetParam()); }
};

inline std::string name_of_kind(const testing::TestParamInfo<std::string>& info) {
  return info.param;
}

inline Pose pose_of(const MadeWorld& world, const std::string& id) {
  const Space& space = world.world->space();
  return space.pose(space.find_robot(id));
}

inline void set_halted(const MadeWorld& world, const std::string& id) {
  Space& space = world.world->space();
  space.set_halted(space.find_robot(id), true);
}

inline void steps(const MadeWorld& world, int count) {
  for (int i = 0; i < count; ++i) world.world->step();
}

/// The difference of two angles in (-pi, pi].
inline double turned_rad(double from_rad, double to_rad) {
  return std::remainder(to_rad - from_rad, 2.0 * std::numbers::pi);
}

/// How deep the rims of two robots are in each other, in m; negative: the gap between them.
inline double overlap_m(const Pose& a, const Pose& b, double radius_m = kRobotRadius_m) {
  return 2.0 * radius_m - std::hypot(a.x_m - b.x_m, a.y_m - b.y_m);
}

/// Pairs of robots that touch, and how deep they overlap.
struct Crowd {
  std::size_t pairs = 0;
  double deepest_m = 0.0;
  double sum_m = 0.0;  ///< of the overlaps of all pairs
};

/// Pairs count as touching when their rims are nearer than `near_m`.
inline Crowd crowd_of(const Space& space, double near_m, double radius_m = kRobotRadius_m) {
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < space.robot_count(); ++i) poses.push_back(space.pose(space.robot(i)));
  Crowd crowd;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (std::fabs(poses[i].x_m - poses[k].x_m) > 2 * radius_m + near_m) continue;
      const double overlap = overlap_m(poses[i], poses[k], radius_m);
      if (overlap < -near_m) continue;
      ++crowd.pairs;
      crowd.deepest_m = std::max(crowd.deepest_m, overlap);
      crowd.sum_m += std::max(0.0, overlap);
    }
  }
  return crowd;
}

}  // namespace tandem::core
