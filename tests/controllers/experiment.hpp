// Experiments of configs/ as worlds, for tests of controllers and hooks.
#pragma once
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <memory>
#include <sstream>
#include <string>
#include <unistd.h>
#include <vector>

#include "core/config/reader.hpp"
#include "core/sim/world.hpp"
#include "tests/checkout.hpp"
#include "tests/core/catalog.hpp"

namespace tandem::test {

inline core::WorldOptions seeded(std::uint64_t seed, std::int64_t threads = 0) {
  core::WorldOptions options;
  options.seed = seed;
  options.threads = threads;
  return options;
}

/// An experiment of configs/ with some values set, in another engine where one is named, and the loader that must
/// outlive its world.
struct Experiment {
  std::unique_ptr<hal::PluginLoader> loader;
  std::unique_ptr<core::World> world;

  explicit Experiment(const std::string& config, const std::vector<std::string>& overrides = {},
                      const core::WorldOptions& options = {}, const std::string& engine = "",
                      const hal::Catalog& parts = catalog())
      : loader(std::make_unique<hal::PluginLoader>(
            std::vector<std::filesystem::path>{std::string(test::kBuildDir) + "/lib"}, parts)) {
    core::Problems problems;
    auto scenario =
        core::read_experiment(std::string(test::kSourceDir) + "/configs/" + config, overrides, parts, problems);
    if (scenario && !engine.empty()) {
      scenario->engines.at(0).kind = engine;
      scenario->engines.at(0).options.name = engine;
    }
    if (scenario) world = core::World::make(*scenario, *loader, options, problems);
    for (const core::Problem& p : problems) ADD_FAILURE() << core::to_text(p);
    if (world == nullptr) throw std::runtime_error(config + " does not load");
  }

  core::World* operator->() const { return world.get(); }
  /// The whole experiment, `seconds` long; it must not fail.
  void run(double seconds) const {
    world->start();
    const auto ticks = static_cast<hal::Tick>(seconds * static_cast<double>(world->ticks_per_second()));
    for (hal::Tick t = 0; t < ticks; ++t) world->step();
    world->finish();
    EXPECT_EQ(world->failure(), "");
    EXPECT_EQ(world->incidents().controllers_thrown, 0U);
  }
};

/// Fingerprint of the experiment after `seconds`.
inline std::uint64_t fingerprint(const std::string& config, double seconds, const core::WorldOptions& options) {
  const Experiment experiment(config, {}, options);
  experiment.run(seconds);
  return experiment->state_hash();
}

/// A path in the folder for temporary files, of this process alone.
inline std::string temporary(const std::string& name) {
  return (std::filesystem::path(::testing::TempDir()) / ("tandem_" + std::to_string(getpid()) + "_" + name)).string();
}

/// Rows of numbers below the header of a CSV file.
inline std::vector<std::vector<double>> rows_of(const std::string& csv) {
  std::ifstream in(csv);
  std::vector<std::vector<double>> rows;
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    std::istringstream cells(line);
    rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(std::stod(cell));
  }
  return rows;
}

}  // namespace tandem::test
