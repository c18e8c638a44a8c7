#include "app/real/file_controller.hpp"

#include "app/experiment/reading.hpp"

namespace tandem::app {

hal::Result<FileController> read_file_controller(const core::Scenario& scenario, const core::RobotItem& item,
                                                 const std::string& robot, hal::PluginLoader& loader) {
  FileController made;
  made.config = &scenario.controllers[item.controller];
  made.who = "controller '" + made.config->id + "' (library '" + made.config->library + "') of robot '" + robot + "'";
  const auto type = loader.controller(made.config->library, made.config->label);
  if (!type.ok()) return hal::Error{made.who + ": " + type.error().message};
  made.type = type.value();
  core::Problems problems;
  core::ElementReader reader(item.params ? *item.params : made.config->params, problems);
  made.params = made.type->read_params(reader);
  reader.finish();
  print_problems(problems);
  if (core::has_errors(problems)) return hal::Error{made.who + ": its parameters are wrong"};
  return made;
}

}  // namespace tandem::app
