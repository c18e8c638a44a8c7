// Report of a mixed run.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/space/space.hpp"
#include "mixed_reality/session/robot_ledger.hpp"
#include "mixed_reality/time/pacer.hpp"
#include "mixed_reality/time/system_clock.hpp"
#include "mixed_reality/tracking/learnt_motion.hpp"
#include "mixed_reality/tracking/trackers.hpp"
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
  RobotLedger ledger;
  std::uint64_t poses_rejected = 0;     ///< measurements that the pose source did not believe
  std::string pose_source;              ///< "fused"
  std::optional<PoseCounts> sightings;  ///< by trackers; nothing: none is asked
  std::optional<LearntMotion> learnt;
  std::vector<std::string> incidents;  ///< "robot 'ep0' at 12.3 s: link lost (…)", the first few
};

/// State of one real robot while the run goes on, for people who watch it.
struct RealRobotStatus {
  std::string id;
  std::string device;    ///< id of the real robot: another one after a replacement
  std::string link;      ///< as in the experiment file
  std::string identity;  ///< the answering robot; empty before it answered
  std::string coming;    ///< id of the one that is to take its place; empty: none is
  core::RobotId robot;   ///< its twin
  LinkHealth health = LinkHealth::Connecting;
  std::string trouble;  ///< what is wrong with the link; empty: nothing
  bool driving = false;
  std::string state;                             ///< why it does not drive; "driving" when it does
  std::string advice;                            ///< what people can look at, while it does not answer
  std::optional<double> wheels_turned_rad = {};  ///< since some moment, by its encoders; nothing: it has none
  bool emergency_stopped = false;
  bool awaits_arming = false;  ///< after an emergency stop, or after it took another one's place
  bool awaits_rearm = false;
  double held_back_m_s = 0.0;  ///< by how much its last command was changed, for safety
  std::uint64_t held_back_ticks = 0;
  std::optional<double> reading_age_s;  ///< of the newest reading; nothing: none came yet
  double round_trip_s = 0.0;            ///< mean of the run
  RobotLedger ledger;
  std::optional<double> battery;   ///< 0 to 1; nothing: it tells nothing
  std::optional<double> supply_V;  ///< of its battery; nothing: it tells nothing
  /// Where it is, by each source: first its own pose source, then trackers, at last the hub (the first one carried on
  /// to the tick).
  struct Place {
    std::string source;
    core::Pose pose;
    double age_s = 0.0;
    std::optional<double> sd_m = {}, sd_rad = {};  ///< standard deviations; nothing: not known
  };
  std::vector<Place> places;
  std::optional<PoseCounts> sightings;  ///< by trackers; nothing: none is asked
};

/// A real robot that took another one's place.
struct ReplacementReport {
  std::string robot;          ///< id of the twin
  std::string before, after;  ///< ids of the real ones
  std::string link;           ///< of the new one
  hal::Tick tick = 0;
};

struct MixedReport {
  PaceLedger pace;
  SystemClock clock;                    ///< of this computer, when the run began
  std::vector<TrackerStatus> trackers;  ///< in the order of the experiment file, as the robots
  std::vector<RealRobotReport> robots;  ///< in the order of the experiment file
  std::vector<ReplacementReport> replacements;
};

}  // namespace tandem::mixed_reality
