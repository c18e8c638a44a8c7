// Makes robots: gives each its row, its ports and its controller.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "core/device/device.hpp"
#include "core/scenario/scenario.hpp"
#include "core/space/stores.hpp"
#include "hal/plugin_loader.hpp"

namespace tandem::core {

/// One robot to be made.
struct RobotRequest {
  std::uint32_t item = 0;    ///< of Scenario::robots
  std::uint32_t entity = 0;  ///< index of its id
  double x_m = 0.0, y_m = 0.0, z_m = 0.0;
  double yaw_rad = 0.0;
};

/// Devices of one block, in the order of the group's ports.
struct BlockDevices {
  std::vector<std::unique_ptr<Sensor>> sensors;      ///< null where the port is an actuator
  std::vector<std::unique_ptr<Actuator>> actuators;  ///< null where the port is a sensor
};

/// What the factory made beyond the stores.
struct RobotDevices {
  std::vector<BlockDevices> blocks;  ///< parallel to SpaceStores::blocks
};

/// The data sheet of a kind of robot, or null. The kinds that this build knows: `robot_kinds()`.
const hal::DataSheet* data_sheet_of(std::string_view kind);
std::vector<std::string> robot_kinds();

/// Fills `stores` (bodies, groups, blocks, robots) and returns the devices. Every problem goes to `problems` with the
/// line of the robot or controller that it is about. Robots of a group get rows in the order of a space-filling curve.
RobotDevices make_robots(const Scenario& scenario, const std::vector<RobotRequest>& requests, std::uint64_t seed,
                         hal::PluginLoader& loader, SpaceStores& stores, Problems& problems);

/// Ends the life of every controller. Before the loader closes its plug-ins.
void destroy_controllers(SpaceStores& stores) noexcept;

}  // namespace tandem::core
