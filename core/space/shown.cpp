#include "core/space/shown.hpp"

#include <cmath>

#include "hal/angle.hpp"

namespace tandem::core {
namespace {

constexpr double kMostBetween_s = 1.0;  // of two places that tell a velocity

}  // namespace

void show_robot(SpaceStores& s, std::uint32_t robot, Slot slot, bool real) {
  const RobotBlock& block = s.blocks[slot.block];
  const std::size_t row = block.first_row + slot.slot;
  s.robots[robot] = {0, slot.block, slot.slot, robot, -1, true};
  s.bodies.entity[row] = robot;
  s.bodies.radius_m[row] = static_cast<float>(s.groups[block.group].kind->body.radius_m);
  s.bodies.flags[row] = real ? kAlive | kExternal : kAlive;
  s.bodies.region[row] = 0;
  s.twins = s.twins || real;
}

void show_body(SpaceStores& s, std::size_t row, const SeenPose& now, std::int64_t ticks_per_second, SeenPose& was) {
  Bodies& b = s.bodies;
  b.x_m[row] = now.x_m;
  b.y_m[row] = now.y_m;
  b.cos_h[row] = std::cos(now.heading_rad);
  b.sin_h[row] = std::sin(now.heading_rad);
  Motion& motion = b.motion[row];
  motion = {now.z_m, {std::cos(0.5 * now.heading_rad), 0.0, 0.0, std::sin(0.5 * now.heading_rad)}, {}, {}};
  const double passed_s = static_cast<double>(now.tick - was.tick) / static_cast<double>(ticks_per_second);
  if (was.tick != SeenPose::kNever && passed_s > 0.0 && passed_s <= kMostBetween_s) {
    motion.v_m_s = {(now.x_m - was.x_m) / passed_s, (now.y_m - was.y_m) / passed_s, (now.z_m - was.z_m) / passed_s};
    motion.w_rad_s = {0.0, 0.0, hal::turn_between(was.heading_rad, now.heading_rad) / passed_s};
  }
  was = now;
}

}  // namespace tandem::core
