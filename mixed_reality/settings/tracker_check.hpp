// Makes and checks the trackers of an experiment.
#pragma once
#include "bridges/tracker_type.hpp"
#include "core/scenario/scenario.hpp"
#include "hal/catalog.hpp"

namespace tandem::mixed_reality {

inline constexpr std::size_t kMostTrackers =
    4;  ///< of an experiment: each has a delay that every robot's filter learns

/// With the names and heights of what stands for real robots.
bridges::TrackerRequest tracker_request(const core::Scenario& scenario, const hal::Catalog& catalog,
                                        const core::TrackerItem& item);

/// Errors: no such kind; those of TrackerType::make.
bridges::MadeTracker make_tracker(const hal::Catalog& catalog, const bridges::TrackerRequest& request,
                                  const hal::Log& log);

/// The names by which trackers know a robot.
std::vector<std::string> tracked_names(const core::RobotItem& item);

/// What each tracker can see, one line a tracker that tells it.
std::vector<std::string> outlooks(const core::Scenario& scenario, const hal::Catalog& catalog);

/// Adds every problem of <trackers>, and of what robots say of theirs: options that make no sense, two robots of one
/// name, a fused pose where there is nothing to fuse.
void check_trackers(const core::Scenario& scenario, const hal::Catalog& catalog, core::Problems& problems);

}  // namespace tandem::mixed_reality
