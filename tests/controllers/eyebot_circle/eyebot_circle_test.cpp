// An eye-bot that flies circles, and foot-bots that follow it, in two engines.
#include <cmath>

#include "tests/checkout.hpp"
#include "tests/controllers/experiment.hpp"
#include "tests/controllers/test_robot.hpp"

namespace tandem {
namespace {

core::Pose pose_of(const test::Experiment& experiment, const std::string& id) {
  const core::Space& space = experiment->space();
  return space.pose(space.find_robot(id));
}

TEST(EyebotCircle, FliesItsCircleAndIsFollowed) {
  const test::Experiment experiment("eyebot_circle.xml");
  experiment->start();
  double turned_rad = 0.0;
  double last_rad = 0.0;
  double worst_m = 0.0;
  double followers_m = 0.0;
  int counted = 0;
  for (int tick = 0; tick < 1200; ++tick) {
    experiment->step();
    ASSERT_EQ(experiment->state(), core::RunState::Running) << experiment->failure();
    if (tick < 400) continue;
    const core::Pose at = pose_of(experiment, "eb");
    worst_m = std::max({worst_m, std::fabs(std::hypot(at.x_m, at.y_m) - 1.5), std::fabs(at.z_m - 1.2)});
    const double angle_rad = std::atan2(at.y_m, at.x_m);
    if (tick > 400) turned_rad += std::remainder(angle_rad - last_rad, 2.0 * std::numbers::pi);
    last_rad = angle_rad;
    for (int i = 0; i < 4; ++i) {
      const core::Pose below = pose_of(experiment, "fb" + std::to_string(i));
      followers_m += std::hypot(below.x_m - at.x_m, below.y_m - at.y_m);
      ++counted;
    }
  }
  EXPECT_LT(worst_m, 0.05);
  EXPECT_NEAR(turned_rad, 0.08 * 79.9 / 1.5, 0.1) << "8 cm/s along it";
  EXPECT_LT(followers_m / counted, 0.7) << "they keep 20 cm, and clear of one another";
}

TEST(FootbotFollow, StandsStillWhileNobodyCalls) {
  const test::Experiment experiment("eyebot_circle.xml",
                                    {"controllers.eyebot_circle[circle].params.center=100,0,1.2", "arena.escape=stop"});
  experiment->start();
  for (int tick = 0; tick < 50; ++tick) experiment->step();
  const core::Pose early = pose_of(experiment, "fb0");
  for (int tick = 0; tick < 400; ++tick) experiment->step();
  const core::Pose late = pose_of(experiment, "fb0");
  for (int tick = 0; tick < 50; ++tick) experiment->step();
  EXPECT_NE(early.x_m, late.x_m) << "it followed while it heard";
  EXPECT_NEAR(pose_of(experiment, "fb0").x_m, late.x_m, 1e-3) << "the eye-bot is out of reach";
}

TEST(EyebotCircle, TheSameForAnyNumberOfThreads) {
  const std::uint64_t alone = test::fingerprint("eyebot_circle.xml", 20.0, test::seeded(3, 0));
  EXPECT_EQ(test::fingerprint("eyebot_circle.xml", 20.0, test::seeded(3, 2)), alone);
  EXPECT_EQ(test::fingerprint("eyebot_circle.xml", 20.0, test::seeded(3, 5)), alone);
}

TEST(EyebotCirclePlugins, SeeNoWorld) {
  for (const char* name : {"eyebot_circle", "footbot_follow"})
    test::expect_no_world_in(std::string(test::kBuildDir) + "/lib/lib" + name + ".so");
}

}  // namespace
}  // namespace tandem
