// The controller that an experiment file gives one robot, outside a simulation.
#pragma once
#include <memory>
#include <string>

#include "core/scenario/scenario.hpp"
#include "hal/controller.hpp"
#include "hal/plugin_loader.hpp"
#include "hal/result.hpp"

namespace tandem::app {

/// Refers to the scenario and the loader, which must outlive it.
struct FileController {
  const core::ControllerConfig* config = nullptr;
  const hal::ControllerType* type = nullptr;
  std::shared_ptr<const void> params;
  std::string who;  ///< "controller 'walk' (library 'walk') of robot 'ep0'"
};

/// Loads the library and reads the parameters; problems with these are printed. Error: it cannot be made.
hal::Result<FileController> read_file_controller(const core::Scenario& scenario, const core::RobotItem& item,
                                                 const std::string& robot, hal::PluginLoader& loader);

}  // namespace tandem::app
