// Worlds of robots under ARGoS controllers of the library test_argos_controllers.
#pragma once
#include <gtest/gtest.h>
#include <memory>
#include <string>
#include <vector>

#include "compat/argos3/register.hpp"
#include "core/config/reader.hpp"
#include "core/sim/world.hpp"
#include "tests/checkout.hpp"
#include "tests/core/catalog.hpp"

namespace tandem::test {

inline const hal::Catalog& argos_catalog() {
  static const hal::Catalog all = [] {
    hal::Catalog made = catalog();
    const hal::Status good = made.add_from(std::string(hal::Catalog::kInside), &app::register_argos3);
    TANDEM_CHECK(good.ok(), good.error().message.c_str());
    return made;
  }();
  return all;
}

struct Argos {
  std::string label;
  std::string robot = "e-puck";
  std::string sensors = "";
  std::string actuators = "<differential_steering implementation=\"ideal\"/>";
  std::string params = "<params/>";
  std::string more = "";  ///< of the arena
  std::string engine = "kinematics2d";
  int robots = 1;
  double apart_m = 0.5;
  std::int64_t threads = 1;
  std::string library = std::string(kBuildDir) + "/tests/argos/libtest_argos_controllers.so";
  std::string root = "tandem";
};

/// Roots of files: robots of ARGoS' have ports with more room, and no limit of wheels.
inline auto roots() {
  return testing::Values("tandem", "argos-configuration");
}
inline std::string root_name(const testing::TestParamInfo<const char*>& one) {
  return one.index == 0 ? "TandemFiles" : "ArgosFiles";
}

/// A world of such robots in a row along x, from 0 on.
class ArgosWorld {
 public:
  explicit ArgosWorld(const Argos& a) {
    std::string robots;
    for (int i = 0; i < a.robots; ++i)
      robots += "<" + a.robot + " id=\"r" + std::to_string(i) + "\"><body position=\"" +
                std::to_string(a.apart_m * (i % 30)) + "," + std::to_string(a.apart_m * (i / 30)) +
                ",0\"/><controller config=\"c\"/></" + a.robot + ">\n";
    const std::string text =
        "<" + a.root +
        "><framework><experiment length=\"0\" ticks_per_second=\"10\" random_seed=\"3\"/></framework>"
        "<controllers><" +
        a.label + " id=\"c\" library=\"" + a.library + "\"><actuators>" + a.actuators + "</actuators><sensors>" +
        a.sensors + "</sensors>" + a.params + "</" + a.label +
        "></controllers><arena size=\"40,40,6\" center=\"5,5,2\">" + robots + a.more + "</arena><physics_engines><" +
        a.engine + " id=\"e\"/></physics_engines><media><led id=\"leds\"/><range_and_bearing id=\"rab\"/></media></" +
        a.root + ">";
    loader_ = std::make_unique<hal::PluginLoader>(std::vector<std::filesystem::path>{std::string(kBuildDir) + "/lib"},
                                                  argos_catalog());
    core::WorldOptions options;
    options.threads = a.threads;
    options.log = hal::Log([this](hal::Severity severity, std::string_view message) {
      said += (severity == hal::Severity::Error ? "error: " : "") + std::string(message) + "\n";
    });
    core::Problems found;
    const auto scenario = core::read_experiment_text(text, "argos.xml", {}, argos_catalog(), found);
    if (scenario) world = core::World::make(*scenario, *loader_, options, found);
    for (const core::Problem& p : found) problems += core::to_text(p) + "\n";
  }
  ~ArgosWorld() { world.reset(); }
  ArgosWorld(const ArgosWorld&) = delete;
  ArgosWorld& operator=(const ArgosWorld&) = delete;

  /// So many steps; nothing may go wrong.
  void run(int steps) {
    ASSERT_NE(world, nullptr) << problems;
    for (int i = 0; i < steps; ++i) world->step();
    std::string all;
    for (const std::string& incident : world->incidents().first()) all += incident + "\n";
    EXPECT_EQ(world->incidents().controllers_thrown, 0U) << all;
  }
  /// What went wrong within so many steps.
  std::string incident(int steps = 1) {
    if (world == nullptr) return problems;
    for (int i = 0; i < steps; ++i) world->step();
    return world->incidents().first().empty() ? "none" : world->incidents().first().front();
  }

  std::string said, problems;

 private:
  std::unique_ptr<hal::PluginLoader> loader_;

 public:
  std::unique_ptr<core::World> world;
};

}  // namespace tandem::test
