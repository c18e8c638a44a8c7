// An e-puck's stock firmware in real time: behind a serial line, or an e-puck2's behind its radio.
#pragma once
#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bridges/emulation/true_pose.hpp"
#include "bridges/epuck_emulator/firmware.hpp"
#include "bridges/epuck_emulator/kinematic_body.hpp"
#include "hal/log.hpp"
#include "hal/result.hpp"

namespace tandem::bridges::epuck_emulator {

struct Options {
  std::string link = "pty:ep0";       ///< pty:NAME, serial:DEVICE@115200; tcp-listen:PORT, a serial server's;
                                      ///< epuck-tcp-listen:PORT, an e-puck2's radio
  std::string firmware = "gctronic";  ///< btcom, gctronic, webots or epuck2
  std::string log_file{};             ///< one JSON object a line; empty: none
  std::vector<std::string> faults{};  ///< as `parse_fault` reads them
  std::uint64_t seed = 1;             ///< of the chance in the faults
  Firmware::Options robot{};          ///< what is built in; its variant is taken from `firmware`
  EmulatedBody* body = nullptr;       ///< must outlive the run; none: a robot on open ground, or in `arena`
  std::optional<Arena> arena{};
  PoseOptions poses{};
  WheelErrors wheels{};                                       ///< how the wheels of a body of its own err
  std::function<std::optional<BodyPose>()> pose_elsewhere{};  ///< of `body`, the newest; none: nobody knows
  EventSink events{};                                         ///< gets what the log gets, on the thread of `run`
  hal::Log log{};                                             ///< for people
  std::function<void(const std::string& path)> ready{};       ///< called once, when the line can be opened
};

/// Events for the log beside the robot's own: `fault` (fault, phase: begin or end) and `late` (by_ms: see turn_until).
///
/// Emulates until `stop` becomes true, which is noticed within 20 ms. Bytes travel at 115200 baud in both directions; a
/// host whose baud rate differs exchanges garbage with it. Removes its pseudo-terminal at the end. Errors: a firmware
/// or fault that there is not, a link or log that cannot be opened, a serial device that goes away.
hal::Status run(const Options& options, const std::atomic<bool>& stop);

}  // namespace tandem::bridges::epuck_emulator
