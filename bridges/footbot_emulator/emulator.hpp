// A foot-bot's modules behind a link, in real time.
#pragma once
#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bridges/emulation/true_pose.hpp"
#include "bridges/footbot_emulator/footbot.hpp"
#include "bridges/footbot_emulator/kinematic_body.hpp"
#include "hal/log.hpp"
#include "hal/result.hpp"

namespace tandem::bridges::footbot_emulator {

struct Options {
  std::string link = "pty:fb0";       ///< as `open_host_side` reads it
  std::string firmware = "v4";        ///< v4 (the robots') or v5: which version of the protocol the modules speak
  std::string log_file{};             ///< one JSON object a line; empty: none
  std::vector<std::string> faults{};  ///< as `parse_fault` reads them
  std::uint64_t seed = 1;             ///< of the chance in the faults
  EmulatedBody* body = nullptr;       ///< must outlive the run; none: a robot on open ground, or in `arena`
  std::optional<Arena> arena{};
  WheelErrors wheels{};  ///< how the wheels of a body of its own err
  Delays delays{};
  PoseOptions poses{};
  std::function<std::optional<BodyPose>()> pose_elsewhere{};  ///< of `body`, the newest; none: nobody knows
  EventSink events{};                                         ///< gets what the log gets, on the thread of `run`
  hal::Log log{};                                             ///< for people
  std::function<void(const std::string& path)> ready{};       ///< called once, when a host can connect
};

/// Events for the log beside the robot's own: `fault` (fault, phase: begin or end) and `late` (by_ms: see turn_until).
///
/// Emulates until `stop` becomes true, which is noticed within 20 ms. Removes its pseudo-terminal at the end. The log
/// ends with when the wheels were last commanded. Errors: a firmware or fault that there is not, a link or log that
/// cannot be opened, a link that goes away.
hal::Status run(const Options& options, const std::atomic<bool>& stop);

}  // namespace tandem::bridges::footbot_emulator
