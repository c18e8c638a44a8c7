// Worlds of robots under scripts that stand in the test.
#pragma once
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <memory>
#include <string>
#include <unistd.h>
#include <vector>

#include "core/config/reader.hpp"
#include "core/sim/world.hpp"
#include "tests/checkout.hpp"
#include "tests/core/catalog.hpp"

namespace tandem::test {

struct Script {
  std::string text;
  std::string robot = "e-puck";
  std::string sensors = "<epuck_proximity/><clock/>";
  std::string actuators = "<differential_steering implementation=\"ideal\"/>";
  std::string params = "";
  std::string file = "script.lua";  ///< that the experiment names
  std::string attributes = "";      ///< of the robot
  std::string more = "";            ///< of the arena
  std::string engine = "kinematics2d";
  int robots = 1;
  std::int64_t threads = 1;
  std::map<std::string, std::string> modules = {};  ///< other files beside the script
  std::string root = "tandem";                      ///< or "argos-configuration"
};

/// A world of such robots in a row along x, half a metre apart. The folder of the script goes with it.
class Scripted {
 public:
  explicit Scripted(const Script& script) {
    static int number = 0;
    folder_ = std::filesystem::path(::testing::TempDir()) /
              ("tandem_lua_" + std::to_string(getpid()) + "_" + std::to_string(number++));
    std::filesystem::create_directories(folder_);
    write("script.lua", script.text);
    for (const auto& [name, text] : script.modules) write(name, text);
    std::string robots;
    for (int i = 0; i < script.robots; ++i) {
      const std::string x = std::to_string(0.5 * (i % 20) - 5.0);
      const std::string y = std::to_string(0.5 * (i / 20) - 5.0);
      robots += "<" + script.robot + " id=\"r" + std::to_string(i) + "\" " + script.attributes + "><body position=\"" +
                x + "," + y + ",0\"/><controller config=\"c\"/></" + script.robot + ">\n";
    }
    const std::string text = "<" + script.root +
                             "><framework><experiment length=\"0\" ticks_per_second=\"10\" random_seed=\"3\"/>"
                             "</framework><controllers><lua_controller id=\"c\"><actuators>" +
                             script.actuators + "</actuators><sensors>" + script.sensors +
                             "</sensors><params script=\"" + script.file + "\" " + script.params +
                             "/></lua_controller></controllers><arena size=\"40,40,6\" center=\"0,0,2\">" + robots +
                             script.more + "</arena><physics_engines><" + script.engine +
                             " id=\"e\"/></physics_engines><media><led id=\"leds\"/></media></" + script.root + ">";
    loader_ = std::make_unique<hal::PluginLoader>(std::vector<std::filesystem::path>{std::string(kBuildDir) + "/lib"},
                                                  catalog());
    core::WorldOptions options;
    options.threads = script.threads;
    options.log = hal::Log([this](hal::Severity severity, std::string_view message) {
      said.emplace_back((severity == hal::Severity::Error ? "error: " : "") + std::string(message));
    });
    options.excess_log = hal::Log([this](hal::Severity, std::string_view message) { kept.emplace_back(message); });
    core::Problems found;
    const auto scenario = core::read_experiment_text(text, (folder_ / "experiment.xml").string(), {}, catalog(), found);
    if (scenario) world = core::World::make(*scenario, *loader_, options, found);
    for (const core::Problem& p : found) problems += core::to_text(p) + "\n";
  }
  ~Scripted() {
    world.reset();
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  Scripted(const Scripted&) = delete;
  Scripted& operator=(const Scripted&) = delete;

  /// So many steps; nothing may go wrong.
  void run(int steps) {
    ASSERT_NE(world, nullptr) << problems;
    for (int i = 0; i < steps; ++i) world->step();
    std::string all;
    for (const std::string& incident : world->incidents().first()) all += incident + "\n";
    EXPECT_EQ(world->incidents().controllers_thrown, 0U) << all;
  }
  /// The first incident after so many steps.
  std::string incident(int steps = 1) {
    if (world == nullptr) return problems;
    for (int i = 0; i < steps; ++i) world->step();
    return world->incidents().first().empty() ? "none" : world->incidents().first().front();
  }
  /// All incidents that are kept, without the folder, which is another one in every world.
  std::string incidents() const {
    std::string all;
    for (std::string one : world->incidents().first()) {
      for (std::size_t at = 0; (at = one.find(folder_.string() + "/")) != std::string::npos;)
        one.erase(at, folder_.string().size() + 1);
      all += one + "\n";
    }
    return all;
  }
  std::string log() const {
    std::string all;
    for (const std::string& one : said) all += one + "\n";
    return all;
  }

  std::string text_of(const std::string& name) const {
    std::ifstream file(folder_ / name);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void write(const std::string& name, const std::string& text) const {
    const std::filesystem::path path = folder_ / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text;
  }

  std::vector<std::string> said, kept;
  std::string problems;

 private:
  std::filesystem::path folder_;
  std::unique_ptr<hal::PluginLoader> loader_;

 public:
  std::unique_ptr<core::World> world;
};

}  // namespace tandem::test
