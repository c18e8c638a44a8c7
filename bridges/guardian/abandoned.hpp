// Finds and stops robots whose hub and guardian were killed together, before anything else is done with real robots.
#pragma once
#include <string>
#include <vector>

#include "bridges/guardian/robot_lock.hpp"
#include "bridges/guardian/stopper.hpp"

namespace tandem::bridges::guardian {

/// A robot that may have driven on with its last command, and what has become of it now.
struct StoppedRobot {
  AbandonedRobot abandoned;
  bool confirmed = false;  ///< by itself, over the line that it was left on
  std::string trouble;     ///< where it has not

  /// All of that in a line or two.
  std::string to_text() const;
};

/// Looks into the folder of locks, and has all such robots stopped by a guardian of their own; waits for them for at
/// most `timeout_ns`. That guardian goes on with those that have not confirmed by then. Forks where there are any: call
/// it before any other thread exists.
std::vector<StoppedRobot> stop_abandoned(const std::vector<StopperType>& types, hal::TimeNs timeout_ns);

}  // namespace tandem::bridges::guardian
