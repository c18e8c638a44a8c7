// Runs in lock-step, for the commands: who takes part, and what the report says of it.
#pragma once
#include <atomic>
#include <memory>

#include "core/sim/world.hpp"
#include "hal/catalog.hpp"
#include "hal/json/json.hpp"
#include "hal/log.hpp"
#include "mixed_reality/lockstep/lockstep.hpp"

namespace tandem::app {

/// Where a world's peers take part, all of them there; null when it has none, or nobody waits for them. `code` is not
/// kDone when they cannot, which was told. The world and the catalog must outlive the result.
std::unique_ptr<mixed_reality::LockstepRun> join_peers(core::World& world, const hal::Catalog& catalog,
                                                       const std::atomic<bool>& stop, const hal::Log& log, int& code);

hal::Json lockstep_json(const mixed_reality::LockstepReport& report);

}  // namespace tandem::app
