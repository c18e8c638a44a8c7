// An eye-bot that keeps its place: in its configuration, and pushed.
#include <cmath>

#include "core/space/stores.hpp"
#include "tests/checkout.hpp"
#include "tests/controllers/experiment.hpp"
#include "tests/controllers/test_robot.hpp"

namespace tandem {
namespace {

const std::string kParams = "controllers.eyebot_hover[hover].params.";

core::Pose pose_of(const test::Experiment& experiment) {
  const core::Space& space = experiment->space();
  return space.pose(space.find_robot("eb"));
}

TEST(EyebotHover, RisesKeepsItsPlaceAndLands) {
  const test::Experiment experiment("eyebot_hover.xml");
  experiment->start();
  double nearest_m = 1e9;
  double farthest_m = 0.0;
  for (int tick = 0; tick < 40 * 50; ++tick) {
    experiment->step();
    ASSERT_EQ(experiment->state(), core::RunState::Running) << experiment->failure();
    const core::Pose at = pose_of(experiment);
    const double off_m = std::hypot(at.x_m - 0.5, at.y_m, at.z_m - 1.5);
    nearest_m = std::min(nearest_m, off_m);
    if (tick > 10 * 50 && tick < 20 * 50) farthest_m = std::max(farthest_m, off_m);
  }
  EXPECT_LT(nearest_m, 0.02);
  EXPECT_LT(farthest_m, 0.1);
  EXPECT_NEAR(pose_of(experiment).z_m, 0.0, 5e-3) << "down again";
  EXPECT_NEAR(pose_of(experiment).x_m, 0.5, 0.2);
  EXPECT_NEAR(pose_of(experiment).heading_rad(), 30.0 / 180.0 * std::numbers::pi, 0.2);
}

TEST(EyebotHover, ComesBackWhenItIsPushed) {
  const test::Experiment experiment("eyebot_hover.xml", {kParams + "duration=0"});
  experiment->start();
  core::Space& space = experiment->space();
  const core::RobotId robot = space.find_robot("eb");
  for (int tick = 0; tick < 10 * 50; ++tick) experiment->step();
  core::Velocity blow;
  blow.v_m_s = {-1.0, 0.8, 0.4};
  ASSERT_TRUE(space.set_velocity(robot, blow).ok());
  for (int tick = 0; tick < 25; ++tick) experiment->step();
  EXPECT_GT(std::hypot(pose_of(experiment).x_m - 0.5, pose_of(experiment).y_m), 0.1);
  for (int tick = 0; tick < 10 * 50; ++tick) experiment->step();
  EXPECT_NEAR(pose_of(experiment).x_m, 0.5, 0.1);
  EXPECT_NEAR(pose_of(experiment).y_m, 0.0, 0.1);
  EXPECT_NEAR(pose_of(experiment).z_m, 1.5, 0.1);
}

TEST(EyebotHover, FliesInEveryEngineThatCan) {
  const test::Experiment experiment("eyebot_hover.xml", {"physics_engines.dynamics3d[dyn3d].flight=thrust"});
  experiment.run(40.0);
  EXPECT_NEAR(pose_of(experiment).z_m, 0.0, 5e-3);
}

TEST(EyebotHoverPlugin, SeesNoWorld) {
  test::expect_no_world_in(std::string(test::kBuildDir) + "/lib/libeyebot_hover.so");
}

}  // namespace
}  // namespace tandem
