#include "app/real/robot_space.hpp"

#include "core/record/scene_json.hpp"
#include "core/space/stores.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/wheels.hpp"
#include "mixed_reality/tracking/odometry.hpp"
#include "mixed_reality/tracking/positioned.hpp"

namespace tandem::app {
namespace {

/// Null: it does not know where it goes.
std::unique_ptr<mixed_reality::PoseSource> poses_of(const ShownRobot& robot, const core::Pose& start) {
  const hal::RobotKind& kind = robot.bridge.robot().kind();
  if (const void* const places = robot.bridge.port(hal::port_type<hal::Positioning>()); places != nullptr)
    return std::make_unique<mixed_reality::Positioned>(start, *static_cast<const hal::Positioning*>(places), kind);
  const void* const wheels =
      kind.drive() == nullptr ? nullptr : robot.bridge.port(hal::port_type<hal::WheelEncoders>());
  if (wheels == nullptr) return nullptr;
  return std::make_unique<mixed_reality::Odometry>(start, *kind.drive(),
                                                   *static_cast<const hal::WheelEncoders*>(wheels));
}

hal::Json arena_json(const core::Scenario& scenario) {
  const core::Vec3 &size = scenario.arena_size, &center = scenario.arena_center;
  return {{"arena",
           {{"min_x", center[0] - 0.5 * size[0]},
            {"min_y", center[1] - 0.5 * size[1]},
            {"max_x", center[0] + 0.5 * size[0]},
            {"max_y", center[1] + 0.5 * size[1]}}}};
}

}  // namespace

RobotSpace::RobotSpace(const ShownRobot& robot)
    : ticks_per_second_(robot.scenario.ticks_per_second),
      start_(core::Pose::at(robot.item.placement.p_W[0], robot.item.placement.p_W[1], robot.item.placement.yaw_rad)) {
  poses_ = poses_of(robot, start_);
  controller_.name = robot.type.name;
  core::SpaceStores& s = space_.stores();
  core::read_scene(arena_json(robot.scenario), s);
  s.bodies.has_motion = true;
  s.bodies.resize(1);
  s.names = {{robot.item.id, -1, 0, 1}};
  s.robots.resize(1);
  s.living = {0};
  core::RobotGroup& group = s.groups.emplace_back();
  group.kind = &robot.bridge.robot().kind();
  group.controller = &controller_;
  group.blocks = {0};
  core::RobotBlock& block = s.blocks.emplace_back();
  block.capacity = block.used = 1;
  for (const bridges::PortView& view : robot.bridge.taken()) {
    group.ports.push_back(view.type);
    block.ports.push_back(static_cast<std::byte*>(view.data));
  }
  block.controllers = static_cast<std::byte*>(robot.controller);
  block.controller_stride = robot.type.size;
  block.constructed[0] = 1;
  for (const auto& [field, member] : robot.published) {
    group.published.push_back(field);
    group.published.back().offset = static_cast<std::size_t>(static_cast<const std::byte*>(member) - block.controllers);
  }
  core::show_robot(s, 0, {0, 0}, true);
  take(-1, 0, false);
}

void RobotSpace::take(hal::Tick tick, hal::TimeNs now, bool drives) {
  core::SpaceStores& s = space_.stores();
  ++s.poses_version;
  s.blocks[0].halted[0] = drives ? std::uint8_t{0} : core::bit(core::HaltOwner::Safety);
  mixed_reality::TrackedPose seen;
  if (poses_ != nullptr && tick >= 0) seen = poses_->latch({hal::time_of_tick(tick, ticks_per_second_), now});
  const core::Pose& at = seen.known ? seen.pose : start_;
  core::show_body(s, 0, {at.x_m, at.y_m, at.z_m, at.heading_rad(), tick}, ticks_per_second_, was_);
  if (seen.q_WB) s.bodies.motion[0].q_WB = *seen.q_WB;
}

}  // namespace tandem::app
