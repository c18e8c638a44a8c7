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
};

/// Events for the log beside the robot's own: `fault` (fault, phase: begin or end) and `late` (by_ms: see turn_until).
///
/// Emulates until `stop` becomes true, which is noticed within 20 ms. Bytes travel at 115200 baud in both directions; a
/// host whose baud rate differs exchanges garbage with it. Removes its pseudo-terminal at the end. Errors: a firmware
/// or fault that there is not, a link or log that cannot be opened, a serial device that goes away.
hal::Status run(const Options& options, const std::atomic<bool>& stop);

}  // namespace tandem::bridges::epuck_emulator
