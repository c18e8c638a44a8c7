// An e-puck's stock firmware in real time: behind a serial line, or an e-puck2's behind its radio.
#pragma once
#include <atomic>
#include <string>

#include "bridges/emulation/server.hpp"
#include "bridges/epuck_emulator/firmware.hpp"
#include "hal/result.hpp"

namespace tandem::bridges::epuck_emulator {

/// Its link: pty:NAME, serial:DEVICE@115200; tcp-listen:PORT, a serial server's; epuck-tcp-listen:PORT, an e-puck2's
/// radio.
struct Options : WheeledOptions<EmulatedBody> {
  Options() { link = "pty:ep0"; }

  std::string firmware = "gctronic";  ///< btcom, gctronic, webots or epuck2
  Firmware::Options robot{};          ///< what is built in; its variant and delays are taken from here

  void describe(hal::ParamVisitor& v) {
    std::int64_t selector = robot.selector;
    v.text("firmware", firmware, "btcom, gctronic, webots or epuck2.");
    v.integer("selector", selector, {0, 15}, "Position of the rotary switch.");
    v.flag("cliff_sensors", robot.cliff_sensors, "The ground board has two cliff sensors.");
    v.flag("ground_board", robot.ground_board, "It has ground sensors; else the firmware answers zeros.");
    WheeledParams::describe(v);
    robot.selector = static_cast<std::uint8_t>(selector);
  }
  std::string shown(const std::string& path) const {
    const bool given = path.starts_with("tcp:") || path.starts_with("epuck-tcp:");
    return "e-puck's firmware on " + path + ": connect with --link " + (given ? path : "serial:" + path + "@115200");
  }
};
struct Epuck2Options : Options {
  Epuck2Options() {
    firmware = "epuck2";
    robot.cliff_sensors = true;
  }
};

/// Events for the log beside the robot's own: `fault` (fault, phase: begin or end) and `late` (by_ms: see turn_until).
///
/// Emulates until `stop` becomes true, which is noticed within 20 ms. Bytes travel at 115200 baud in both directions; a
/// host whose baud rate differs exchanges garbage with it. Removes its pseudo-terminal at the end. Errors: a firmware
/// or fault that there is not, a link or log that cannot be opened, a serial device that goes away.
hal::Status run(const Options& options, const std::atomic<bool>& stop);

}  // namespace tandem::bridges::epuck_emulator
