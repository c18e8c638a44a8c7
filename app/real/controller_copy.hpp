// Describes this program's copy of a controller, for the other side of a run in lock-step.
#pragma once
#include <vector>

#include "bridges/peer/controller_copy.hpp"
#include "core/scenario/scenario.hpp"
#include "hal/controller.hpp"
#include "hal/plugin_loader.hpp"
#include "hal/source_files.hpp"

namespace tandem::app {

/// `scripts`: that the controller runs. Digests of files that cannot be read are empty.
bridges::peer::ControllerCopy controller_copy(const hal::PluginLoader& loader, const core::ControllerConfig& config,
                                              const hal::ControllerType& type,
                                              const std::vector<hal::SourceFile>& scripts);

}  // namespace tandem::app
