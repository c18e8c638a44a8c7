// A robot of a run in lock-step whose controller drives it through its bridge, a wire and its emulated firmware, all in
// this program.
#pragma once
#include <memory>
#include <string>

#include "core/sim/world.hpp"
#include "hal/log.hpp"
#include "hal/result.hpp"
#include "mixed_reality/lockstep/partner.hpp"

namespace tandem::app {

/// `what`: which firmware, as the kind's bridges::WiredType takes it. Errors: no such firmware, a controller that needs
/// a device which the bridge does not reach. `catalog` must outlive the result.
hal::Result<std::unique_ptr<mixed_reality::Partner>> make_wired_peer(const hal::Catalog& catalog, core::World& world,
                                                                     core::RobotId robot, const std::string& what,
                                                                     const hal::Log& log);

}  // namespace tandem::app
