#include "lab/register.hpp"

#include "app/command/command.hpp"
#include "app/module/module_table.hpp"

namespace tandem::app {
namespace {

constexpr hal::CommandType kPlugin = command_of(command_in_table("plugin"));
constexpr hal::CommandType kCalibrate = command_of(command_in_table("calibrate"));

}  // namespace

void register_lab(hal::Registrar& registrar) {
  for (const hal::CommandType* type : {&fit_command, &gap_command, &kPlugin, &plugin_new_command, &plugin_check_command,
                                       &kCalibrate, &calibrate_board_command, &calibrate_camera_command,
                                       &calibrate_arena_command, &validate_command, &bench_command})
    registrar.add(*type);
}

}  // namespace tandem::app
