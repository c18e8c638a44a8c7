// Plays stories in virtual time and judges them by what the robots themselves did.
//
//   always             -> no reading is Fresh that is older than readings may be
//   the hub is there   -> a second after the last fault every robot drives as it is told, and goes on so
//   the loop hangs     -> the robot rests after the command time-out
//   the hub is gone    -> a robot that can be reached rests within 250 ms (500 ms after a freeze began), any other
//                         within a second of being reachable; none that has confirmed moves again
//   the hub ends       -> every robot confirms its rest, and none that has moves again
#pragma once
#include <functional>
#include <memory>
#include <string>

#include "tests/scenarios/faults/story.hpp"
#include "tests/scenarios/faults/tested_robot.hpp"

namespace tandem::faults {

/// What a kind of robot needs.
struct Kind {
  std::string name;  ///< of its line among the golden logs
  std::span<const FaultChoice> choices;
  /// `seed` may choose the firmware, or what else there is.
  std::function<std::unique_ptr<TestedRobot>(std::size_t number, std::uint64_t seed)> make;
  TimeNs fresh_ns = 200 * kMs;    ///< age at which a reading is stale by itself
  TimeNs back_ns = kSecond;       ///< from the end of the faults to driving
  TimeNs start_ns = 5 * kSecond;  ///< within which it drives at first
  TimeNs step_ns = kMs;           ///< of the virtual time
  TimeNs coast_ns = 0;            ///< from a safe command to resting
  TimeNs land_ns = 0;             ///< and to what a stopper waits for before it calls a robot stopped
};

/// Plays stories 1 to `short_runs`, or as many as TANDEM_FAULT_RUNS says; or the one that TANDEM_FAULT_SEED names.
/// What the emulators logged in stories 1 to `short_runs` is compared with the golden digest of the kind.
/// @returns all that went wrong, with what it takes to repeat it; empty: nothing.
std::string play_all(const Kind& kind, std::uint64_t short_runs);

/// Plays the story of `seed`, whatever the environment says. @returns what went wrong, as above.
std::string play_one(const Kind& kind, std::uint64_t seed);

}  // namespace tandem::faults
