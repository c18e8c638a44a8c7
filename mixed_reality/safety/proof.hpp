// Proof that the robot which answers is the robot that was armed.
//
// Proved means: the same resolved device, not reopened, every word of its identity as it was, and absent for at most
// 2 s. The start of a run arms the robots that answer then, or within 2 s of it; after that, only a person arms one.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "bridges/robot_bridge.hpp"
#include "hal/time.hpp"

namespace tandem::mixed_reality {

/// Joining: robots are found and settle, before a run. Paused: between two ticks of a run, for as long as a person
/// wants.
enum class RunPhase : std::uint8_t { Waiting, Running, Stopping, Paused, Joining };

/// Reason for which a robot is not proved to be the one that was armed; a later one outweighs those before it.
enum class Doubt : std::uint8_t {
  None,
  Late,        ///< it answered for the first time when the run had begun, or it took another one's place
  Away,        ///< it did not answer for more than 2 s
  OpenedAnew,  ///< its device was reopened: anything may hang on it now
  Another      ///< a word of its identity is another one
};

/// Watches one robot tick by tick. Allocates only when the identity may have changed.
class Proof {
 public:
  static constexpr hal::TimeNs kAway_ns = 2 * hal::kNsPerSecond;

  /// Once a tick, after the bridge's `latch`. Before the run nothing is doubted. `now_ns` is CLOCK_MONOTONIC.
  /// @returns what came up since the last look: a doubt is reported once, and remembered by the caller.
  Doubt look(RunPhase phase, const bridges::RobotBridge& bridge, hal::TimeNs now_ns);
  /// A person arms the robot that answers now; nothing where none does.
  void arm();
  /// The robot joins a run that has begun: its start did not arm it.
  void join_late() noexcept { joins_late_ = true; }

  /// Whether a robot answered at the last look.
  bool answers() const noexcept { return answers_; }
  /// Which robot answers and why it is doubted, for people; empty: nothing is doubted.
  const std::string& detail() const noexcept { return detail_; }

 private:
  Doubt compare(bool returns, hal::TimeNs away_ns);
  void fill_in_words();

  std::optional<bridges::RobotIdentity> armed_;
  bridges::RobotIdentity identity_;  // as of `version_`
  std::uint64_t version_ = 0;
  bool answers_ = false;
  bool joins_late_ = false;
  hal::TimeNs answered_ns_ = 0;
  std::optional<hal::TimeNs> begun_ns_;  // the run
  std::string detail_;
};

}  // namespace tandem::mixed_reality
