// Gives an emulated eye-bot the body of a simulated one.
#pragma once
#include <string>

#include "bridges/eyebot_emulator/shared_body.hpp"
#include "core/sim/external.hpp"
#include "core/sim/world.hpp"
#include "hal/result.hpp"

namespace tandem::app {

/// Between sensing and control of every tick, hands an eye-bot's readings to the emulated firmware; after control,
/// writes what that commands over what its controller did. Devices that the controller did not take are left out:
/// `eyebot_puppet` takes all that its configuration lists. Set it with `World::set_external`.
///
/// The simulated robot takes off, lands, attaches and lets go as its own tasks do; once they are done, and between
/// them, it flies with the firmware's velocities. With its motors cut it lands: simulated eye-bots do not fall.
class EyebotPuppeteer final : public core::ExternalRobots {
 public:
  using Body = bridges::eyebot_emulator::SharedBody;

  /// The robot called `id`, or the first eye-bot that can be when `id` is empty. Error: there is none, or it is no
  /// eye-bot, or its controller does not take what it flies by.
  static hal::Result<core::RobotId> find(const core::World& world, const std::string& id);

  EyebotPuppeteer(core::RobotId robot, Body& body) : robot_(robot), body_(body) {}

  void latch(core::World&) override {}
  void after_sense(core::World& world) override;
  void after_filter(core::World& world) override;

 private:
  core::RobotId robot_;
  Body& body_;
};

}  // namespace tandem::app
