// The `tandem` command on a robot's board: what the board's own robot needs, and no simulation.
#include "app/build_info.hpp"
#include "app/command/robot_commands.hpp"
#include "app/process/emergency.hpp"
#include "app/process/signals.hpp"

int main(int argc, char** argv) {
  tandem::app::catch_rearm();
  tandem::app::catch_crashes();
  using namespace tandem::app;
  CLI::App app{"Tandem on a robot's board: runs the robot's controller here.", "tandem"};
  app.footer("Simulation, emulation and mixed runs are commands of the whole program.");
  app.require_subcommand(1);
  app.set_version_flag("--version", version_text());
  app.failure_message(CLI::FailureMessage::help);
  int code = kDone;
  RobotCommandOptions options;
  add_robot_commands(app, options, code);
  return parse_and_run(app, argc, argv, code);
}
