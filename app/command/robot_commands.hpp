// The command line that both programs have: the whole one, and the one for a robot's board.
#pragma once
#include <CLI/CLI.hpp>

#include "app/command/command.hpp"

namespace tandem::app {

struct RobotCommandOptions {
  CheckOptions check;
  RobotOptions robot;
  InspectOptions inspect;
};

/// Adds the commands `check`, `robot` and `inspect`; what the chosen one returned is put into `code`. Both references
/// must outlive `app`.
void add_robot_commands(CLI::App& app, RobotCommandOptions& options, int& code);

/// The option `--plugin`.
void add_plugins(CLI::App& command, Libraries& plugins);

/// The option `--step-timeout`.
void add_step_timeout(CLI::App& command, double& seconds);

/// Runs the command that the arguments name, and tells of wrong ones. Returns `code`, or `kWrongUsage`.
int parse_and_run(CLI::App& app, int argc, char** argv, int& code);

}  // namespace tandem::app
