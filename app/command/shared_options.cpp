#include "app/command/shared_options.hpp"

namespace tandem::app {

void describe_plugins(hal::CommandLine& line, Libraries& plugins) {
  line.option("--plugin", plugins,
              "Library whose parts this call may name: devices, robots, engines, bridges, …; repeatable")
      .repeatable()
      .file();
}

void describe_allow_io(hal::CommandLine& line, bool& allow) {
  line.flag("--allow-io", allow,
            "Let all scripts in Lua use files, the clock and the environment: the run need not repeat");
}

void describe_step_timeout(hal::CommandLine& line, double& seconds) {
  line.option("--step-timeout", seconds,
              "Seconds after which a controller or hook that has not returned is named; Ctrl-C then ends the run; "
              "0: never")
      .show_default()
      .not_negative();
}

void describe_hub_faults(hal::CommandLine& line, std::vector<std::string>& faults, std::string_view when) {
  line.option("--hub-fault", faults,
              std::string(when) +
                  " fault of this program, e.g. stall@5s+0.4s, freeze@5s+2s, kill@5s, clock=1h@5s; repeatable")
      .repeatable();
}

void describe_desk_keys(hal::CommandLine& line, std::string& keys) {
  line.option("--desk-keys", keys,
              "Who commands over LCM (<desk lcm=…>): a file of lines NAME ROLE SECRET; default: this user's")
      .file();
}

}  // namespace tandem::app
