// A Thymio behind a line, in real time.
#pragma once
#include <atomic>
#include <cstdint>
#include <string>

#include "bridges/emulation/server.hpp"
#include "bridges/thymio_emulator/thymio.hpp"
#include "hal/result.hpp"

namespace tandem::bridges::thymio_emulator {

inline constexpr unsigned long kBaud = 115200;  ///< of its serial line; USB does not care

/// Its link is as `open_host_line` reads it.
struct Options : WheeledOptions<EmulatedBody> {
  Options() { link = "pty:thymio0"; }

  std::int64_t node = 1;  ///< its number

  void describe(hal::ParamVisitor& v) {
    v.integer("node", node, {1, 255}, "Its number, where several share a switch.");
    WheeledParams::describe(v);
  }
  std::string shown(const std::string& path) const {
    const std::string written = path.starts_with("tcp:") ? path : "serial:" + path + "@" + std::to_string(kBaud);
    return "Thymio on " + path + ": connect with --link " + written;
  }
};

/// Events for the log beside the robot's own: `fault` (fault, phase: begin or end) and `late` (by_ms: see turn_until).
///
/// Emulates until `stop` becomes true, which is noticed within 20 ms. Removes its pseudo-terminal at the end. The log
/// ends with when the wheels were last commanded. Errors: a node number or fault that there is not, a link or log that
/// cannot be opened, a line that goes away.
hal::Status run(const Options& options, const std::atomic<bool>& stop);

}  // namespace tandem::bridges::thymio_emulator
