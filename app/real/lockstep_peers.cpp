#include "app/real/lockstep_peers.hpp"

#include <algorithm>

#include "app/exit_code.hpp"
#include "app/process/terminal.hpp"
#include "app/real/controller_copy.hpp"
#include "app/real/wired_peer.hpp"
#include "core/live/source_files.hpp"
#include "core/space/stores.hpp"

namespace tandem::app {

bool has_peers(const core::Scenario& scenario) noexcept {
  return scenario.time_mode == core::TimeMode::Lockstep &&
         std::ranges::any_of(scenario.robots, [](const core::RobotItem& item) { return item.peer.has_value(); });
}

hal::Result<std::unique_ptr<mixed_reality::LockstepRun>> make_lockstep(core::World& world,
                                                                       const hal::PluginLoader& loader,
                                                                       const std::atomic<bool>& stop,
                                                                       const hal::Log& log) {
  mixed_reality::LockstepOptions options;
  options.log = log;
  options.stop = &stop;
  options.make_emulated = [&loader, log](core::World& of, core::RobotId robot, const std::string& what) {
    return make_wired_peer(loader.catalog(), of, robot, what, log);
  };
  options.copy_of = [&loader](core::World& of, core::RobotId robot) {
    const core::SpaceStores& s = of.space().stores();
    const core::RobotGroup& group = s.groups[s.blocks[s.robots[robot.index].block].group];
    return controller_copy(loader, of.scenario().controllers[group.config], *group.controller,
                           core::source_files(of, robot));
  };
  return mixed_reality::LockstepRun::make(world, options);
}

std::unique_ptr<mixed_reality::LockstepRun> join_peers(core::World& world, const hal::PluginLoader& loader,
                                                       const std::atomic<bool>& stop, const hal::Log& log, int& code) {
  if (!has_peers(world.scenario())) return nullptr;
  auto made = make_lockstep(world, loader, stop, log);
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
    if (p.controller) {
      json["peers"].back()["controller"] = {{"differs", p.controller->differs},
                                            {"same", p.controller->same},
                                            {"not_compared", p.controller->not_compared}};
    }
  }
  return json;
}

}  // namespace tandem::app
