// A foot-bot's modules behind a link, in real time.
#pragma once
#include <atomic>
#include <string>

#include "bridges/emulation/server.hpp"
#include "bridges/footbot_emulator/footbot.hpp"
#include "bridges/footbot_emulator/kinematic_body.hpp"
#include "hal/result.hpp"

namespace tandem::bridges::footbot_emulator {

/// Its link is as `open_host_side` reads it.
struct Options : WheeledOptions<EmulatedBody> {
  Options() { link = "pty:fb0"; }

  std::string firmware = "v4";  ///< v4 (the robots') or v5: which version of the protocol the modules speak

  void describe(hal::ParamVisitor& v) {
    v.text("firmware", firmware, "v4 (the robots') or v5: which version of the protocol its modules speak.");
    WheeledParams::describe(v);
  }
  std::string shown(const std::string& path) const {
    const bool given = path.starts_with("tcp:") || path.starts_with("can:");
    return "foot-bot's modules on " + path + ": connect with --link " + (given ? path : "slcan:" + path + "@1000000");
  }
};

/// Events for the log beside the robot's own: `fault` (fault, phase: begin or end) and `late` (by_ms: see turn_until).
///
/// Emulates until `stop` becomes true, which is noticed within 20 ms. Removes its pseudo-terminal at the end. The log
/// ends with when the wheels were last commanded. Errors: a firmware or fault that there is not, a link or log that
/// cannot be opened, a link that goes away.
hal::Status run(const Options& options, const std::atomic<bool>& stop);

}  // namespace tandem::bridges::footbot_emulator
