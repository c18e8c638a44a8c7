// Runs in lock-step, for the commands: their participants, and their part of the report.
#pragma once
#include <atomic>
#include <memory>

#include "core/sim/world.hpp"
#include "hal/json/json.hpp"
#include "hal/log.hpp"
#include "hal/plugin_loader.hpp"
#include "mixed_reality/lockstep/lockstep.hpp"

namespace tandem::app {

/// Robots of the file whose controllers step elsewhere.
bool has_peers(const core::Scenario& scenario) noexcept;

/// Where a world's peers take part, not waited for yet. Errors: as LockstepRun::make. The world, the loader and `stop`
/// must outlive the result.
hal::Result<std::unique_ptr<mixed_reality::LockstepRun>> make_lockstep(core::World& world,
                                                                       const hal::PluginLoader& loader,
                                                                       const std::atomic<bool>& stop,
                                                                       const hal::Log& log);

/// The same, with all of them there; null when the world has none, or no run waits for them. `code` is not kDone when
/// they cannot, which was reported.
std::unique_ptr<mixed_reality::LockstepRun> join_peers(core::World& world, const hal::PluginLoader& loader,
                                                       const std::atomic<bool>& stop, const hal::Log& log, int& code);

hal::Json lockstep_json(const mixed_reality::LockstepReport& report);

}  // namespace tandem::app
