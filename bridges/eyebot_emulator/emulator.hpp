// Eye-bots on a network, in real time.
#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bridges/eyebot_emulator/eyebot.hpp"
#include "bridges/eyebot_emulator/point_body.hpp"
#include "bridges/lcm/lcm_link.hpp"
#include "hal/log.hpp"
#include "hal/result.hpp"

namespace tandem::bridges::eyebot_emulator {

struct Options {
  std::string link = "lcm:udpm://239.255.76.67:7667?ttl=0";  ///< "lcm:" and what `LcmLink::open` reads
  std::shared_ptr<lcm_bus::LcmLink> shared{};  ///< instead of `link`: one in this process; not yet started
  std::string log_file{};                      ///< one JSON object a line; empty: none
  std::vector<std::string> faults{};           ///< as `parse_fault` reads them; every robot has them all
  std::uint64_t seed = 1;                      ///< of the chance in the faults
  Eyebot::Options robot{};                     ///< its session is drawn at the start
  int count = 1;                               ///< how many robots: eb0, eb1, … after `robot.name`
  EmulatedBody* body = nullptr;  ///< must outlive the run, for one robot; none: bodies of their own, in `room`
  std::optional<Room> room = Room{};
  EventSink events{};                                    ///< gets what the log gets, on the thread of `run`
  hal::Log log{};                                        ///< for people
  std::function<void(const std::string& path)> ready{};  ///< called once, when hubs are heard
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
