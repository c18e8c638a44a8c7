#include "app/commands.hpp"

#include "app/command/command.hpp"

namespace tandem::app {
namespace {

constexpr hal::CommandType kPlugin = {"plugin",
                                      "Begin a plug-in, or check one: `plugin new NAME`, `plugin check FILE`."};
constexpr hal::CommandType kCalibrate = {"calibrate", "Find a camera's lens and place, for the tracker 'apriltag'."};

/// In the order of the program's help.
void register_commands(hal::Registrar& registrar) {
  for (const hal::CommandType* type : {&run_command,
                                       &view_command,
                                       &replay_command,
                                       &sweep_command,
                                       &plot_command,
                                       &fit_command,
                                       &gap_command,
                                       &compare_command,
                                       &upgrade_command,
                                       &preflight_command,
                                       &desk_command,
                                       &export_command,
                                       &picture_command,
                                       &film_command,
                                       &kPlugin,
                                       &plugin_new_command,
                                       &plugin_check_command,
                                       &list_command,
                                       &describe_command,
                                       &check_command,
                                       &robot_command,
                                       &inspect_command,
                                       &kCalibrate,
                                       &calibrate_board_command,
                                       &calibrate_camera_command,
                                       &calibrate_arena_command,
                                       &validate_command,
                                       &bench_command,
                                       &emulate_command,
                                       &completion_command,
                                       &man_command})
    registrar.add(*type);
}

}  // namespace

const Program& program() {
  static constexpr Program kProgram = {
      "Tandem: one controller drives simulated robots, real ones, and both together.",
      "The launcher at the top of the checkout has further commands: test, build and format.", &register_commands};
  return kProgram;
}

}  // namespace tandem::app
