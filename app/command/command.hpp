// The commands of `tandem`, a file each: options, description, function.
#pragma once
#include <string>

#include "app/run_options.hpp"
#include "hal/command.hpp"

namespace tandem::app {

extern const hal::CommandType run_command, view_command, replay_command;
extern const hal::CommandType sweep_command, plot_command;
extern const hal::CommandType fit_command, gap_command, compare_command, upgrade_command;
extern const hal::CommandType preflight_command, desk_command;
extern const hal::CommandType export_command, picture_command, film_command;
extern const hal::CommandType plugin_new_command, plugin_check_command;
extern const hal::CommandType list_command, describe_command;
extern const hal::CommandType check_command, robot_command, inspect_command;
extern const hal::CommandType calibrate_board_command, calibrate_camera_command, calibrate_arena_command;
extern const hal::CommandType emulate_command, completion_command, man_command;
extern const hal::CommandType bench_command, validate_command;  // in folders above this one

/// What `tandem run` does, for commands that make runs of their own options.
int run(const RunOptions& options);

}  // namespace tandem::app
