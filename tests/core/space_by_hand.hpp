// A space put together by hand, for tests that need no world around it.
#pragma once
#include <cmath>
#include <string>
#include <vector>

#include "core/space/stores.hpp"

namespace tandem::core {

/// Adds a robot with the given ports, in a group and a block of its own. It has no controller.
inline RobotId add_robot(Space& space, const hal::DataSheet& sheet, const std::string& id, double x_m, double y_m,
                         double heading_rad, const std::vector<const hal::PortType*>& ports = {}) {
  SpaceStores& s = space.stores();
  const auto entity = static_cast<std::uint32_t>(s.robots.size());
  const std::size_t row = s.bodies.size();
  s.bodies.resize(row + 1);
  s.bodies.radius_m[row] = static_cast<float>(sheet.body_radius_m);
  s.bodies.flags[row] = kAlive;
  s.bodies.entity[row] = entity;

  RobotGroup group;
  group.sheet = &sheet;
  group.ports = ports;
  RobotBlock block;
  block.group = s.groups.size();
  block.first_row = row;
  block.capacity = 1;
  block.used = 1;
  for (const hal::PortType* port : ports) {
    block.ports.push_back(s.slab.take(port->size, port->align));
    port->reset(block.ports.back());
  }
  group.blocks.push_back(s.blocks.size());
  s.groups.push_back(group);
  s.blocks.push_back(std::move(block));
  s.robots.push_back({0, static_cast<std::uint32_t>(s.blocks.size() - 1), 0, entity, -1, true});
  s.living.push_back(entity);
  s.names.push_back({id, -1, entity, 1});
  const RobotId robot{entity, 0};
  space.set_pose(robot, {x_m, y_m, 0.0, std::cos(heading_rad), std::sin(heading_rad)});
  return robot;
}

}  // namespace tandem::core
