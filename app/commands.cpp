#include "app/commands.hpp"

#include "app/command/command.hpp"

namespace tandem::app {
namespace {

/// In the order of the program's help, under each heading.
void register_commands(hal::Registrar& registrar) {
  for (const hal::CommandType* type : {&run_command, &compare_command, &upgrade_command, &export_command, &list_command,
                                       &describe_command, &check_command, &completion_command, &man_command})
    registrar.add(*type);
}

}  // namespace

const Program& program() {
  static constexpr Program kProgram = {
      "Tandem: one controller drives simulated robots, real ones, and both together.",
      "The launcher at the top of a checkout has further commands: build, docs, format, package, python, test.",
      &register_commands};
  return kProgram;
}

}  // namespace tandem::app
