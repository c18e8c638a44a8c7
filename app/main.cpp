// The `tandem` command: the whole one, and the one for a robot's board.
#include "app/commands.hpp"
#include "app/process/emergency.hpp"
#include "app/process/signals.hpp"

int main(int argc, char** argv) {
  tandem::app::catch_rearm();
  tandem::app::catch_crashes();
  return tandem::app::run_command_line(argc, argv, tandem::app::program());
}
