#include "bridges/footbot_emulator/module.hpp"

namespace tandem::bridges::footbot_emulator {
namespace {

aseba_emulation::NodeSpec spec_of(std::uint8_t id, std::string name, const std::vector<Variable>& device,
                                  Protocol protocol) {
  aseba_emulation::NodeSpec spec;
  spec.id = id;
  spec.name = std::move(name);
  spec.protocol = protocol;
  spec.variables = {{"id", 1}, {"source", 1}, {"args", 32}};
  spec.variables.insert(spec.variables.end(), device.begin(), device.end());
  spec.events = {{"timer", "periodic timer"}};
  spec.functions = {{"math.copy", "copies src to dest element by element", {{-1, "dest"}, {-1, "src"}}},
                    {"math.fill", "fills dest with constant", {{-1, "dest"}, {1, "value"}}}};
  spec.bytecode_words = 1024;
  spec.stack_words = 32;
  spec.variable_words = 256;
  spec.runs_programs = true;
  return spec;
}

}  // namespace

Module::Module(std::uint8_t id, std::string name, const std::vector<Variable>& device, Protocol protocol)
    : Node(spec_of(id, std::move(name), device, protocol)) {}

}  // namespace tandem::bridges::footbot_emulator
