// Tracker `lcm`: poses as LCM messages of the type tandem.poses_t (poses.lcm).
#pragma once
#include "bridges/lcm/lcm_link.hpp"
#include "bridges/tracker_type.hpp"
#include "hal/params.hpp"

namespace tandem::bridges::trackers {

struct LcmOptions {
  std::string url{lcm_bus::kDefaultLcmUrl};
  std::string channel = "tandem/poses";
  void describe(hal::ParamVisitor& v) {
    v.text("url", url, "Where: udpm://GROUP:PORT?ttl=N.");
    v.text("channel", channel, "Name of the channel, or a regular expression for several.");
  }
};

MadeTracker make_lcm_tracker(const TrackerRequest& request, const hal::Log& log);
hal::Status check_lcm_tracker(const TrackerRequest& request);
/// On a link that is open already.
std::unique_ptr<Tracker> make_lcm_tracker(std::shared_ptr<lcm_bus::LcmLink> link, const std::string& channel);

}  // namespace tandem::bridges::trackers
