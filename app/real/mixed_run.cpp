#include "app/real/mixed_run.hpp"

#include "app/process/signals.hpp"
#include "app/real/hub_faults.hpp"
#include "mixed_reality/settings/tracker_check.hpp"

namespace tandem::app {

hal::Result<std::unique_ptr<mixed_reality::MixedSession>> make_session(const hal::Catalog& catalog,
                                                                       std::unique_ptr<core::World>& world,
                                                                       GuardedRobots& guarded,
                                                                       mixed_reality::TimeSource& clock,
                                                                       mixed_reality::MixedOptions options) {
  options.make_tracker = [&catalog, log = options.log, &scenario = world->scenario()](const core::TrackerItem& item) {
    return mixed_reality::make_tracker(catalog, mixed_reality::tracker_request(scenario, catalog, item), log);
  };
  options.unix_clock = &hub_unix_ns;
  options.freezes = [&guarded] { return guarded.freezes(); };
  options.guarded = [&guarded] { return guarded.guarded(); };
  options.rearm_asked = &rearm_asked();
  options.on_left_out = [&guarded](const bridges::RobotBridge& bridge) { guarded.remove(bridge); };
  options.on_joined = [&guarded](const bridges::RobotBridge& bridge) { return guarded.claim(bridge); };
  const auto maker = [&catalog, &guarded, log = options.log](const bridges::BridgeRequest& request) {
    bridges::BridgeRequest permitted = request;
    permitted.permit = guarded.permit();
    permitted.unix_clock = &hub_unix_ns;
    auto bridge = mixed_reality::make_bridge(catalog, permitted, log);
    if (bridge.ok()) guarded.add(**bridge);
    return bridge;
  };
  return mixed_reality::MixedSession::make(std::move(world), maker, clock, options);
}

}  // namespace tandem::app
