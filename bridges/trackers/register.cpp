#include "bridges/trackers/register.hpp"

#include "bridges/trackers/lcm_tracker.hpp"
#include "bridges/trackers/udp_tracker.hpp"
#include "hal/element_options.hpp"

namespace tandem::bridges::trackers {
namespace {

const TrackerType kUdp{.name = "udp",
                       .summary = "Poses as UDP datagrams: lines of JSON, or a compact form.",
                       .make = &make_udp_tracker,
                       .check = &check_udp_tracker};
const TrackerType kLcm{.name = "lcm",
                       .summary = "Poses as LCM messages of the type tandem.poses_t.",
                       .make = &make_lcm_tracker,
                       .check = &check_lcm_tracker};

}  // namespace

void register_trackers(hal::Registrar& registrar) {
  registrar.add(kUdp);
  registrar.add(hal::element_options<UdpOptions>("tracker of udp"));
  registrar.add(kLcm);
  registrar.add(hal::element_options<LcmOptions>("tracker of lcm"));
}

}  // namespace tandem::bridges::trackers
