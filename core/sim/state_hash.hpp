// A fingerprint of the simulated state.
#pragma once
#include <cstdint>

#include "core/space/stores.hpp"
#include "hal/time.hpp"

namespace tandem::core {

/// Of everything that later steps depend on and that the stores hold: bodies, ports, objects, joints, what hooks
/// changed.
std::uint64_t hash_of_state(const SpaceStores& stores, std::uint64_t seed, hal::Tick tick) noexcept;

}  // namespace tandem::core
