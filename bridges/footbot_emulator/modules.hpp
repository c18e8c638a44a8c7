// The modules on a foot-bot's bus, and the names of their variables.
//
// What is public of the marXbot's own firmware are the nodes "left motor", "right motor", "proximity sensors" and
// "distance sensors" of its simulation in ASEBA's Enki target; the others are this project's convention. Units are
// those of the robot's control interface as published with ARGoS 2.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "bridges/aseba_emulation/node.hpp"
#include "bridges/footbot_emulator/message.hpp"

namespace tandem::bridges::footbot_emulator {

using aseba_emulation::Lie;
using aseba_emulation::Protocol;
using aseba_emulation::Variable;

/// One module of the foot-bot, a node of its bus. It comes without a program, and runs one that is sent to it.
class Module : public aseba_emulation::Node {
 public:
  /// The variables that every module has, `id`, `source` and `args`, come first. `device` are its own.
  Module(std::uint8_t id, std::string name, const std::vector<Variable>& device, Protocol protocol);
};

/// Places in the list of modules; a module's number on the bus is its place + 1.
enum class Place : std::size_t {
  LeftMotor,
  RightMotor,
  Proximity,
  Scanner,
  Turret,
  Gripper,
  Leds,
  RangeAndBearing,
  Base
};
inline constexpr std::size_t kModules = 9;

std::vector<Module> make_modules(Protocol protocol);

/// The module that `text` names: by its number on the bus or its name, with - or _ for blanks.
std::optional<Place> place_of(std::string_view text);
/// "left-motor, right-motor, …"
std::string module_names();

}  // namespace tandem::bridges::footbot_emulator
