// Real robots that are ordered into one another and over a keep-out. The verdict comes from where emulated ones truly
// were.
#include <cmath>
#include <gtest/gtest.h>

#include "tests/scenarios/process.hpp"

namespace tandem::scenarios {
namespace {

constexpr double kRadius_m = 0.085036758;  // of a foot-bot

struct Truth {
  long long t_ns;
  double x_m, y_m;
};

/// Where an emulated robot was: it reckons from where it was switched on.
std::vector<Truth> truth(const EmulatedRobot& robot, double x_m, double y_m, double heading_rad) {
  std::vector<Truth> all;
  std::istringstream in(robot.log());
  const double c = std::cos(heading_rad), s = std::sin(heading_rad);
  for (std::string line; std::getline(in, line);) {
    if (json_value(line, "event") != "pose") continue;
    const double x = std::stod(json_value(line, "x_m")), y = std::stod(json_value(line, "y_m"));
    all.push_back({std::stoll(json_value(line, "t_ns")), x_m + c * x - s * y, y_m + s * x + c * y});
  }
  return all;
}

double place_at(const std::vector<Truth>& all, long long t_ns, double Truth::*coordinate) {
  std::size_t i = 0;
  while (i + 1 < all.size() && all[i + 1].t_ns <= t_ns) ++i;
  return all[i].*coordinate;
}

TEST(GuardedFootbots, NeitherTouchNorEnterAKeepOutHoweverTheyAreDriven) {
  Folder folder, folder0, folder1, folder2;
  const std::vector<std::string> poses = {"--poses", "50"};
  EmulatedFootbot fb0(folder0, poses, "tcp-listen:127.0.0.1:0"), fb1(folder1, poses, "tcp-listen:127.0.0.1:0"),
      fb2(folder2, poses, "tcp-listen:127.0.0.1:0");
  ASSERT_TRUE(fb0.ready() && fb1.ready() && fb2.ready());
  const auto robot = [](const char* id, const char* place, const EmulatedFootbot& emulated) {
    return "<foot-bot id=\"" + std::string(id) + "\"><body " + place + R"(/><controller config="d"/><bridge link=")" +
           emulated.link() + "\" map=\"" + test::kSourceDir + "/configs/footbot_map.xml\"/></foot-bot>\n";
  };
  folder.write("guarded.xml",
               R"(<tandem><framework><experiment length="6" ticks_per_second="10"/></framework><controllers>
<drive id="d" library="test_controllers"><actuators><differential_steering/></actuators><params left="0.25" right="0.25"/></drive>
</controllers><arena size="4,4,1">
)" + robot("fb0", R"(position="-0.5,0,0")", fb0) +
                   robot("fb1", R"(position="0.5,0,0" orientation="180,0,0")", fb1) +
                   robot("fb2", R"(position="-0.5,1,0")", fb2) + R"(</arena>
<safety><keep_out id="pillar" points="0,0.5 0.3,0.5 0.3,1.5 0,1.5"/></safety>
<physics_engines><kinematics2d id="k"/></physics_engines></tandem>)");
  Tandem run({"run", "guarded.xml", "--report", "r.json"}, folder.path());
  ASSERT_EQ(run.wait(60), 0) << run.errors();
  for (EmulatedFootbot* emulated : {&fb0, &fb1, &fb2}) emulated->end();

  const auto at0 = truth(fb0, -0.5, 0.0, 0.0), at1 = truth(fb1, 0.5, 0.0, std::acos(-1.0)),
             at2 = truth(fb2, -0.5, 1.0, 0.0);
  ASSERT_GT(std::min({at0.size(), at1.size(), at2.size()}), 100U);
  double nearest_m = 1.0, farthest_m = -1.0;
  for (const Truth& t : at0)
    nearest_m = std::min(
        nearest_m, std::hypot(t.x_m - place_at(at1, t.t_ns, &Truth::x_m), t.y_m - place_at(at1, t.t_ns, &Truth::y_m)));
  for (const Truth& t : at2) farthest_m = std::max(farthest_m, t.x_m);
  std::printf("nearest %.1f mm from touching; %.1f mm before the keep-out\n", (nearest_m - 2.0 * kRadius_m) * 1e3,
              (-kRadius_m - farthest_m) * 1e3);
  EXPECT_GE(nearest_m, 2.0 * kRadius_m);
  EXPECT_LE(nearest_m, 2.0 * kRadius_m + 0.08) << "they did meet";
  EXPECT_LE(farthest_m, -kRadius_m);
  EXPECT_GE(farthest_m, -kRadius_m - 0.06);
  const std::string report = text_of(folder.path() / "r.json");
  EXPECT_GT(std::stoi(json_value(report, "held_back_ticks")), 10) << report;
  EXPECT_EQ(json_value(report, "trespasses"), "0");
}

}  // namespace
}  // namespace tandem::scenarios
