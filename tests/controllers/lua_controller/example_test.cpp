// The examples do what they are for.
#include "tests/controllers/experiment.hpp"

namespace tandem::test {
namespace {

/// Mean distance of the robots from the middle of them all.
double spread_m(const core::Space& space, double& middle_x_m) {
  double x = 0.0;
  double y = 0.0;
  const auto n = static_cast<double>(space.robot_count());
  for (std::size_t i = 0; i < space.robot_count(); ++i) {
    x += space.pose(space.robot(i)).x_m / n;
    y += space.pose(space.robot(i)).y_m / n;
  }
  double all = 0.0;
  for (std::size_t i = 0; i < space.robot_count(); ++i) {
    const core::Pose pose = space.pose(space.robot(i));
    all += std::hypot(pose.x_m - x, pose.y_m - y) / n;
  }
  middle_x_m = x;
  return all;
}

TEST(LuaExamples, SpreadsEpucks) {
  const Experiment experiment("epuck_diffusion_lua.xml");
  double x_m = 0.0;
  const double before_m = spread_m(experiment->space(), x_m);
  experiment.run(60.0);
  EXPECT_GT(spread_m(experiment->space(), x_m), 1.5 * before_m);
}

TEST(LuaExamples, KeepsFootBotsTogetherOnTheirWayToTheLight) {
  const Experiment experiment("footbot_flocking_lua.xml");
  double before_x_m = 0.0;
  spread_m(experiment->space(), before_x_m);
  experiment.run(60.0);
  double after_x_m = 0.0;
  EXPECT_LT(spread_m(experiment->space(), after_x_m), 2.0);
  EXPECT_LT(after_x_m, before_x_m - 0.5);
}

}  // namespace
}  // namespace tandem::test
