// Eye-bots that flock: distances, common way, bounds.
#include <cmath>

#include "tests/checkout.hpp"
#include "tests/controllers/experiment.hpp"
#include "tests/controllers/test_robot.hpp"

namespace tandem {
namespace {

const std::string kParams = "controllers.eyebot_flocking[flock].params.";

std::vector<core::Pose> poses_of(const test::Experiment& experiment) {
  const core::Space& space = experiment->space();
  std::vector<core::Pose> poses;
  for (std::size_t i = 0; i < space.robot_count(); ++i) poses.push_back(space.pose(space.robot(i)));
  return poses;
}

double distance_m(const core::Pose& a, const core::Pose& b) {
  return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m, a.z_m - b.z_m);
}

double to_nearest_m(const std::vector<core::Pose>& all, std::size_t i) {
  double nearest_m = 1e9;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (k != i) nearest_m = std::min(nearest_m, distance_m(all[i], all[k]));
  }
  return nearest_m;
}

double mean_x_m(const std::vector<core::Pose>& all) {
  double sum = 0.0;
  for (const core::Pose& pose : all) sum += pose.x_m;
  return sum / static_cast<double>(all.size());
}

TEST(EyebotFlocking, KeepsDistancesInSpaceAndFliesOnTogether) {
  const test::Experiment experiment("eyebot_flocking.xml");
  experiment.run(40.0);
  const auto before = poses_of(experiment);
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_GT(to_nearest_m(before, i), 0.6) << i;
    EXPECT_LT(to_nearest_m(before, i), 1.6) << i;
    EXPECT_GT(before[i].z_m, 0.8) << i;
    EXPECT_LT(before[i].z_m, 4.3) << i;
  }
  const auto [low, high] =
      std::minmax_element(before.begin(), before.end(), [](const auto& a, const auto& b) { return a.z_m < b.z_m; });
  EXPECT_GT(high->z_m - low->z_m, 0.8) << "a flock in space, not in a plane";
  for (int tick = 0; tick < 200; ++tick) experiment->step();
  const auto after = poses_of(experiment);
  EXPECT_GT(mean_x_m(after) - mean_x_m(before), 1.5) << "with 10 cm/s at least, for 20 s";
  EXPECT_EQ(experiment->state(), core::RunState::Running) << experiment->failure();
}

TEST(EyebotFlocking, ComesHome) {
  const test::Experiment experiment("eyebot_flocking.xml",
                                    {kParams + "drift=0,0,0", kParams + "home=3,0,0", kParams + "home_radius=2"});
  experiment.run(60.0);
  EXPECT_NEAR(mean_x_m(poses_of(experiment)), 3.0, 2.5);
}

TEST(EyebotFlocking, StaysInItsArenaHoweverLongItFlies) {
  const test::Experiment experiment("eyebot_flocking.xml");
  experiment.run(400.0);
  EXPECT_EQ(experiment->state(), core::RunState::Running) << experiment->failure();
  EXPECT_EQ(experiment->incidents().bodies_escaped, 0U);
}

TEST(EyebotFlocking, TheSameForAnyNumberOfThreads) {
  const std::uint64_t alone = test::fingerprint("eyebot_flocking.xml", 15.0, test::seeded(3, 0));
  EXPECT_EQ(test::fingerprint("eyebot_flocking.xml", 15.0, test::seeded(3, 2)), alone);
  EXPECT_EQ(test::fingerprint("eyebot_flocking.xml", 15.0, test::seeded(3, 5)), alone);
}

TEST(EyebotFlockingPlugin, SeesNoWorld) {
  test::expect_no_world_in(std::string(test::kBuildDir) + "/lib/libeyebot_flocking.so");
}

}  // namespace
}  // namespace tandem
