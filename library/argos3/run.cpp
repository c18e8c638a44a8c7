// Runs that programs written for ARGoS 3 step through its CSimulator.
#include <algorithm>
#include <iostream>
#include <optional>

#include "app/catalog.hpp"
#include "app/experiment/plugin_folders.hpp"
#include "app/module/modules.hpp"
#include "compat/argos3/simulator/own_run.hpp"
#include "library/open_world.hpp"

namespace tandem::library {
namespace {

namespace argos3 = compat::argos3;

void tell(hal::Severity severity, std::string_view text) {
  if (severity != hal::Severity::Info) std::cerr << (severity == hal::Severity::Error ? "error: " : "warning: ");
  std::cerr << text << std::endl;
}

class ArgosRun final : public argos3::OwnRun {
 public:
  ArgosRun() : loader_(app::plugin_folders(), app::catalog(), app::on_demand()) {}

  std::string open(const std::string& file, std::optional<std::uint64_t> seed) {
    core::Problems problems;
    auto scenario = read_scenario(loader_, {.file = file}, problems);
    if (scenario) {
      fit_hooks(*scenario);
      core::WorldOptions options;
      options.seed = seed;
      options.log = hal::Log(&tell);
      world_ = core::World::make(*scenario, loader_, options, problems);
    }
    std::string errors;
    for (const core::Problem& problem : problems) {
      if (problem.warning) std::cerr << core::to_text(problem) << std::endl;
      if (!problem.warning) errors += (errors.empty() ? "" : "\n") + core::to_text(problem);
    }
    if (world_ == nullptr) return errors;
    world_->start();
    return world_->failure();
  }

  std::string step() override {
    world_->step();
    return world_->failure();
  }
  std::string reset(std::uint64_t seed) override {
    const hal::Status begun = world_->reset(seed);
    return begun.ok() ? world_->failure() : begun.error().message;
  }

 private:
  /// Such programs have no view.
  static void fit_hooks(core::Scenario& scenario) {
    std::erase_if(scenario.hooks, [](const core::HookConfig& hook) { return hook.label.starts_with("qt-opengl "); });
  }

  hal::PluginLoader loader_;  // outlives the world
  std::unique_ptr<core::World> world_;
};

}  // namespace
}  // namespace tandem::library

/// compat/argos3/simulator/own_run.hpp
extern "C" __attribute__((visibility("default"))) tandem::compat::argos3::OwnRun* tandem_argos3_open_run(
    const char* file, const std::uint64_t* seed, std::string& why) {
  auto run = std::make_unique<tandem::library::ArgosRun>();
  why = run->open(file, seed == nullptr ? std::nullopt : std::optional<std::uint64_t>(*seed));
  return why.empty() ? run.release() : nullptr;
}
