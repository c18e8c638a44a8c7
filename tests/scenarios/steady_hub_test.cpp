// Real robots among many simulated ones, for a while: no robot is stopped without a reason, and no deadline is missed
// but when the machine gave no processor. TANDEM_STEADY_MINUTES=10 runs 20 bridged and 1,000 simulated ones, at
// TANDEM_STEADY_HZ (50); without it a small run lasts some seconds.
//
// Two reasons there are, and both are measured (docs/decisions/late-answers-are-awaited.md). The robots are emulated on
// the same machine: one whose program was kept from running for longer than a robot may be silent was silent; its own
// log tells how late it was. And a hub whose loop was kept from running for half a second has no reading and no command
// younger than that: all its robots are stopped in the same tick.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <gmock/gmock.h>

#include "tests/scenarios/process.hpp"

namespace tandem::scenarios {
namespace {

/// A robot's word on how it was stopped.
struct Stops {
  int all = 0;        ///< how often it was told to rest after it had begun to drive, the end left out
  int explained = 0;  ///< of these, when it could not have answered
  int by_hub = 0;     ///< of the others, when the hub could not have commanded
};

using Late = EmulatedRobot::Late;

/// How long this robot's program was kept from running in the last half second, short delays left out.
double late_ms(const std::vector<Late>& lates, long long t_ns) {
  constexpr double kShort_ms = 50.0;
  double sum_ms = 0.0;
  for (const Late& late : lates) {
    const bool before = late.t_ns <= t_ns && late.t_ns > t_ns - 500'000'000;
    sum_ms += before && late.by_ms >= kShort_ms ? late.by_ms : 0.0;
  }
  return sum_ms;
}

int times_in(const std::string& text, const std::string& what) {
  int times = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++times;
  return times;
}

/// How often the report says of this robot, and in the same tick of most of the `robots`, that the hub was kept from
/// running: for a second and more, or for so long that the poses were half a second old.
int hub_stalls_of(const std::string& report, const std::string& id, int robots) {
  const std::string mark = "robot '" + id + "' ";
  int stalls = 0;
  for (std::size_t at = report.find(mark); at != std::string::npos; at = report.find(mark, at + 1)) {
    const std::size_t begin = at + mark.size();
    const std::string what = report.substr(begin, report.find('"', begin) - begin);
    const bool of_hub = what.ends_with(": hub was frozen") || what.ends_with(": pose stale");
    stalls += of_hub && 2 * times_in(report, "' " + what + "\"") > robots ? 1 : 0;
  }
  return stalls;
}

Stops stops_of(const EmulatedRobot& robot, int hub_stalls) {
  constexpr double kMayBeSilent_ms = 200.0;  // two questions of 100 ms each
  const std::vector<Late> lates = robot.lates();
  std::vector<long long> stopped;
  bool drives = false;
  for (const auto& w : robot.wheels()) {
    const bool now = w.left != 0 || w.right != 0;
    if (drives && !now) stopped.push_back(w.t_ns);
    drives = now;
  }
  if (!drives && !stopped.empty()) stopped.pop_back();  // the end
  Stops stops;
  for (const long long t_ns : stopped) {
    const double silent_ms = late_ms(lates, t_ns);
    std::printf("stopped at %.3f s, after it had been kept from running for %.0f ms\n",
                static_cast<double>(t_ns) * 1e-9, silent_ms);
    ++stops.all;
    stops.explained += silent_ms >= kMayBeSilent_ms ? 1 : 0;
  }
  stops.by_hub = std::min(stops.all - stops.explained, hub_stalls);
  return stops;
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

TEST(SteadyHub, IsToldByTheRobotHowLongItWasKeptFromRunning) {
  Folder folder;
  EmulatedEpuck robot(folder);
  ASSERT_TRUE(robot.ready());
  robot.signal(SIGSTOP);
  ASSERT_TRUE(eventually([&] { return robot.suspended(); }, 10.0));
  const auto begin = std::chrono::steady_clock::now();
  eventually([&] { return std::chrono::steady_clock::now() > begin + std::chrono::milliseconds(300); }, 10.0);
  robot.signal(SIGCONT);
  EXPECT_EQ(robot.end(), 0);
  double longest_ms = 0.0;
  for (const Late& late : robot.lates()) longest_ms = std::max(longest_ms, late.by_ms);
  EXPECT_GE(longest_ms, 280.0) << robot.log();
}

TEST(SteadyHub, StopsNoRobotWithoutAReason) {
  const char* wanted = std::getenv("TANDEM_STEADY_MINUTES");
  const double minutes = wanted == nullptr ? 0.1 : std::atof(wanted);
  const char* const hz = std::getenv("TANDEM_STEADY_HZ");
  const std::string ticks_per_second = hz == nullptr ? "50" : hz;
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
                "\" rearm=\"after 0.5 s\"/></e-puck>";
  }
  folder.write(
      "run.xml",
      "<tandem><framework><experiment length=\"0\" ticks_per_second=\"" + ticks_per_second +
          "\" random_seed=\"1\"/><time "
          "mode=\"realtime\"/></framework><controllers><drive id=\"d\" library=\"test_controllers\"><actuators>"
          "<differential_steering/></actuators><sensors/><params left=\"3 cm/s\" right=\"5 cm/s\"/></drive>"
          "<epuck_diffusion id=\"v\" "
          "library=\"epuck_diffusion\"><actuators><differential_steering/></actuators><sensors>"
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
  const std::string report = text_of(folder.path() / "r.json");
  Stops stops;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    EXPECT_EQ(robots[i]->end(), 0);
    EXPECT_TRUE(robots[i]->has_moved());
    const Stops its = stops_of(*robots[i], hub_stalls_of(report, "real" + std::to_string(i), bridged));
    stops.all += its.all;
    stops.explained += its.explained;
    stops.by_hub += its.by_hub;
  }
  std::printf(
      "%d real and %d simulated robots at %s Hz for %.1f min: %d stops, %d of robots that were kept from "
      "running, %d of a hub that was; %s of %s ticks late, %s of them because the machine gave no processor\n",
      bridged, simulated, ticks_per_second.c_str(), minutes, stops.all, stops.explained, stops.by_hub,
      json_value(report, "deadline_misses").c_str(), json_value(report, "steps").c_str(),
      json_value(report, "misses_by_machine").c_str());
  if (wanted != nullptr) {
    std::printf("%s\n", report.substr(report.find("\"pace\"")).substr(0, 6000).c_str());
    EXPECT_EQ(json_value(report, "deadline_misses"), json_value(report, "misses_by_machine"));
  }
  EXPECT_EQ(stops.all, stops.explained + stops.by_hub) << report.substr(0, report.find("\"settings\"")) << hub.errors();
}

}  // namespace
}  // namespace tandem::scenarios
