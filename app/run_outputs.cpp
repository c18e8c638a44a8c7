#include "app/run_outputs.hpp"

#include <filesystem>

#include "core/view/picture.hpp"

namespace tandem::app {
namespace {

namespace fs = std::filesystem;

struct Named {
  std::string what;
  std::string path;
};

std::string trajectory_path(const RunOptions& options, const core::Scenario& scenario) {
  if (!options.trajectory.empty()) return options.trajectory;
  return scenario.trajectory ? scenario.trajectory->path : "";
}

std::vector<Named> inputs_of(const core::Scenario& scenario) {
  std::vector<Named> inputs{{"experiment", scenario.file}};
  if (scenario.floor.source == "image") inputs.push_back({"floor's image", scenario.floor.path});
  for (const core::RobotItem& robot : scenario.robots) {
    if (robot.bridge && !robot.bridge->map.empty()) inputs.push_back({"robot's map", robot.bridge->map});
  }
  return inputs;
}

/// Also by another name, through links or folders; a file need not be there yet.
bool same_file(const std::string& a, const std::string& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error)) return fs::is_regular_file(a, error);
  const fs::path absolute_a = fs::weakly_canonical(fs::absolute(a, error), error);
  return !error && absolute_a == fs::weakly_canonical(fs::absolute(b, error), error) && !fs::exists(a, error);
}

}  // namespace

hal::Status check_output_paths(const RunOptions& options, const core::Scenario& scenario) {
  if (!options.picture.empty()) {
    const auto format = core::picture_format(options.picture);
    if (!format.ok()) return hal::Error{"--picture: " + format.error().message};
    if (const hal::Status renderer = core::can_render(format.value()); !renderer.ok()) return renderer;
  }
  std::vector<Named> outputs;
  for (const Named& output : {Named{"report", options.report}, Named{"picture", options.picture},
                              Named{"trajectory", trajectory_path(options, scenario)}}) {
    if (output.path.empty() || output.path == "-") continue;
    for (const Named& input : inputs_of(scenario)) {
      if (same_file(output.path, input.path))
        return hal::Error{"the " + output.what + " would overwrite the " + input.what + " '" + input.path +
                          "'; give it another name"};
    }
    for (const Named& other : outputs) {
      if (same_file(output.path, other.path))
        return hal::Error{"the " + output.what + " and the " + other.what + " would both be written to '" +
                          output.path + "'; give one of them another name"};
    }
    outputs.push_back(output);
  }
  return {};
}

hal::Result<RunOutputs> open_outputs(const RunOptions& options, const core::Scenario& scenario,
                                     const core::World& world) {
  RunOutputs outputs;
  for (const auto& [what, path, file] : {std::tuple{"report", &options.report, &outputs.report},
                                         std::tuple{"picture", &options.picture, &outputs.picture}}) {
    if (path->empty()) continue;
    auto opened = hal::OutputFile::open(*path, what);
    if (!opened.ok()) return opened.error();
    *file = std::move(opened).value();
  }
  if (const std::string path = trajectory_path(options, scenario); !path.empty()) {
    auto config = scenario.trajectory.value_or(core::TrajectoryConfig{{}, {"*"}, 1});
    config.path = path;
    auto opened = core::TrajectoryRecorder::open(config, world.space(), world.ticks_per_second());
    if (!opened.ok()) return opened.error();
    outputs.trajectory = std::move(opened).value();
  }
  return outputs;
}

}  // namespace tandem::app
