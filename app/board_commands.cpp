#include "app/command/command.hpp"
#include "app/commands.hpp"

namespace tandem::app {
namespace {

void register_commands(hal::Registrar& registrar) {
  for (const hal::CommandType* type : {&check_command, &robot_command, &inspect_command}) registrar.add(*type);
}

}  // namespace

const Program& program() {
  static constexpr Program kProgram = {"Tandem on a robot's board: runs the robot's controller here.",
                                       "Simulation, emulation and mixed runs are commands of the whole program.",
                                       &register_commands};
  return kProgram;
}

}  // namespace tandem::app
