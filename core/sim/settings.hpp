// The effective settings of a world: the experiment with the defaults of every part written out.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/scenario/scenario.hpp"
#include "hal/plugin_loader.hpp"

namespace tandem::core {

/// Completes the elements of devices, controllers, engines and hooks with the defaults of these, and puts them in their
/// places in `scenario.effective`, with `seed` as the experiment's: run again, it gives the same bits. What no robot
/// uses is left as it is. Call once all parts have been made: libraries are open, and nothing is unknown.
void complete_settings(Scenario& scenario, hal::PluginLoader& loader, std::uint64_t seed);

/// Adds the hooks that come with the controllers (HookType::comes_with), where they are not there.
void add_implied_hooks(Scenario& scenario, hal::PluginLoader& loader);

/// Whether two elements say the same: attributes in any order, numbers by value ("0.1" and "0.10").
bool same_settings(const Element& a, const Element& b);

/// What differs between two experiments, both completed, that a world cannot take over on its way
/// (World::continue_with, World::load): paths as --set writes them, at most ten. Empty: nothing. `in_slots`: robots
/// stay in their slots, and so with their configurations.
std::vector<std::string> fixed_differences(const Scenario& before, const Scenario& changed, bool in_slots = false);

/// The path of the seed among them: only a world that is made again can have another.
inline constexpr std::string_view kSeedPath = "framework.experiment.random_seed";

/// The errors among them, each with its line, in one text.
std::string errors_of(const Problems& problems);

/// Whether two experiments say the same of the field of that name.
bool same_field(const Scenario& a, const Scenario& b, std::string_view name);

}  // namespace tandem::core
