// A Thymio behind a line, in real time.
#pragma once
#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bridges/emulation/true_pose.hpp"
#include "bridges/thymio_emulator/thymio.hpp"
#include "hal/log.hpp"
#include "hal/result.hpp"

namespace tandem::bridges::thymio_emulator {

inline constexpr unsigned long kBaud = 115200;  ///< of its serial line; USB does not care

struct Options {
  std::string link = "pty:thymio0";   ///< as `open_host_line` reads it
  std::int64_t node = 1;              ///< its number
  std::string log_file{};             ///< one JSON object a line; empty: none
  std::vector<std::string> faults{};  ///< as `parse_fault` reads them
  std::uint64_t seed = 1;             ///< of the chance in the faults
  EmulatedBody* body = nullptr;       ///< must outlive the run; none: open ground
  PoseOptions poses{};
  WheelErrors wheels{};  ///< how the wheels of a body of its own err
  Delays delays{};
  std::function<std::optional<BodyPose>()> pose_elsewhere{};  ///< of `body`, the newest; none: nobody knows
  EventSink events{};                                         ///< gets what the log gets, on the thread of `run`
  hal::Log log{};                                             ///< for people
  std::function<void(const std::string& path)> ready{};       ///< called once, when a host can connect
};

/// Events for the log beside the robot's own: `fault` (fault, phase: begin or end) and `late` (by_ms: see turn_until).
///
/// Emulates until `stop` becomes true, which is noticed within 20 ms. Removes its pseudo-terminal at the end. The log
/// ends with when the wheels were last commanded. Errors: a node number or fault that there is not, a link or log that
/// cannot be opened, a line that goes away.
hal::Status run(const Options& options, const std::atomic<bool>& stop);

}  // namespace tandem::bridges::thymio_emulator
