// Keeps guardian processes told how each real robot is to be stopped, should this program die.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "bridges/epuck/guardian.hpp"
#include "bridges/eyebot/guardian.hpp"
#include "bridges/footbot/guardian.hpp"
#include "bridges/robot_bridge.hpp"
#include "core/scenario/scenario.hpp"
#include "hal/log.hpp"

namespace tandem::app {

/// Make it before any other thread exists. Destroyed, it has every robot stopped that was not released.
class GuardedRobots {
 public:
  /// Guardians for the robots of these items that have a `<bridge>`. Where no process can be made, `log` is told.
  GuardedRobots(const std::vector<core::RobotItem>& items, const hal::Log& log);

  /// `bridge` must outlive this, or the last call of anything here but the destructor.
  void add(const bridges::RobotBridge& bridge) { robots_.push_back({&bridge}); }
  /// Tells what has changed since it was told last. Cheap where nothing has: call it before commands leave.
  void update();
  /// Robots that confirmed their stop need no guardian any more. @returns ids of those that did not, although they were
  /// driven.
  std::vector<std::string> release_rested();

 private:
  struct Row {
    const bridges::RobotBridge* bridge;
    bridges::StopMessages told = {};  // version 0: nothing yet
    bool watched = false;
  };
  void watch(const bridges::StopMessages& messages);
  void release(const bridges::StopMessages& messages);

  std::vector<Row> robots_;
  std::optional<bridges::epuck::Guardian> epucks_;
  std::optional<bridges::footbot::Guardian> footbots_;
  std::optional<bridges::eyebot::Guardian> eyebots_;
};

}  // namespace tandem::app
