// What every engine promises of robots that run into walls, into one another, and into robots that others move.
#include <random>

#include "tests/core/physics/conformance/engines.hpp"

namespace tandem::core {
namespace {

using Contact = EveryEngine;

constexpr double kAtRest_m = 1e-4;  // moved in a tick by a robot that counts as resting

TEST_P(Contact, AWallStopsARobotAndGivesNothingBack) {
  for (const double speed_m_s : {0.03, 0.1288}) {
    auto world = make(scene().box(0.5, 0, 0.2, 2.0).robot("a", 0, 0).wheels(speed_m_s, speed_m_s));
    ASSERT_TRUE(world.world) << world.all_problems();
    const double stop_m = 0.4 - kRobotRadius_m;
    bool touched = false;
    for (int i = 0; i < 250; ++i) {
      world->step();
      const double x_m = pose_of(world, "a").x_m;
      ASSERT_LT(x_m, stop_m + 0.1 * speed_m_s) << "in tick " << i;  // never more than a tick's way
      touched = touched || x_m > stop_m - depth_m();
      if (touched) {
        ASSERT_GT(x_m, stop_m - 2 * depth_m()) << "bounced back in tick " << i;
      }
    }
    ASSERT_TRUE(touched) << speed_m_s;
    const Pose rest = pose_of(world, "a");
    EXPECT_LE(rest.x_m, stop_m + depth_m()) << speed_m_s;
    EXPECT_NEAR(rest.y_m, 0.0, 1e-3);
    EXPECT_NEAR(rest.heading_rad(), 0.0, 0.02);
    world->step();
    EXPECT_NEAR(pose_of(world, "a").x_m, rest.x_m, kAtRest_m);
  }
}

TEST_P(Contact, ACylinderAndATiltedBoxStopARobotToo) {
  Scene s = scene();
  s.cylinder(0.5, 0, 0.1).robot("round", 0, 0).wheels(0.1, 0.1);
  s.box(0.5, 1.0, 0.2, 0.2, 0.25 * std::numbers::pi).robot("edge", 0, 1.0).wheels(0.1, 0.1);
  auto world = make(s);
  ASSERT_TRUE(world.world) << world.all_problems();
  double deepest_m = -1.0;
  for (int i = 0; i < 150; ++i) {
    world->step();
    const Pose round = pose_of(world, "round");
    if (i > 60) deepest_m = std::max(deepest_m, 0.1 + kRobotRadius_m - std::hypot(round.x_m - 0.5, round.y_m));
  }
  // Head-on against round things is balanced on a knife's edge: a robot may slide round, but never into it.
  EXPECT_LE(deepest_m, depth_m());
  EXPECT_GT(deepest_m, -0.01);
  const Pose edge = pose_of(world, "edge");
  EXPECT_GT(std::hypot(edge.x_m - 0.5, edge.y_m - 1.0), 0.1 + kRobotRadius_m - 2e-3);
}

/// In how many regions crowds are tried: where regions meet, each engine of a region knows but the nearest of the
/// other.
std::vector<std::string> splits_of(const std::string& kind) {
  if (kind == "kinematics2d") return {"1x1"};  // knows no regions
  return {"1x1", "3x3"};
}

/// In one of the splits also on several threads.
std::vector<std::int64_t> threads_of(const std::string& kind, const std::string& split) {
  if (split == "3x3" || kind == "kinematics2d") return {0, 2};
  return {0};
}

Scene crowd_scene(const std::string& kind, const std::string& split, double size_m) {
  Scene s(size_m);
  s.engine(kind);
  if (split != "1x1") s.split(split);
  return s;
}

/// A quarter of the floor is robots, all at full speed, ten ticks a second, with the engine's own settings.
TEST_P(Contact, ACrowdAtFullSpeedOverlapsByTwoPercentOfABodyAtMost) {
  for (const std::string& split : splits_of(GetParam())) {
    std::vector<std::uint64_t> ends;
    for (const std::int64_t threads : threads_of(GetParam(), split)) {
      Scene s = crowd_scene(GetParam(), split, 1.02);
      s.param("left", "0.1288").param("right", "0.115").walls().robots(40, 0.36);
      WorldOptions options;
      options.threads = threads;
      auto world = make(s, options);
      ASSERT_TRUE(world.world) << world.all_problems();
      double deepest_m = 0.0;
      std::size_t pairs = 0;
      for (int i = 0; i < 300; ++i) {
        world->step();
        const Crowd crowd = crowd_of(world->space(), 1e-3);
        deepest_m = std::max(deepest_m, crowd.deepest_m);
        pairs += crowd.pairs;
      }
      EXPECT_EQ(world->state(), RunState::Running) << world->failure();
      EXPECT_GT(pairs, 3000U) << "it is a crowd";
      const double overlap = deepest_m / (2.0 * kRobotRadius_m);
      EXPECT_LE(overlap, 0.02) << split;
      EXPECT_NEAR(world->accuracy().overlap, overlap, 0.01) << "and the report says so, " << split;
      ends.push_back(world->state_hash());
    }
    EXPECT_EQ(ends.front(), ends.back()) << split;
  }
}

/// Robots on a grid, each by up to 5 mm an e-puck beside its point, that drive straight at one corner.
struct Heap {
  std::string kind;  ///< of engine
  std::string split;
  std::int64_t threads;
  std::size_t robots;
  std::uint64_t seed = 1;
  std::string robot = "e-puck";
};

/// Presses a heap for 200 ticks, ten a second, with the engine's own settings. In the closest one, 2 sqrt(3) r^2 of a
/// quarter of a disc are each robot's, and their mean distance from the corner is two thirds of its radius.
/// @returns the fingerprint of the end.
std::uint64_t press_into_a_corner(const Heap& heap) {
  SCOPED_TRACE(std::to_string(heap.robots) + " " + heap.robot + "s, " + heap.split + ", seed " +
               std::to_string(heap.seed));
  const hal::RobotKind& kind = *test::catalog().find<hal::RobotKind>(heap.robot);
  const double radius_m = kind.body.radius_m;
  const double size = radius_m / kRobotRadius_m;  // places grow with robots
  const double corner_m = 0.9 * size;
  const double speed_m_s = kind.drive()->max_speed_m_s;
  Scene s = crowd_scene(heap.kind, heap.split, 2.0 * corner_m + 0.2);
  s.walls();
  s.scenario.controllers.back().sensors.clear();
  s.scenario.controllers.back().actuators = {{"differential_steering", "ideal", {}}};
  std::mt19937_64 random(heap.seed);
  std::uniform_real_distribution<double> beside_m(-0.005, 0.005);
  for (std::size_t i = 0; i < heap.robots; ++i) {
    const double x_m = size * (-0.8 + 0.085 * static_cast<double>(i % 19) + beside_m(random));
    const double y_m = size * (-0.8 + 0.1 * static_cast<double>(i / 19) + beside_m(random));
    s.robot("r" + std::to_string(i), x_m, y_m, std::atan2(corner_m - y_m, corner_m - x_m)).wheels(speed_m_s, speed_m_s);
    s.scenario.robots.back().kind = heap.robot;
  }
  WorldOptions options;
  options.threads = heap.threads;
  auto world = make(s, options);
  EXPECT_TRUE(world.world) << world.all_problems();
  if (!world.world) return 0;
  const Space& space = world->space();
  const double tick_m = 0.1 * speed_m_s;
  double deepest_m = 0.0;
  double mean_m = 0.0;
  double nearest_m = corner_m;  // of any middle to a wall
  for (int tick = 0; tick < 200; ++tick) {
    world->step();
    deepest_m = std::max(deepest_m, crowd_of(space, 0.0, radius_m).deepest_m);
    mean_m = 0.0;
    for (std::size_t i = 0; i < heap.robots; ++i) {
      const Pose pose = space.pose(space.robot(i));
      nearest_m = std::min({nearest_m, corner_m - pose.x_m, corner_m - pose.y_m});
      mean_m += std::hypot(corner_m - pose.x_m, corner_m - pose.y_m) / static_cast<double>(heap.robots);
    }
  }
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
  EXPECT_GT(nearest_m, radius_m - 1.01 * tick_m);
  const double closest_m =
      2.0 / 3.0 * std::sqrt(static_cast<double>(heap.robots) * 8.0 * std::sqrt(3.0) / std::numbers::pi) * radius_m;
  EXPECT_LT(mean_m, 1.25 * closest_m);
  const double overlap = deepest_m / (2.0 * radius_m);
  EXPECT_LE(overlap, 0.02);
  EXPECT_NEAR(world->accuracy().overlap, overlap, 0.002) << "and the report says so";
  return world->state_hash();
}

TEST_P(Contact, RobotsThatPressIntoACornerHeapUpAndOverlapByTwoPercentOfABodyAtMost) {
  const std::size_t robots = GetParam() == "dynamics3d" ? 60 : 120;
  for (const std::string& split : splits_of(GetParam())) {
    std::vector<std::uint64_t> ends;
    for (const std::int64_t threads : threads_of(GetParam(), split))
      ends.push_back(press_into_a_corner({GetParam(), split, threads, robots}));
    EXPECT_EQ(ends.front(), ends.back()) << split;
  }
}

/// So many that pushes do not come through the heap in the passes of a tick; where robots have no forces.
TEST(ContactWithoutForces, HundredsThatPressIntoACornerOverlapByTwoPercentOfABodyAtMost) {
  for (const std::size_t robots : {40U, 200U, 300U}) {
    for (const std::uint64_t seed : {2U, 3U}) {
      for (const char* robot : {"e-puck", "foot-bot"})
        press_into_a_corner({"kinematics2d", "1x1", 0, robots, seed + robots, robot});
    }
  }
  EXPECT_EQ(press_into_a_corner({"kinematics2d", "1x1", 0, 250, 2}),
            press_into_a_corner({"kinematics2d", "4x4", 2, 250, 2}));
}

TEST_P(Contact, ARobotSlidesAlongAWall) {
  for (const double angle_rad : {0.35, 0.7, 1.05}) {  // between heading and wall
    auto world = make(scene(6.0).box(0, 0.5, 5.8, 0.2).robot("a", -2, 0.3, angle_rad).wheels(0.1, 0.1));
    ASSERT_TRUE(world.world) << world.all_problems();
    double deepest_m = -1.0;
    steps(world, 50);
    const Pose before = pose_of(world, "a");
    for (int i = 0; i < 50; ++i) {
      world->step();
      deepest_m = std::max(deepest_m, pose_of(world, "a").y_m - (0.4 - kRobotRadius_m));
    }
    const Pose after = pose_of(world, "a");
    const double along_m_s = (after.x_m - before.x_m) / 5.0;
    EXPECT_LE(deepest_m, depth_m()) << angle_rad;
    EXPECT_GT(deepest_m, -2e-3) << "left the wall at " << angle_rad;
    // The component along the wall; up to speed / cos(angle) where wheels roll on while the body slips sideways;
    // friction at the wall takes some, and may turn it along the wall.
    EXPECT_GT(along_m_s, 0.5 * 0.1 * std::cos(angle_rad)) << angle_rad;
    EXPECT_LT(along_m_s, 1.02 * 0.1 / std::cos(angle_rad)) << angle_rad;
  }
}

TEST_P(Contact, ACornerHoldsARobot) {
  auto world = make(scene(2.0).walls().robot("a", 0.5, 0.6, 0.7).wheels(0.1288, 0.1288));
  ASSERT_TRUE(world.world) << world.all_problems();
  double deepest_m = -1.0;
  for (int i = 0; i < 400; ++i) {
    world->step();
    const Pose pose = pose_of(world, "a");
    if (i > 100)
      deepest_m = std::max({deepest_m, pose.x_m - (0.9 - kRobotRadius_m), pose.y_m - (0.9 - kRobotRadius_m)});
    ASSERT_LT(std::max(pose.x_m, pose.y_m), 0.9 - kRobotRadius_m + 0.013) << i;
  }
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
  EXPECT_LE(deepest_m, depth_m());
  EXPECT_GT(deepest_m, -5e-3);
}

TEST_P(Contact, ANarrowPassageLetsARobotThrough) {
  auto world = make(scene().box(0, 0.14, 0.3, 0.2).box(0, -0.14, 0.3, 0.2).robot("a", -0.5, 0).wheels(0.1, 0.1));
  ASSERT_TRUE(world.world) << world.all_problems();
  steps(world, 101);  // the gap is 8 cm wide, the robot 7
  EXPECT_NEAR(pose_of(world, "a").x_m, 0.5, 0.02);
}

TEST_P(Contact, APassageThatIsTooNarrowHoldsARobot) {
  auto world = make(scene().box(0, 0.13, 0.3, 0.2).box(0, -0.13, 0.3, 0.2).robot("a", -0.5, 0).wheels(0.1, 0.1));
  ASSERT_TRUE(world.world) << world.all_problems();
  steps(world, 200);  // 6 cm
  EXPECT_LT(pose_of(world, "a").x_m, -0.15);
  const double slack_m = kRobotRadius_m - 0.03;
  EXPECT_GT(pose_of(world, "a").x_m, -0.15 - kRobotRadius_m - slack_m);
}

TEST_P(Contact, TwoRobotsThatMeetHeadOnComeToRestInTheMiddle) {
  for (const double speed_m_s : {0.02, 0.1288}) {
    auto world = make(scene()
                          .robot("a", -0.2, 0)
                          .wheels(speed_m_s, speed_m_s)
                          .robot("b", 0.2, 0, std::numbers::pi)
                          .wheels(speed_m_s, speed_m_s));
    ASSERT_TRUE(world.world) << world.all_problems();
    // They stand on a knife's edge, from which any rounding makes them slip past one another in the end; but not
    // within two seconds of their meeting.
    const double meet_s = (0.2 - kRobotRadius_m) / speed_m_s;
    steps(world, static_cast<int>(10.0 * meet_s) + 10);
    const Pose a = pose_of(world, "a");
    const Pose b = pose_of(world, "b");
    EXPECT_LE(overlap_m(a, b), depth_m()) << speed_m_s;
    EXPECT_GE(overlap_m(a, b), -depth_m()) << speed_m_s;
    EXPECT_NEAR(a.x_m + b.x_m, 0.0, 1e-3) << speed_m_s;
    EXPECT_NEAR(a.y_m + b.y_m, 0.0, 1e-3) << speed_m_s;
    // Total momentum: neither pushes the other away.
    steps(world, 10);
    EXPECT_NEAR(pose_of(world, "a").x_m + pose_of(world, "b").x_m, a.x_m + b.x_m, 1e-3) << speed_m_s;
    EXPECT_NEAR(pose_of(world, "a").x_m, a.x_m, 1e-3) << speed_m_s;
  }
}

TEST_P(Contact, TheRobotThatDrivesPushesTheOneThatRests) {
  // The wheels of the one that rests hold it as strongly as those of the other push. Whether it gives way is the
  // engine's own; but it never goes backwards, nor faster than the pusher.
  auto world = make(scene().robot("a", -0.3, 0).wheels(0.1, 0.1).robot("b", 0, 0).wheels(0, 0));
  ASSERT_TRUE(world.world) << world.all_problems();
  double last_m = 0.0;
  double fastest_m_s = 0.0;
  for (int i = 0; i < 100; ++i) {
    world->step();
    const double x_m = pose_of(world, "b").x_m;
    fastest_m_s = std::max(fastest_m_s, (x_m - last_m) * 10.0);
    last_m = x_m;
  }
  EXPECT_LT(fastest_m_s, 0.1 * 1.02);
  EXPECT_GE(last_m, -1e-3);
  EXPECT_LE(overlap_m(pose_of(world, "a"), pose_of(world, "b")), 2 * depth_m());
}

TEST_P(Contact, AColumnThatPushesAgainstAWallDoesNotExplode) {
  Scene s = scene();
  s.box(1.0, 0, 0.2, 2.0);
  constexpr int kRobots = 8;
  for (int i = 0; i < kRobots; ++i)
    s.robot("r" + std::to_string(i), 0.8 - 0.075 * i, i % 2 == 0 ? 1e-4 : -1e-4).wheels(0.1288, 0.1288);
  auto world = make(s);
  ASSERT_TRUE(world.world) << world.all_problems();
  std::vector<Pose> last(kRobots);
  for (std::size_t i = 0; i < kRobots; ++i) last[static_cast<std::size_t>(i)] = pose_of(world, "r" + std::to_string(i));
  for (int tick = 0; tick < 200; ++tick) {
    world->step();
    for (std::size_t i = 0; i < kRobots; ++i) {
      const Pose now = pose_of(world, "r" + std::to_string(i));
      Pose& before = last[static_cast<std::size_t>(i)];
      ASSERT_LT(std::hypot(now.x_m - before.x_m, now.y_m - before.y_m), 0.03) << "robot " << i << " in tick " << tick;
      // While the column buckles, those at the sides wedge the first one in. Then they stand.
      const double deep_m = (tick < 180 ? 8 : 2) * depth_m();
      ASSERT_LT(now.x_m, 0.9 - kRobotRadius_m + deep_m) << "robot " << i << " in tick " << tick;
      before = now;
    }
  }
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
  EXPECT_LE(crowd_of(world->space(), 0.0).deepest_m, 5 * depth_m());
}

TEST_P(Contact, ACrowdStaysInsideItsWallsAndApart) {
  Scene s(1.0, "epuck_diffusion", "epuck_diffusion");
  s.engine(GetParam()).walls().robots(40, 0.35);
  auto world = make(s);
  ASSERT_TRUE(world.world) << world.all_problems();
  double sum_m = 0.0;
  std::size_t pairs = 0;
  for (int tick = 0; tick < 200; ++tick) {
    world->step();
    const Crowd crowd = crowd_of(world->space(), 0.0);
    sum_m += crowd.sum_m;
    pairs += crowd.pairs;
    ASSERT_LT(crowd.deepest_m, 0.01) << "in tick " << tick;
    for (std::size_t i = 0; i < 40; ++i) {
      const Pose pose = world->space().pose(world->space().robot(i));
      ASSERT_LT(std::max(std::fabs(pose.x_m), std::fabs(pose.y_m)), 0.4 - kRobotRadius_m + 4 * depth_m()) << tick;
    }
  }
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
  EXPECT_GT(pairs, 100U);
  EXPECT_LT(sum_m / static_cast<double>(pairs), 2 * depth_m());
}

TEST_P(Contact, ARobotMovedByOthersKeepsThePoseThatItWasGiven) {
  auto world = make(scene().robot("a", -0.3, 0).wheels(0.1, 0.1).robot("real", 0, 0, 2.0).wheels(0.1, -0.1));
  ASSERT_TRUE(world.world) << world.all_problems();
  Space& space = world->space();
  space.set_external(space.find_robot("real"), true);
  for (int i = 0; i < 150; ++i) {
    world->step();
    const Pose pose = pose_of(world, "real");
    ASSERT_EQ(pose.x_m, 0.0) << i;
    ASSERT_EQ(pose.y_m, 0.0) << i;
    ASSERT_EQ(pose.cos_h, std::cos(2.0)) << i;
    ASSERT_EQ(pose.sin_h, std::sin(2.0)) << i;
  }
  // The other has run into it, and stands there or slid round it.
  EXPECT_LE(overlap_m(pose_of(world, "a"), pose_of(world, "real")), depth_m());
  EXPECT_GT(pose_of(world, "a").x_m, -0.1);
}

TEST_P(Contact, ARobotMovedByOthersPushesThoseInItsWay) {
  auto world = make(scene().robot("real", -0.3, 0).robot("a", 0, 0, 0.5 * std::numbers::pi).wheels(0, 0));
  ASSERT_TRUE(world.world) << world.all_problems();
  Space& space = world->space();
  const RobotId real = space.find_robot("real");
  space.set_external(real, true);
  for (int i = 0; i < 100; ++i) {
    const Pose at{-0.3 + 0.005 * (i + 1), 0.0, 0.0, 1.0, 0.0};
    space.set_pose(real, at);
    world->step();
    ASSERT_EQ(space.pose(real).x_m, at.x_m) << i;
    ASSERT_EQ(space.pose(real).y_m, 0.0) << i;
    ASSERT_LE(overlap_m(pose_of(world, "a"), at), 0.005 + 2 * depth_m()) << i;  // a tick's way at most
  }
  EXPECT_GT(pose_of(world, "a").x_m, 0.2 + 2 * kRobotRadius_m - 0.005 - 2 * depth_m());
}

INSTANTIATE_TEST_SUITE_P(Physics, Contact, testing::ValuesIn(test::engine_kinds()), name_of_kind);

}  // namespace
}  // namespace tandem::core
