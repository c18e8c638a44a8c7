// Reads the words of a command line, and runs the command that they name.
#pragma once
#include <string>
#include <string_view>

#include "hal/catalog.hpp"
#include "hal/command.hpp"

namespace tandem::app {

/// The whole program, or the one for robots' boards.
struct Program {
  std::string_view title, footer;  ///< of its help
  void (*register_commands)(hal::Registrar& registrar) = nullptr;
};

/// Runs the command that the words name: one of the program, of a library of `--plugin` before it, or of the plug-in
/// folders, which are looked through for others than the program's alone. Tells of wrong words and of what fails.
/// @returns the exit code of the program
int run_command_line(int argc, char** argv, const Program& program);

/// Why a line cannot be read by how this command describes it, or what that does not document; empty: nothing.
std::string flaw_of_line(const hal::CommandType& type);

}  // namespace tandem::app
