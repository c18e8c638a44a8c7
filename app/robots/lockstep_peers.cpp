#include "app/robots/lockstep_peers.hpp"

#include <algorithm>

#include "app/options.hpp"
#include "app/process/terminal.hpp"
#include "app/robots/wired_peer.hpp"

namespace tandem::app {

std::unique_ptr<mixed_reality::LockstepRun> join_peers(core::World& world, const hal::Catalog& catalog,
                                                       const std::atomic<bool>& stop, const hal::Log& log, int& code) {
  const core::Scenario& scenario = world.scenario();
  const bool any =
      std::ranges::any_of(scenario.robots, [](const core::RobotItem& item) { return item.peer.has_value(); });
  if (scenario.time_mode != core::TimeMode::Lockstep || !any) return nullptr;
  mixed_reality::LockstepOptions options;
  options.log = log;
  options.stop = &stop;
  options.make_emulated = [&catalog, log](core::World& of, core::RobotId robot, const std::string& what) {
    return make_wired_peer(catalog, of, robot, what, log);
  };
  auto made = mixed_reality::LockstepRun::make(world, options);
  if (!made.ok()) {
    code = complain(kBadInput, made.error().message);
    return nullptr;
  }
  auto run = std::move(made).value();
  if (!run->address().empty()) log.info("peers connect to " + run->address());
  if (const hal::Status connected = run->connect(); !connected.ok()) {
    code = complain(kFailedRunning, connected.error().message);
    run->finish(true, connected.error().message);
  }
  return run;
}

hal::Json lockstep_json(const mixed_reality::LockstepReport& report) {
  hal::Json json = {{"waits", report.waits},
                    {"waited_s", hal::to_seconds(report.waited_ns)},
                    {"strangers", report.strangers},
                    {"peers", hal::Json::array()}};
  for (const mixed_reality::PartnerReport& p : report.peers) {
    json["peers"].push_back({{"robot", p.robot},
                             {"link", p.link},
                             {"state", p.state},
                             {"ticks", p.ticks},
                             {"doubled", p.doubled},
                             {"wrong_tick", p.wrong_tick},
                             {"not_understood", p.not_understood},
                             {"garbled", p.garbled},
                             {"asked_again", p.asked_again},
                             {"links_opened", p.links},
                             {"bytes_in", p.bytes_in},
                             {"bytes_out", p.bytes_out},
                             {"longest_wait_ms", static_cast<double>(p.longest_wait_ns) * 1e-6}});
  }
  return json;
}

}  // namespace tandem::app
