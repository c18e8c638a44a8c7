#include <cmath>

#include "tests/checkout.hpp"
#include "tests/controllers/experiment.hpp"
#include "tests/controllers/test_robot.hpp"

namespace tandem {
namespace {

using test::Experiment;

const std::string kConfig = "footbot_gripping.xml";

struct Fetched {
  double object_m;  ///< distance of the object from the robot's start
  double robot_m;   ///< … of the robot
  bool holding;
};

Fetched after(const Experiment& e, const std::string& robot, const std::string& object, double x_m, double y_m) {
  const core::Space& space = e->space();
  const core::Pose pose = space.pose(space.find_robot(robot));
  Fetched f{0.0, std::hypot(pose.x_m - x_m, pose.y_m - y_m), space.holding(space.find_robot(robot))};
  for (const core::Object& o : space.objects()) {
    if (o.id == object) f.object_m = std::hypot(o.x_m - x_m, o.y_m - y_m);
  }
  return f;
}

void expect_all_fetched(const Experiment& e) {
  const double starts_y_m[] = {2.0, 1.0, 0.0};
  const char* objects[] = {"box", "can", "brick"};
  for (int i = 0; i < 3; ++i) {
    const Fetched f = after(e, "fb" + std::to_string(i), objects[i], -1.0, starts_y_m[i]);
    EXPECT_LT(f.object_m, 0.25) << objects[i];
    EXPECT_LT(f.robot_m, 0.3) << objects[i];
    EXPECT_FALSE(f.holding) << objects[i];
  }
}

TEST(Gripping, BringsBoxesAndCansHomeInThePlane) {
  const Experiment e(kConfig);
  e.run(90.0);
  expect_all_fetched(e);
}

TEST(Gripping, BringsThemHomeInSpace) {
  const Experiment e(kConfig, {}, {}, "dynamics3d");
  e.run(90.0);
  expect_all_fetched(e);
}

TEST(Gripping, ComesHomeWithoutWhereThereIsNothingToGrip) {
  const Experiment e(kConfig);
  e.run(20.0);
  EXPECT_GT(after(e, "fb3", "wall", -1.0, -2.0).robot_m, 1.0);
  e.run(70.0);
  EXPECT_LT(after(e, "fb3", "wall", -1.0, -2.0).robot_m, 0.06);
}

TEST(Gripping, TurnsItsBodyBeneathWhatItHolds) {
  const Experiment e(kConfig);
  const core::Space& space = e->space();
  const core::RobotId robot = space.find_robot("fb1");
  e->start();
  double turned_rad = 0.0;
  for (int t = 0; t < 900; ++t) {
    e->step();
    if (space.holding(robot)) turned_rad = std::max(turned_rad, std::fabs(space.turret_rad(robot)));
  }
  EXPECT_GT(turned_rad, 2.8);  // what is held ends behind
}

TEST(Gripping, GivesTheSameBitsForTheSameSeedAndAnyNumberOfThreads) {
  const std::uint64_t once = test::fingerprint(kConfig, 60.0, test::seeded(5));
  EXPECT_EQ(test::fingerprint(kConfig, 60.0, test::seeded(5)), once);
  EXPECT_EQ(test::fingerprint(kConfig, 60.0, test::seeded(5, 2)), once);
}

TEST(GrippingPlugin, SeesNoWorld) {
  test::expect_no_world_in(std::string(test::kBuildDir) + "/lib/libfootbot_gripping.so");
}

}  // namespace
}  // namespace tandem
