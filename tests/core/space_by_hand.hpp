// A space put together by hand, for tests that need no world around it.
#pragma once
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/space/stores.hpp"

namespace tandem::core {

/// Adds a robot with the given ports, in a group and a block of its own. It has no controller.
inline RobotId add_robot(Space& space, const hal::RobotKind& kind, const std::string& id, double x_m, double y_m,
                         double heading_rad, const std::vector<const hal::PortType*>& ports = {}) {
  SpaceStores& s = space.stores();
  const auto entity = static_cast<std::uint32_t>(s.robots.size());
  const std::size_t row = s.bodies.size();
  s.bodies.resize(row + 1);
  s.bodies.radius_m[row] = static_cast<float>(kind.body.radius_m);
  s.bodies.flags[row] = kAlive;
  s.bodies.entity[row] = entity;

  RobotGroup group;
  group.kind = &kind;
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

/// Keeps a row of state for such a robot.
template <class T>
T& add_state(Space& space, RobotId robot) {
  SpaceStores& s = space.stores();
  const RobotEntity& e = s.robots[robot.index];
  KeptColumn kept = keeps<T>();
  kept.arrays = s.columns.of(*kept.type).value();
  kept.arrays->of_block.resize(s.blocks.size());
  kept.arrays->of_block[e.block] = s.slab.take(sizeof(T) * s.blocks[e.block].capacity, alignof(T));
  kept.start(e.block, e.slot);
  s.groups[s.blocks[e.block].group].columns.push_back(std::move(kept));
  return *space.state<T>(robot);
}

/// Adds an immovable box or cylinder; call `index_objects` when all are there.
inline Object& add_object(Space& space, Object::Kind kind, double x_m, double y_m, double z_low_m, double z_high_m) {
  SpaceStores& s = space.stores();
  Object object;
  object.kind = kind;
  object.id = "object" + std::to_string(s.objects.size());
  object.x_m = x_m;
  object.y_m = y_m;
  object.z_low_m = z_low_m;
  object.z_high_m = z_high_m;
  s.objects.push_back(object);
  s.object_motion.emplace_back();
  s.object_region.push_back(kNoRegion);
  ++s.immovables_version;
  return s.objects.back();
}

inline void index_objects(Space& space, double reach_m) {
  SpaceStores& s = space.stores();
  s.static_index.build(s.objects, false, s.min_x_m, s.min_y_m, s.max_x_m, s.max_y_m, reach_m);
}

/// Adds a region with these corners, counter-clockwise; none: everywhere. `walls`: all sides are.
inline Region& add_region(Space& space, const std::vector<std::pair<double, double>>& corners = {},
                          bool walls = false) {
  Region region;
  region.name = "region" + std::to_string(space.stores().regions.size());
  region.listed = true;
  for (const auto& [x_m, y_m] : corners) region.sides.push_back({x_m, y_m, walls, kNoRegion});
  region.close();
  space.stores().regions.push_back(region);
  return space.stores().regions.back();
}

/// Fills `owned` and `mirrored` of every region from where bodies are: each belongs to the first region that contains
/// it, and is mirrored where a region is within `margin_m` of it.
inline void list_robots(Space& space, double margin_m) {
  SpaceStores& s = space.stores();
  for (Region& region : s.regions) {
    region.owned.clear();
    region.mirrored.clear();
  }
  for (std::size_t row = 0; row < s.bodies.size(); ++row) {
    if ((s.bodies.flags[row] & kAlive) == 0) continue;
    bool owned = false;
    for (std::size_t r = 0; r < s.regions.size(); ++r) {
      Region& region = s.regions[r];
      if (!owned && region.contains(s.bodies.x_m[row], s.bodies.y_m[row])) {
        owned = true;
        s.bodies.region[row] = static_cast<std::uint16_t>(r);
        region.owned.push_back(BodyKey::robot(row));
      } else if (region.distance(s.bodies.x_m[row], s.bodies.y_m[row]) <= margin_m) {
        region.mirrored.push_back(BodyKey::robot(row));
      }
    }
  }
}

}  // namespace tandem::core
