// Runs in which real robots take part, as commands make them: guardian, bridges, trackers, signals.
#pragma once
#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "app/experiment/reading.hpp"
#include "app/real/guarded_robots.hpp"
#include "core/sim/world.hpp"
#include "hal/catalog.hpp"
#include "hal/log.hpp"
#include "mixed_reality/session/mixed_session.hpp"

namespace tandem::app {

/// Completes `options` (trackers, clock, guardian) and makes the session; takes `world` over. The references must
/// outlive it. Error: as MixedSession::make.
hal::Result<std::unique_ptr<mixed_reality::MixedSession>> make_session(const hal::Catalog& catalog,
                                                                       std::unique_ptr<core::World>& world,
                                                                       GuardedRobots& guarded,
                                                                       mixed_reality::TimeSource& clock,
                                                                       mixed_reality::MixedOptions options);

}  // namespace tandem::app
