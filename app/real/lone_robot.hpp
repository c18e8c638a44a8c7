// Options of `tandem robot`.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/run_options.hpp"
#include "hal/command.hpp"

namespace tandem::app {

struct RobotOptions {
  Libraries plugins;
  std::string file;
  std::string link;
  std::optional<double> seconds;
  std::string report;
  std::string record;  ///< empty: none
  WatchRequest watch;
  std::optional<std::int64_t> page_port;  ///< of a window; nothing: none
  ViewRequest view;
  std::vector<std::string> hub_faults;  ///< as `parse_hub_fault` reads them
  double step_timeout_s = 5.0;          ///< as for `run`
  std::string robot;                    ///< of a hub, whose peer this is; empty: the file's; "*": any that waits

  void describe(hal::CommandLine& line);
};

inline constexpr std::string_view kPeerScheme = "peer:";

/// `tandem robot` for a robot of a run in lock-step, where the link is "peer:tcp:HOST:PORT" or "peer:serial:…".
int robot_peer(const RobotOptions& options);

}  // namespace tandem::app
