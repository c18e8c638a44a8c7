#include "bridges/footbot_emulator/modules.hpp"

namespace tandem::bridges::footbot_emulator {
namespace {

struct Entry {
  std::string_view name;
  std::vector<Variable> variables;
};

const std::array<Entry, kModules>& entries() {
  static const std::array<Entry, kModules> all = {{
      {"left motor", {{"speed", 1}, {"odo", 2}}},   // pulses a period; pulses, low word first
      {"right motor", {{"speed", 1}, {"odo", 2}}},  // the same
      {"proximity sensors", {{"bumpers", 24}, {"ground", 12}, {"light", 24}}},
      {"distance sensors",
       {{"scan.range", 4}, {"scan.angle", 1}, {"scan.mode", 1}, {"scan.speed", 1}, {"scan.target", 1}}},
      {"turret",
       {{"turret.mode", 1}, {"turret.speed", 1}, {"turret.target", 1}, {"turret.angle", 1}, {"turret.torque", 1}}},
      {"gripper", {{"gripper.target", 1}, {"gripper.angle", 1}, {"gripper.busy", 1}}},
      {"leds", {{"led.red", 12}, {"led.green", 12}, {"led.blue", 12}, {"beacon", 3}}},
      {"range and bearing", {{"rab.tx", 5}}},
      {"base", {{"battery", 1}, {"acc", 3}, {"gyro", 1}}},
  }};
  return all;
}

std::string dashed(std::string_view name) {
  std::string text(name);
  for (char& c : text) {
    if (c == ' ' || c == '_') c = '-';
  }
  return text;
}

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

std::vector<Module> make_modules(Protocol protocol) {
  std::vector<Module> modules;
  for (const Entry& e : entries()) {
    modules.emplace_back(static_cast<std::uint8_t>(modules.size() + 1), std::string(e.name), e.variables, protocol);
  }
  return modules;
}

std::optional<Place> place_of(std::string_view text) {
  for (std::size_t i = 0; i < kModules; ++i) {
    if (dashed(text) == dashed(entries()[i].name) || text == std::to_string(i + 1)) return Place{i};
  }
  return std::nullopt;
}

std::string module_names() {
  std::string text;
  for (const Entry& e : entries()) text += (text.empty() ? "" : ", ") + dashed(e.name);
  return text;
}

}  // namespace tandem::bridges::footbot_emulator
