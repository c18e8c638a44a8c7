// Real robots at 50 Hz among many simulated ones, for a while: no robot is stopped without a reason.
// TANDEM_STEADY_MINUTES=10 runs 20 bridged and 1,000 simulated ones and permits none; without it a small run lasts some
// seconds.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <gmock/gmock.h>

#include "tests/scenarios/process.hpp"

namespace tandem::scenarios {
namespace {

/// How often it was told to rest after it had begun to drive, and before it was at rest for good.
int stops_of(const EmulatedRobot& robot) {
  int stops = 0;
  bool drives = false;
  for (const auto& w : robot.wheels()) {
    const bool now = w.left != 0 || w.right != 0;
    stops += drives && !now ? 1 : 0;
    drives = now;
  }
  return stops - 1;  // the end
}

/// Around 28 m by 18 m, closed at the corners: nobody leaves.
std::string walls() {
  const auto wall = [](const std::string& id, const std::string& size, const std::string& place) {
    return "<box id=\"" + id + "\" size=\"" + size + ",0.5\" movable=\"false\"><body position=\"" + place +
           ",0\"/></box>";
  };
  return wall("n", "30,0.2", "0,9.5") + wall("s", "30,0.2", "0,-9.5") + wall("e", "0.2,20", "14.2,0") +
         wall("w", "0.2,20", "-14.2,0");
}

TEST(SteadyHub, StopsNoRobotWithoutAReason) {
  const char* wanted = std::getenv("TANDEM_STEADY_MINUTES");
  const double minutes = wanted == nullptr ? 0.1 : std::atof(wanted);
  const int bridged = wanted == nullptr ? 4 : 20, simulated = wanted == nullptr ? 50 : 1000;
  Folder folder;
  ::setenv("XDG_RUNTIME_DIR", folder.path().c_str(), 1);
  std::vector<std::unique_ptr<Folder>> folders;
  std::vector<std::unique_ptr<EmulatedEpuck>> robots;
  std::string elements;
  for (int i = 0; i < bridged; ++i) {
    folders.push_back(std::make_unique<Folder>());
    robots.push_back(std::make_unique<EmulatedEpuck>(*folders.back()));
    ASSERT_TRUE(robots.back()->ready());
    elements += "<e-puck id=\"real" + std::to_string(i) + "\"><body position=\"12," + std::to_string(0.8 * i - 8.0) +
                ",0\"/><controller config=\"d\"/><bridge link=\"serial:" + (folders.back()->path() / "ep0").string() +
                "\"/></e-puck>";
  }
  folder.write(
      "run.xml",
      "<tandem><framework><experiment length=\"0\" ticks_per_second=\"50\" random_seed=\"1\"/><time "
      "mode=\"realtime\"/></framework><controllers><drive id=\"d\" library=\"test_controllers\"><actuators>"
      "<differential_steering/></actuators><sensors/><params left=\"3 cm/s\" right=\"5 cm/s\"/></drive>"
      "<epuck_diffusion id=\"v\" library=\"epuck_diffusion\"><actuators><differential_steering/></actuators><sensors>"
      "<proximity/></sensors></epuck_diffusion></controllers><arena size=\"30,20,1\" center=\"0,0,0.5\">" +
          walls() +
          "<distribute>"
          "<position method=\"uniform\" min=\"-14,-9,0\" max=\"10,9,0\"/><orientation method=\"uniform\" min=\"0,0,0\" "
          "max=\"360,0,0\"/><entity quantity=\"" +
          std::to_string(simulated) +
          "\" max_trials=\"100\"><e-puck id=\"v\"><controller config=\"v\"/></e-puck></entity></distribute>" +
          elements + "</arena><physics_engines><kinematics2d id=\"k\"/></physics_engines></tandem>");
  Tandem hub({"run", "run.xml", "--seconds", std::to_string(60.0 * minutes), "--report", "r.json"}, folder.path());
  EXPECT_EQ(hub.wait(60.0 * minutes * 2.0 + 60.0), 0) << hub.errors();
  int stops = 0;
  for (const auto& robot : robots) {
    EXPECT_EQ(robot->end(), 0);
    EXPECT_TRUE(robot->has_moved());
    stops += std::max(0, stops_of(*robot));
  }
  const std::string report = text_of(folder.path() / "r.json");
  std::printf("%d real and %d simulated robots at 50 Hz for %.1f min: %d stops, %s of %s ticks late\n", bridged,
              simulated, minutes, stops, json_value(report, "deadline_misses").c_str(),
              json_value(report, "steps").c_str());
  // The small run shares the machine.
  EXPECT_LE(stops, wanted == nullptr ? bridged : 0) << report;
}

}  // namespace
}  // namespace tandem::scenarios
