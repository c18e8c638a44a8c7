// Report of a mixed run.
#pragma once
#include <string>
#include <vector>

#include "core/space/space.hpp"
#include "mixed_reality/time/pacer.hpp"
#include "mixed_reality/twin/twin.hpp"

namespace tandem::mixed_reality {

struct RealRobotReport {
  std::string id;
  std::string link;     ///< as in the experiment file
  core::RobotId robot;  ///< its twin
  core::Pose pose;
  LinkHealth health = LinkHealth::Connecting;
  bool driving = false;         ///< in the last tick
  std::string state;            ///< why it was not, for people; "driving" when it was
  bool stop_confirmed = false;  ///< after the run, by the robot itself
  TwinCounts counts;
  bridges::LinkReport conversation;
  std::uint64_t poses_rejected = 0;    ///< measurements that the pose source did not believe
  std::vector<std::string> incidents;  ///< "robot 'ep0' at 12.3 s: link lost (…)", the first few
};

struct MixedReport {
  PaceLedger pace;
  std::vector<RealRobotReport> robots;  ///< in the order of the experiment file
};

}  // namespace tandem::mixed_reality
