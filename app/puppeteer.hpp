// Gives an emulated firmware the body of a simulated robot.
#pragma once
#include <string>

#include "bridges/epuck_emulator/shared_body.hpp"
#include "core/sim/external.hpp"
#include "core/sim/world.hpp"
#include "hal/result.hpp"

namespace tandem::app {

/// Between sensing and control of every tick, hands a robot's readings to the firmware, and writes what the firmware
/// commands into the robot's ports. The robot's controller must be `puppet`. Set it with `World::set_external`.
class Puppeteer final : public core::ExternalRobots {
 public:
  /// The robot called `id`, or the first puppet when `id` is empty. Error: there is none, or its controller is no
  /// puppet.
  static hal::Result<core::RobotId> find(const core::World& world, const std::string& id);

  Puppeteer(core::RobotId robot, bridges::epuck_emulator::SharedBody& body) : robot_(robot), body_(body) {}

  void latch(core::World&) override {}
  void after_sense(core::World& world) override;
  void after_filter(core::World& world) override;

 private:
  core::RobotId robot_;
  bridges::epuck_emulator::SharedBody& body_;
};

}  // namespace tandem::app
