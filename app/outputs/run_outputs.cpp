#include "app/outputs/run_outputs.hpp"

#include "app/outputs/report.hpp"
#include "app/process/signals.hpp"
#include "app/process/terminal.hpp"
#include "core/view/picture.hpp"
#include "mixed_reality/settings/bridge_request.hpp"

namespace tandem::app {
namespace {

std::string trajectory_path(const RunOptions& options, const core::Scenario& scenario) {
  if (!options.trajectory.empty()) return options.trajectory;
  return scenario.trajectory ? scenario.trajectory->path : "";
}

std::string record_path(const RunOptions& options, const core::Scenario& scenario) {
  return options.record.empty() ? scenario.record.path : options.record;
}

std::vector<NamedFile> inputs_of(const core::Scenario& scenario, const hal::Catalog& catalog) {
  std::vector<NamedFile> inputs{{"experiment", scenario.file}};
  for (const core::Element& field : scenario.fields) {
    const std::string* path = field.attribute("path");
    if (path != nullptr && !path->empty()) inputs.push_back({"file of the " + field.name, *path});
  }
  for (const core::KindConfig& kind : scenario.kinds) inputs.push_back({"file of the " + kind.kind->name, kind.file});
  for (const core::RobotItem& robot : scenario.robots) {
    if (!robot.bridge) continue;
    for (const auto& [what, path] :
         mixed_reality::bridge_inputs(catalog, mixed_reality::bridge_request(scenario, robot, 0)))
      inputs.push_back({what, path});
  }
  return inputs;
}

/// The layers over pictures. Error: there is none of a name, or it draws nothing.
hal::Result<std::unique_ptr<core::LayerSet>> layers_of(const PictureRequest& request, const hal::Catalog& catalog) {
  if (request.picture.empty() && request.film.empty())
    return hal::Error{"--picture-layers needs --picture or --film: what the layers are drawn over"};
  auto layers = std::make_unique<core::LayerSet>(
      catalog, hal::Log([](hal::Severity, std::string_view text) { complain(kFailedRunning, std::string(text)); }));
  if (const hal::Status on = layers->switch_on(request.layers); !on.ok())
    return hal::Error{"--picture-layers: " + on.error().message};
  for (const std::size_t i : layers->on()) {
    if (!layers->types()[i]->draws)
      return hal::Error{"--picture-layers: the layer '" + std::string(layers->types()[i]->name) +
                        "' has a panel alone; pictures show what layers draw"};
  }
  return layers;
}

}  // namespace

hal::Status check_output_paths(const RunOptions& options, const core::Scenario& scenario, const hal::Catalog& catalog) {
  if (const hal::Status pictures = check_pictures(options.pictures); !pictures.ok()) return pictures;
  std::vector<NamedFile> outputs = {{"report", options.report},
                                    {"picture", options.pictures.picture},
                                    {"picture by POV-Ray", options.pictures.povray},
                                    {"trajectory", trajectory_path(options, scenario)},
                                    {"record", record_path(options, scenario)},
                                    {"dump", options.dump},
                                    {"checkpoint", options.checkpoint},
                                    {"log", options.log}};
  if (options.pictures.povray.ends_with(".png")) outputs.push_back({"scene", scene_of(options.pictures.povray)});
  if (!options.pictures.film.ends_with('/')) outputs.push_back({"film", options.pictures.film});
  for (const std::int64_t tick : options.pictures.at)
    outputs.push_back({"picture at tick " + std::to_string(tick), picture_at(options.pictures.picture, tick)});
  for (const core::Element& observer : scenario.observers) {
    if (const std::string* path = observer.attribute("path"); path != nullptr)
      outputs.push_back({"file of the observer <" + observer.name + ">", *path});
  }
  return check_apart(outputs, inputs_of(scenario, catalog));
}

bool tells_files(const RunOptions& options, const core::Scenario& scenario) {
  return !options.report.empty() || !record_path(options, scenario).empty() || !options.checkpoint.empty() ||
         !options.resume.empty();
}

hal::Result<RunOutputs> open_outputs(const RunOptions& options, const core::Scenario& scenario,
                                     const core::World& world, const hal::Catalog& catalog,
                                     const std::function<hal::Json()>& record_start, std::int64_t steps) {
  RunOutputs outputs;
  const core::Space& space = world.space();
  const core::PictureLook::Area arena{
      space.arena_center_x_m() - 0.5 * space.arena_size_x_m(), space.arena_center_y_m() - 0.5 * space.arena_size_y_m(),
      space.arena_center_x_m() + 0.5 * space.arena_size_x_m(), space.arena_center_y_m() + 0.5 * space.arena_size_y_m()};
  auto look = look_of(options.pictures, arena);
  if (!look.ok()) return look.error();
  outputs.look = look.value();
  if (Pictures::asked(options.pictures)) {
    auto pictures = Pictures::open(options.pictures, look.value(), world.ticks_per_second(), steps, catch_signals());
    if (!pictures.ok()) return pictures.error();
    outputs.pictures = std::move(pictures).value();
  }
  if (!options.pictures.layers.empty()) {
    auto layers = layers_of(options.pictures, catalog);
    if (!layers.ok()) return layers.error();
    outputs.layers = std::move(layers).value();
  }
  outputs.povray = options.pictures.povray;
  const std::string scene = outputs.povray.empty() ? std::string() : scene_of(outputs.povray);
  for (const auto& [what, path, file] : {std::tuple{"report", &options.report, &outputs.report},
                                         std::tuple{"picture", &options.pictures.picture, &outputs.picture},
                                         std::tuple{"scene", &scene, &outputs.scene}}) {
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
