// What every engine promises of mirrored and turned scenes, and of runs on any number of threads.
#include "tests/core/physics/conformance/engines.hpp"

namespace tandem::core {
namespace {

using Symmetry = EveryEngine;

struct Start {
  double x_m, y_m, heading_rad, left_m_s, right_m_s;
};

/// Robots that meet at angles, slide along a box and stand in each other's way, over a few seconds.
const std::vector<Start> kMeeting = {{-0.25, 0.02, 0.1, 0.1, 0.1},
                                     {0.2, -0.03, 3.0, 0.08, 0.09},
                                     {0.02, 0.3, -1.4, 0.12, 0.11},
                                     {0.3, 0.25, 1.0, 0.06, 0.06}};

Scene meeting(const std::string& kind, double turn_rad, bool mirrored) {
  Scene s(4.0);
  s.engine(kind);
  const double c = std::cos(turn_rad);
  const double n = std::sin(turn_rad);
  const double y = mirrored ? -1.0 : 1.0;
  int number = 0;
  for (const Start& a : kMeeting) {
    s.robot("r" + std::to_string(number++), c * a.x_m - n * y * a.y_m, n * a.x_m + c * y * a.y_m,
            y * a.heading_rad + turn_rad);
    s.wheels(mirrored ? a.right_m_s : a.left_m_s, mirrored ? a.left_m_s : a.right_m_s);
  }
  const double box_x_m = 0.35;
  const double box_y_m = 0.5;
  s.box(c * box_x_m - n * y * box_y_m, n * box_x_m + c * y * box_y_m, 0.3, 0.2, y * 0.3 + turn_rad);
  return s;
}

/// The largest distance between a robot and its image over `ticks`.
double largest_difference_m(const Scene& plain, const Scene& image, double turn_rad, bool mirrored, int ticks) {
  auto one = make(plain);
  auto other = make(image);
  EXPECT_TRUE(one.world && other.world) << one.all_problems() << other.all_problems();
  if (!one.world || !other.world) return 1e9;
  const double c = std::cos(turn_rad);
  const double n = std::sin(turn_rad);
  double largest = 0.0;
  for (int i = 0; i < ticks; ++i) {
    one->step();
    other->step();
    for (std::size_t r = 0; r < kMeeting.size(); ++r) {
      const Pose a = pose_of(one, "r" + std::to_string(r));
      const Pose b = pose_of(other, "r" + std::to_string(r));
      const double y_m = mirrored ? -a.y_m : a.y_m;
      largest = std::max(largest, std::hypot(c * a.x_m - n * y_m - b.x_m, n * a.x_m + c * y_m - b.y_m));
    }
  }
  return largest;
}

/// Contacts amplify what a library rounds or orders differently; bounded over the few seconds of a meeting.
double bar_m(const std::string& kind) {
  return kind == "kinematics2d" ? 1e-9 : 1e-3;
}

TEST_P(Symmetry, AMirroredSceneGivesMirroredTrajectories) {
  EXPECT_LT(largest_difference_m(meeting(GetParam(), 0.0, false), meeting(GetParam(), 0.0, true), 0.0, true, 60),
            bar_m(GetParam()));
}

TEST_P(Symmetry, ASceneTurnedByARightAngleGivesTurnedTrajectories) {
  for (const double turn_rad : {0.5 * std::numbers::pi, std::numbers::pi, -0.5 * std::numbers::pi}) {
    EXPECT_LT(largest_difference_m(meeting(GetParam(), 0.0, false), meeting(GetParam(), turn_rad, false), turn_rad,
                                   false, 60),
              bar_m(GetParam()))
        << turn_rad;
  }
}

TEST_P(Symmetry, TwoThatMeetHeadOnAreEachOthersMirrorImage) {
  auto world = make(scene().robot("a", -0.2, 0).wheels(0.1, 0.1).robot("b", 0.2, 0, std::numbers::pi).wheels(0.1, 0.1));
  ASSERT_TRUE(world.world) << world.all_problems();
  const double bar = GetParam() == "kinematics2d" ? 1e-9 : 1e-4;
  for (int i = 0; i < 100; ++i) {
    world->step();
    ASSERT_NEAR(pose_of(world, "a").x_m, -pose_of(world, "b").x_m, bar) << i;
    ASSERT_NEAR(pose_of(world, "a").y_m, -pose_of(world, "b").y_m, bar) << i;
  }
}

TEST_P(Symmetry, AMirroredArcIsTheArcOfTheMirroredWheels) {
  auto left = make(scene().robot("a", 0.1, 0.2, 0.3).wheels(0.05, 0.09));
  auto right = make(scene().robot("a", 0.1, -0.2, -0.3).wheels(0.09, 0.05));
  ASSERT_TRUE(left.world && right.world);
  for (int i = 0; i < 200; ++i) {
    left->step();
    right->step();
    ASSERT_NEAR(pose_of(left, "a").x_m, pose_of(right, "a").x_m, 1e-5) << i;
    ASSERT_NEAR(pose_of(left, "a").y_m, -pose_of(right, "a").y_m, 1e-5) << i;
  }
}

/// A crowd, with things to push where the engine pushes things.
Scene crowd(const std::string& kind, const std::string& regions) {
  Scene s(3.0, "epuck_diffusion", "epuck_diffusion");
  s.engine(kind);
  if (!regions.empty()) s.split(regions);
  s.walls().cylinder(0.3, 0.3, 0.1).box(-0.5, 0.4, 0.3, 0.2, 0.5).robots(150, 1.2);
  if (test::engine_traits(kind).forces)
    s.box(0.8, -0.6, 0.15, 0.15, 0.2).movable(0.2).cylinder(-0.8, -0.7, 0.08).movable(0.3);
  return s;
}

std::uint64_t hash_of(const Scene& s, std::int64_t threads, Assignment assignment, int ticks) {
  WorldOptions options;
  options.threads = threads;
  options.assignment = assignment;
  auto world = make(s, options);
  EXPECT_TRUE(world.world) << world.all_problems();
  if (!world.world) return 0;
  run(*world.world, ticks);
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
  return world->state_hash();
}

TEST_P(Symmetry, TheSameBitsForAnyNumberOfThreadsAndEitherAssignment) {
  for (const char* regions : {"", "3x2"}) {
    const Scene s = crowd(GetParam(), regions);
    const std::uint64_t alone = hash_of(s, 1, Assignment::Static, 40);
    EXPECT_EQ(hash_of(s, 1, Assignment::Static, 40), alone) << "a second time, regions " << regions;
    for (const std::int64_t threads : {0, 2, 3, 8}) {
      EXPECT_EQ(hash_of(s, threads, Assignment::Static, 40), alone) << threads << " threads, static, " << regions;
      EXPECT_EQ(hash_of(s, threads, Assignment::Dynamic, 40), alone) << threads << " threads, dynamic, " << regions;
    }
  }
}

TEST_P(Symmetry, AnotherSeedGivesAnotherRun) {
  Scene s = crowd(GetParam(), "");
  const std::uint64_t first = hash_of(s, 1, Assignment::Static, 10);
  s.scenario.seed = 8;
  EXPECT_NE(hash_of(s, 1, Assignment::Static, 10), first);
}

INSTANTIATE_TEST_SUITE_P(Physics, Symmetry, testing::ValuesIn(test::engine_kinds()), name_of_kind);

}  // namespace
}  // namespace tandem::core
