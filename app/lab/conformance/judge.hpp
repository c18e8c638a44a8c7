// Judges the entries of a plug-in: by its tables, and in small worlds.
#pragma once
#include <string>

#include "app/lab/conformance/judgement.hpp"
#include "hal/plugin_loader.hpp"

namespace tandem::app {

/// All entries of the library with the resolved path `origin`, which `loader` has opened. `loader` knows the probe.
Judgements judge_plugin(hal::PluginLoader& loader, const std::string& origin);

/// The parts of it, each adding what it finds.
void judge_tables(const hal::PluginLoader& loader, const std::string& origin, Judgements& all);
void judge_in_worlds(hal::PluginLoader& loader, const std::string& origin, Judgements& all);

}  // namespace tandem::app
