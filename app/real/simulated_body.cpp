#include "app/real/simulated_body.hpp"

#include <algorithm>
#include <cstring>

#include "mixed_reality/time/monotonic.hpp"

namespace tandem::app {
namespace {

/// Of a kind whose real robots are reached as those of the emulator's kind, with all ports that its firmware needs.
bool fits(const core::World& world, core::RobotId robot, const bridges::EmulatorType& emulator) {
  const core::Space& space = world.space();
  if (core::bridged_as(world.scenario(), space.kind(robot).name) != emulator.kind) return false;
  const auto needed = emulator.needs();
  return std::ranges::all_of(needed, [&](const hal::PortType* type) { return space.port(robot, *type) != nullptr; });
}

}  // namespace

hal::Result<core::RobotId> SimulatedBody::find(const core::World& world, const bridges::EmulatorType& emulator,
                                               const std::string& id) {
  const core::Space& space = world.space();
  const std::string advice = "give it the controller " + std::string(emulator.puppet);
  if (!id.empty()) {
    const core::RobotId robot = space.find_robot(id);
    if (!robot.valid()) return hal::Error{"the arena has no robot '" + id + "'"};
    if (fits(world, robot, emulator)) return robot;
    return hal::Error{"robot '" + id + "' is no " + std::string(emulator.kind) +
                      ", or its controller does not take what the emulated firmware needs; " + advice};
  }
  for (std::size_t i = 0; i < space.robot_count(); ++i) {
    if (fits(world, space.robot(i), emulator)) return space.robot(i);
  }
  return hal::Error{"the arena has no " + std::string(emulator.kind) +
                    " whose controller takes what the emulated firmware needs; " + advice};
}

SimulatedBody::SimulatedBody(const core::World& world, core::RobotId robot, bridges::SharedPorts& ports)
    : robot_(robot), ports_(ports) {
  for (const hal::PortType* type : world.space().ports(robot)) {
    if (ports.with([&](const bridges::PortBank& bank) { return bank.find(*type) != nullptr; })) types_.push_back(type);
  }
}

void SimulatedBody::after_sense(core::World& world) {
  const core::Space& space = world.space();
  if (!space.contains(robot_)) return;  // a hook took it away: its firmware goes on without a body
  const core::Pose pose = space.pose(robot_);
  ports_.set_pose({pose.x_m, pose.y_m, pose.heading_rad(), mixed_reality::MonotonicTime().now_ns()});
  ports_.tell([&](const bridges::PortBank& bank) {
    for (const hal::PortType* type : types_) {
      if (type->role == hal::Role::Sensor) std::memcpy(bank.find(*type), space.port(robot_, *type), type->size);
    }
  });
}

void SimulatedBody::after_filter(core::World& world) {
  core::Space& space = world.space();
  if (!space.contains(robot_)) return;
  ports_.with([&](const bridges::PortBank& bank) {
    for (const hal::PortType* type : types_) {
      if (type->role == hal::Role::Actuator) std::memcpy(space.port(robot_, *type), bank.find(*type), type->size);
    }
  });
}

}  // namespace tandem::app
