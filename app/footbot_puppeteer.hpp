// Gives an emulated foot-bot the body of a simulated one.
#pragma once
#include <string>

#include "bridges/footbot_emulator/shared_body.hpp"
#include "core/sim/external.hpp"
#include "core/sim/world.hpp"
#include "hal/result.hpp"

namespace tandem::app {

/// Between sensing and control of every tick, hands a foot-bot's readings to the emulated modules; after control,
/// writes what they command over what its controller did. Devices that the controller did not take are left out:
/// `footbot_puppet` takes all that its configuration lists. Set it with `World::set_external`.
class FootbotPuppeteer final : public core::ExternalRobots {
 public:
  using Body = bridges::footbot_emulator::SharedBody;

  /// The robot called `id`, or the first foot-bot with wheels when `id` is empty. Error: there is none, or it is no
  /// foot-bot, or its controller takes no wheels.
  static hal::Result<core::RobotId> find(const core::World& world, const std::string& id);

  FootbotPuppeteer(core::RobotId robot, Body& body) : robot_(robot), body_(body) {}

  void latch(core::World&) override {}
  void after_sense(core::World& world) override;
  void after_filter(core::World& world) override;

 private:
  core::RobotId robot_;
  Body& body_;
};

}  // namespace tandem::app
