// The effective settings of a world: the experiment with the defaults of every part written out.
#pragma once
#include <cstdint>

#include "core/scenario/scenario.hpp"
#include "hal/plugin_loader.hpp"

namespace tandem::core {

/// Completes the elements of devices, controllers, engines and hooks with the defaults of these, and puts them in their
/// places in `scenario.effective`, with `seed` as the experiment's: run again, it gives the same bits. What no robot
/// uses is left as it is. Call once all parts have been made: libraries are open, and nothing is unknown.
void complete_settings(Scenario& scenario, hal::PluginLoader& loader, std::uint64_t seed);

}  // namespace tandem::core
