// Tracker `udp`: poses as datagrams, in lines of JSON or the compact form (docs/trackers.md).
#pragma once
#include "bridges/tracker_type.hpp"
#include "hal/params.hpp"

namespace tandem::bridges::trackers {

struct UdpOptions {
  std::string address = "127.0.0.1";
  std::int64_t port = 7700;
  void describe(hal::ParamVisitor& v) {
    v.text("address", address,
           "Of this computer, at which datagrams are taken; 0.0.0.0: of all of its networks; 224.0.0.0 to "
           "239.255.255.255: a multicast group.");
    v.integer("port", port, {0, 65535}, "UDP port; 0: any that is free, which is told.");
  }
};

MadeTracker make_udp_tracker(const TrackerRequest& request, const hal::Log& log);
hal::Status check_udp_tracker(const TrackerRequest& request);

}  // namespace tandem::bridges::trackers
