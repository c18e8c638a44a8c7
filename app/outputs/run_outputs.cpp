#include "app/outputs/run_outputs.hpp"

#include "app/outputs/report.hpp"
#include "app/process/terminal.hpp"

namespace tandem::app {
namespace {

std::string trajectory_path(const RunOptions& options, const core::Scenario& scenario) {
  if (!options.trajectory.empty()) return options.trajectory;
  return scenario.trajectory ? scenario.trajectory->path : "";
}

std::string record_path(const RunOptions& options, const core::Scenario& scenario) {
  return options.record.empty() ? scenario.record.path : options.record;
}

std::vector<NamedFile> inputs_of(const core::Scenario& scenario) {
  std::vector<NamedFile> inputs{{"experiment", scenario.file}};
  for (const core::Element& field : scenario.fields) {
    const std::string* path = field.attribute("path");
    if (path != nullptr && !path->empty()) inputs.push_back({"file of the " + field.name, *path});
  }
  for (const core::KindConfig& kind : scenario.kinds) inputs.push_back({"file of the " + kind.kind->name, kind.file});
  return inputs;
}

}  // namespace

hal::Status check_output_paths(const RunOptions& options, const core::Scenario& scenario,
                               std::vector<NamedFile> outputs, const std::vector<NamedFile>& inputs) {
  for (NamedFile file :
       {NamedFile{"report", options.report}, NamedFile{"trajectory", trajectory_path(options, scenario)},
        NamedFile{"record", record_path(options, scenario)}, NamedFile{"dump", options.dump},
        NamedFile{"checkpoint", options.checkpoint}, NamedFile{"log", options.log}})
    outputs.push_back(std::move(file));
  for (const core::Element& observer : scenario.observers) {
    if (const std::string* path = observer.attribute("path"); path != nullptr)
      outputs.push_back({"file of the observer <" + observer.name + ">", *path});
  }
  std::vector<NamedFile> all = inputs_of(scenario);
  all.insert(all.end(), inputs.begin(), inputs.end());
  return check_apart(outputs, all);
}

bool tells_files(const RunOptions& options, const core::Scenario& scenario) {
  return !options.report.empty() || !record_path(options, scenario).empty() || !options.checkpoint.empty() ||
         !options.resume.empty();
}

hal::Result<RunOutputs> open_outputs(const RunOptions& options, const core::Scenario& scenario,
                                     const core::World& world, const std::function<hal::Json()>& record_start) {
  RunOutputs outputs;
  if (!options.report.empty()) {
    auto opened = hal::OutputFile::open(options.report, "report");
    if (!opened.ok()) return opened.error();
    outputs.report = std::move(opened).value();
  }
  if (const std::string path = trajectory_path(options, scenario); !path.empty()) {
    auto config = scenario.trajectory.value_or(core::TrajectoryConfig{{}, {"*"}, 1});
    config.path = path;
    auto opened = core::TrajectoryRecorder::open(config, world.space(), world.ticks_per_second());
    if (!opened.ok()) return opened.error();
    outputs.trajectory = std::move(opened).value();
  }
  if (const std::string path = record_path(options, scenario); !path.empty()) {
    core::RecordConfig config = scenario.record;
    config.path = path;
    auto opened = core::Recorder::open(config, world.space(), record_start());
    if (!opened.ok()) return opened.error();
    outputs.record = std::move(opened).value();
  }
  if (!options.dump.empty()) {
    auto opened = StateDump::open(options.dump, options.dump_every);
    if (!opened.ok()) return opened.error();
    outputs.dump = std::move(opened).value();
  }
  return outputs;
}

}  // namespace tandem::app
