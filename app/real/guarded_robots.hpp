// Keeps the guardian process told how each real robot is to be stopped, should this program die, freeze, or end before
// a robot has confirmed its stop.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "bridges/guardian/abandoned.hpp"
#include "bridges/guardian/client.hpp"
#include "bridges/robot_bridge.hpp"
#include "hal/catalog.hpp"
#include "hal/log.hpp"

namespace tandem::app {

/// Robots whose hub and guardian were killed together are stopped before anything else is done, and told of as
/// warnings: all that have left a lock in this computer's folder, whether they are wanted now or not. Call it before
/// any other thread exists.
std::vector<bridges::guardian::StoppedRobot> stop_abandoned_robots(const hal::Catalog& catalog, const hal::Log& log);

/// Make it before any other thread exists. Destroyed, it leaves robots that were not released to the guardian.
class GuardedRobots {
 public:
  /// Where there are real robots: `stop_abandoned_robots`; then a guardian, which stops them with what `catalog` has by
  /// now; from here on Ctrl-Z stops the robots first. Where no process can be made, `started` says so.
  GuardedRobots(bool real_robots, const hal::Catalog& catalog, hal::Log log);

  /// For bridges: without it they would write to robots that the guardian is stopping.
  bridges::SendPermit permit() const noexcept;
  /// Error: there is no guardian process, and no robot may be driven.
  const hal::Status& started() const noexcept { return started_; }
  /// Robots that dead programs had left, and what has become of them.
  const std::vector<bridges::guardian::StoppedRobot>& abandoned() const noexcept { return abandoned_; }
  /// The guardian process lives and is awake, or no robot needs one. It is not made again: without it no robot may be
  /// driven.
  bool guarded() const noexcept { return !guardian_ || guardian_->guards(); }
  /// Times that this program was frozen, and its robots stopped.
  std::uint64_t freezes() const noexcept;
  /// `bridge` must outlive this, or the last call of anything here but the destructor.
  void add(const bridges::RobotBridge& bridge) { robots_.push_back({&bridge}); }
  /// It takes no part any more, and was never driven.
  void remove(const bridges::RobotBridge& bridge);
  /// As they are now, in the order in which they were added.
  std::vector<bridges::StopMessages> robots() const;
  /// Before the first link is opened: no other program drives these robots from now on. Error: one does.
  hal::Status claim();
  /// The same for one that was added since: before its link is opened.
  hal::Status claim(const bridges::RobotBridge& bridge);
  /// Tells what has changed since it was told last, and people what there is to tell. Cheap where there is nothing:
  /// call it before commands leave.
  void update();
  /// At the end, when all links are closed: robots that confirmed their stop need no guardian any more; the others get
  /// a little time to confirm it to the guardian. @returns ids of those that did not, although they were driven.
  std::vector<std::string> release_rested();

 private:
  struct Row {
    const bridges::RobotBridge* bridge;
    bridges::StopMessages told = {};
    bool watched = false;
  };

  hal::Log log_;
  hal::Status started_;
  std::vector<bridges::guardian::StoppedRobot> abandoned_;
  std::vector<Row> robots_;
  std::unique_ptr<bridges::guardian::GuardianClient> guardian_;
};

}  // namespace tandem::app
