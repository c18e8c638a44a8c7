// One module of the foot-bot, a node of its bus. It comes without a program, and runs one that is sent to it.
#pragma once
#include <string>
#include <vector>

#include "bridges/aseba_emulation/node.hpp"
#include "bridges/footbot_emulator/message.hpp"

namespace tandem::bridges::footbot_emulator {

using aseba_emulation::Lie;
using aseba_emulation::Protocol;
using aseba_emulation::Variable;

class Module : public aseba_emulation::Node {
 public:
  /// The variables that every module has, `id`, `source` and `args`, come first. `device` are its own.
  Module(std::uint8_t id, std::string name, const std::vector<Variable>& device, Protocol protocol);
};

}  // namespace tandem::bridges::footbot_emulator
