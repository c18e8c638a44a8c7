// The effective settings of a world: the experiment with the defaults of every part written out.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/scenario/scenario.hpp"
#include "hal/plugin_loader.hpp"

namespace tandem::core {

/// Completes the elements of devices, controllers, engines and hooks with the defaults of these, and puts them in their
/// places in `scenario.effective`, with `seed` as the experiment's: run again, it gives the same bits. What no robot
/// uses is left as it is. Call once all parts have been made: libraries are open, and nothing is unknown.
void complete_settings(Scenario& scenario, hal::PluginLoader& loader, std::uint64_t seed);

/// Whether two elements say the same: attributes in any order, numbers by value ("0.1" and "0.10").
bool same_settings(const Element& a, const Element& b);

/// What differs between two experiments, both completed, that a running world cannot take over
/// (World::continue_with): paths as --set writes them, at most ten. Empty: nothing. `anew`: that a world which is made
/// anew cannot (World::load).
std::vector<std::string> fixed_differences(const Scenario& before, const Scenario& changed, bool anew = false);

}  // namespace tandem::core
