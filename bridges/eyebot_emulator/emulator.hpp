// Eye-bots on a network, in real time.
#pragma once
#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bridges/emulation/server.hpp"
#include "bridges/eyebot_emulator/eyebot.hpp"
#include "bridges/eyebot_emulator/point_body.hpp"
#include "bridges/lcm/lcm_link.hpp"
#include "hal/result.hpp"

namespace tandem::bridges::eyebot_emulator {

/// Its link is "lcm:" and what `LcmLink::open` reads. Every robot has all faults.
struct Options : ServerOptions {
  Options() { link = "lcm:udpm://239.255.76.67:7667?ttl=0"; }

  std::shared_ptr<lcm_bus::LcmLink> shared{};  ///< instead of `link`: one in this process; not yet started
  Eyebot::Options robot{};                     ///< its session is drawn at the start
  int count = 1;                               ///< how many robots: eb0, eb1, … after `robot.name`
  EmulatedBody* body = nullptr;  ///< must outlive the run, for one robot; none: bodies of their own, in `room`
  std::optional<Room> room = Room{};
};

/// Events for the log beside the robot's own: `fault` (fault, phase: begin or end) and `late` (by_ms: see turn_until).
///
/// Emulates until `stop` becomes true, which is noticed within 20 ms. Stamps in the log are exact, which puts lines out
/// of order by up to some milliseconds: a message's is when the link's thread took it, CLOCK_MONOTONIC. Errors: a fault
/// that there is not, a name that cannot be part of a channel's, a link or log that cannot be opened.
hal::Status run(const Options& options, const std::atomic<bool>& stop);

/// "eb0", "eb1", … for `first` "eb0" and `count`. "hawk" becomes "hawk0", … when there are several.
std::vector<std::string> names_of(const std::string& first, int count);

}  // namespace tandem::bridges::eyebot_emulator
