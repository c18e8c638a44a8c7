// Connects an emulated firmware to the body of a simulated robot: their ports are one.
#pragma once
#include <string>
#include <vector>

#include "bridges/emulation/emulator_type.hpp"
#include "core/sim/external.hpp"
#include "core/sim/world.hpp"
#include "hal/result.hpp"

namespace tandem::app {

/// Between sensing and control of every tick, hands a robot's readings to the firmware; after control, writes what the
/// firmware commands over what the robot's controller did. Devices that the controller did not take are left out. Set
/// it with `World::set_external`.
class SimulatedBody final : public core::ExternalRobots {
 public:
  /// The robot called `id`, or the first that can be the body of such an emulator when `id` is empty. Error: there is
  /// none, it is of another kind, or its controller does not take what the emulator needs.
  static hal::Result<core::RobotId> find(const core::World& world, const bridges::EmulatorType& emulator,
                                         const std::string& id);

  /// `ports` must outlive this.
  SimulatedBody(const core::World& world, core::RobotId robot, bridges::SharedPorts& ports);

  void latch(core::World&) override {}
  void after_sense(core::World& world) override;
  void after_filter(core::World& world) override;

 private:
  core::RobotId robot_;
  bridges::SharedPorts& ports_;
  std::vector<const hal::PortType*> types_;  // that both have
};

}  // namespace tandem::app
