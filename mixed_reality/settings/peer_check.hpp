// Checks of the peers of a run in lock-step before it begins.
#pragma once
#include "core/scenario/scenario.hpp"
#include "hal/element.hpp"

namespace tandem::mixed_reality {

/// What follows "emulated" in a link is the business of the robot's bridge.
inline constexpr std::string_view kEmulatedPeer = "emulated";
bool is_emulated(const core::PeerConfig& peer) noexcept;

/// Adds links that cannot be opened from here, and two peers behind one link.
void check_peers(const core::Scenario& scenario, core::Problems& problems);

}  // namespace tandem::mixed_reality
