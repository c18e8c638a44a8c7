// What every engine promises of a robot that drives freely.
#include <gmock/gmock.h>

#include "hal/check.hpp"
#include "hal/device/wheels.hpp"
#include "tests/core/physics/conformance/engines.hpp"

namespace tandem::core {
namespace {

constexpr double kReached = 0.02;  // share of the commanded value by which speeds, radii and angles may differ

using Driving = EveryEngine;

/// What a robot did in a while, once it drove as commanded.
struct Track {
  double way_m = 0.0;     ///< sum of the distances between ticks
  double x_m = 0.0;       ///< from the first pose to the last
  double y_m = 0.0;       ///< …
  double turn_rad = 0.0;  ///< sum of the turns between ticks
  double time_s = 0.0;
  double slowest_m_s = 1e9, fastest_m_s = 0.0;  ///< over single ticks
};

/// Lets robot "a" come to speed for `settle_s` and then follows it for `time_s`.
Track follow(const MadeWorld& world, double time_s, double settle_s = 0.5) {
  const auto per_second = static_cast<double>(world.world->ticks_per_second());
  steps(world, 1 + static_cast<int>(settle_s * per_second));
  Track track;
  Pose last = pose_of(world, "a");
  const Pose first = last;
  const int ticks = static_cast<int>(time_s * per_second);
  for (int i = 0; i < ticks; ++i) {
    world.world->step();
    const Pose now = pose_of(world, "a");
    const double way = std::hypot(now.x_m - last.x_m, now.y_m - last.y_m);
    track.way_m += way;
    track.slowest_m_s = std::min(track.slowest_m_s, way * per_second);
    track.fastest_m_s = std::max(track.fastest_m_s, way * per_second);
    track.turn_rad += turned_rad(last.heading_rad(), now.heading_rad());
    last = now;
  }
  track.x_m = last.x_m - first.x_m;
  track.y_m = last.y_m - first.y_m;
  track.time_s = ticks / per_second;
  return track;
}

struct Command {
  double left_m_s, right_m_s;
};

TEST_P(Driving, ReachesTheCommandedSpeedForwardsAndBackwards) {
  for (const int per_second : {10, 20, 50}) {
    for (const double speed_m_s : {0.01, 0.05, 0.1, 0.1288, -0.03, -0.1288}) {
      Scene s = scene();
      s.scenario.ticks_per_second = per_second;
      auto world = make(s.robot("a", 0, 0, 0.7).wheels(speed_m_s, speed_m_s));
      ASSERT_TRUE(world.world) << world.all_problems();
      const Track track = follow(world, 5.0);
      const double along_m = track.x_m * std::cos(0.7) + track.y_m * std::sin(0.7);
      const double aside_m = track.y_m * std::cos(0.7) - track.x_m * std::sin(0.7);
      EXPECT_NEAR(along_m, speed_m_s * 5.0, kReached * std::fabs(speed_m_s) * 5.0) << per_second << " ticks a second";
      EXPECT_NEAR(aside_m, 0.0, 1e-3 * std::fabs(along_m)) << speed_m_s;
      EXPECT_NEAR(track.turn_rad, 0.0, 1e-3) << speed_m_s;
    }
  }
}

TEST_P(Driving, NeitherGainsNorLosesSpeedOnFreeGround) {
  auto world = make(scene(8.0).robot("a", -3, -2, 0.4).wheels(0.1, 0.1));
  ASSERT_TRUE(world.world) << world.all_problems();
  const Track track = follow(world, 50.0, 2.0);
  EXPECT_GT(track.slowest_m_s, 0.1 * (1 - kReached));
  EXPECT_LT(track.fastest_m_s, 0.1 * (1 + kReached));
  EXPECT_LT(track.fastest_m_s - track.slowest_m_s, 1e-4 * 0.1);
}

TEST_P(Driving, KeepsItsSpeedAndDirectionFarOutInALargeArena) {
  // Engines that reckon in single precision round most here: 63 m from the middle.
  for (const int per_second : {10, 50}) {
    for (const double speed_m_s : {0.005, 0.02, 0.1288}) {
      Scene s = scene(100.0);
      s.scenario.ticks_per_second = per_second;
      auto world = make(s.robot("a", 45, 44, 0.7).wheels(speed_m_s, speed_m_s));
      ASSERT_TRUE(world.world) << world.all_problems();
      const Track track = follow(world, 5.0);
      const double along_m = track.x_m * std::cos(0.7) + track.y_m * std::sin(0.7);
      const double aside_m = track.y_m * std::cos(0.7) - track.x_m * std::sin(0.7);
      EXPECT_NEAR(along_m, speed_m_s * 5.0, kReached * speed_m_s * 5.0) << per_second << " ticks a second";
      EXPECT_NEAR(aside_m, 0.0, kReached * along_m) << speed_m_s;
    }
  }
}

TEST_P(Driving, TurnsOnTheSpotAtTheCommandedRate) {
  for (const int per_second : {10, 20, 50}) {
    for (const double rim_m_s : {0.005, 0.04, 0.1288, -0.02, -0.1288}) {
      Scene s = scene();
      s.scenario.ticks_per_second = per_second;
      auto world = make(s.robot("a", 0.3, -0.2, 2.0).wheels(-rim_m_s, rim_m_s));
      ASSERT_TRUE(world.world) << world.all_problems();
      const Track track = follow(world, 4.0);
      const double turn_rad = 2 * rim_m_s / kWheelBase_m * 4.0;
      EXPECT_NEAR(track.turn_rad, turn_rad, kReached * std::fabs(turn_rad))
          << per_second << " ticks a second, " << rim_m_s << " m/s";
      const Pose end = pose_of(world, "a");
      EXPECT_LT(std::hypot(end.x_m - 0.3, end.y_m + 0.2), 1e-3) << per_second << ", " << rim_m_s;
    }
  }
}

/// The circle through three points.
struct Circle {
  double x_m, y_m, radius_m;
};
Circle circle_through(const Pose& a, const Pose& b, const Pose& c) {
  const double bx = b.x_m - a.x_m;
  const double by = b.y_m - a.y_m;
  const double cx = c.x_m - a.x_m;
  const double cy = c.y_m - a.y_m;
  const double d = 2 * (bx * cy - by * cx);
  const double x = (cy * (bx * bx + by * by) - by * (cx * cx + cy * cy)) / d;
  const double y = (bx * (cx * cx + cy * cy) - cx * (bx * bx + by * by)) / d;
  return {a.x_m + x, a.y_m + y, std::hypot(x, y)};
}

TEST_P(Driving, DrivesTheArcThatTheWheelsAsk) {
  // Radius to the middle of the axle: base / 2 * (r + l) / (r - l); turn rate: (r - l) / base [Siegwart 2011, ch. 3].
  for (const int per_second : {10, 20, 50}) {
    for (const Command c : {Command{0.09, 0.12}, Command{0.02, 0.06}, Command{0.1288, 0.05}, Command{0.0, 0.06},
                            Command{-0.05, -0.08}, Command{0.1288, 0.12}, Command{-0.03, 0.1}}) {
      Scene s = scene();
      s.scenario.ticks_per_second = per_second;
      auto world = make(s.robot("a", 0, 0, -1.0).wheels(c.left_m_s, c.right_m_s));
      ASSERT_TRUE(world.world) << world.all_problems();
      const double radius_m = std::fabs(0.5 * kWheelBase_m * (c.right_m_s + c.left_m_s) / (c.right_m_s - c.left_m_s));
      const double rate_rad_s = (c.right_m_s - c.left_m_s) / kWheelBase_m;
      steps(world, 1 + per_second / 2);
      // A third of the circle between the points, or what two seconds give.
      const double third_s = std::min(2.0, 2 * std::numbers::pi / 3 / std::fabs(rate_rad_s));
      const int ticks = std::max(1, static_cast<int>(std::lround(third_s * per_second)));
      const Pose first = pose_of(world, "a");
      double turn_rad = 0.0;
      Pose points[3] = {first, first, first};
      for (int k = 1; k <= 2 * ticks; ++k) {
        const double before_rad = pose_of(world, "a").heading_rad();
        world->step();
        const Pose now = pose_of(world, "a");
        turn_rad += turned_rad(before_rad, now.heading_rad());
        if (k == ticks) points[1] = now;
        if (k == 2 * ticks) points[2] = now;
      }
      const std::string what = std::to_string(per_second) + " ticks a second, left " + std::to_string(c.left_m_s) +
                               ", right " + std::to_string(c.right_m_s);
      const double expected_rad = rate_rad_s * 2 * ticks / per_second;
      EXPECT_NEAR(turn_rad, expected_rad, kReached * std::fabs(expected_rad)) << what;
      const Circle circle = circle_through(points[0], points[1], points[2]);
      EXPECT_NEAR(circle.radius_m, radius_m, kReached * radius_m) << what;
      // The centre lies on the axle, to the left where the right wheel rolls farther ahead than the left one.
      const double to_left_m = 0.5 * kWheelBase_m * (c.right_m_s + c.left_m_s) / (c.right_m_s - c.left_m_s);
      EXPECT_NEAR(circle.x_m, first.x_m - to_left_m * first.sin_h, kReached * radius_m + 2e-4) << what;
      EXPECT_NEAR(circle.y_m, first.y_m + to_left_m * first.cos_h, kReached * radius_m + 2e-4) << what;
    }
  }
}

TEST_P(Driving, StopsWhenItsWheelsStop) {
  // The drive brakes as hard as it pushes: v^2 / (2 F / m), and one tick until the wheels know.
  auto world = make(scene().robot("a", 0, 0).wheels(0.1288, 0.1288));
  ASSERT_TRUE(world.world) << world.all_problems();
  steps(world, 21);
  const Pose before = pose_of(world, "a");
  set_halted(world, "a");
  steps(world, 10);
  const Pose stopped = pose_of(world, "a");
  const double brake_m = 0.1288 * 0.1288 / (2 * hal::epuck::kind().drive()->force_N / hal::epuck::kind().body.mass_kg);
  EXPECT_LE(stopped.x_m - before.x_m, 0.1 * 0.1288 + brake_m);
  EXPECT_GE(stopped.x_m, before.x_m);
  steps(world, 50);
  EXPECT_NEAR(pose_of(world, "a").x_m, stopped.x_m, 1e-6);
  EXPECT_NEAR(pose_of(world, "a").y_m, 0.0, 1e-6);
}

TEST_P(Driving, StandsStillForAsLongAsNothingIsCommanded) {
  auto world = make(scene().robot("a", 0.3, -0.4, 1.0).wheels(0, 0));
  ASSERT_TRUE(world.world) << world.all_problems();
  steps(world, 300);
  EXPECT_NEAR(pose_of(world, "a").x_m, 0.3, 1e-6);
  EXPECT_NEAR(pose_of(world, "a").y_m, -0.4, 1e-6);
  EXPECT_NEAR(pose_of(world, "a").heading_rad(), 1.0, 1e-6);
}

TEST_P(Driving, EncodersCountWhatTheWheelsWereToldToRoll) {
  auto world = make(scene(4.0, "everything").robot("a", 0, 0).wheels(0.05, -0.02));
  ASSERT_TRUE(world.world) << world.all_problems();
  steps(world, 101);  // the first command acts from the second tick
  const Space& space = world->space();
  const auto* encoders = space.port<hal::WheelEncoders>(space.find_robot("a"));
  ASSERT_NE(encoders, nullptr);
  EXPECT_NEAR(encoders->left_m, 0.5, kReached * 0.5);
  EXPECT_NEAR(encoders->right_m, -0.2, kReached * 0.2);
  EXPECT_NEAR(encoders->left_m_s, 0.05, kReached * 0.05);
  EXPECT_NEAR(encoders->right_m_s, -0.02, kReached * 0.02);
}

TEST_P(Driving, TheHeadingStaysAUnitVector) {
  auto world = make(scene().robot("a", 0, 0).wheels(-0.1, 0.12));
  ASSERT_TRUE(world.world) << world.all_problems();
  for (int i = 0; i < 500; ++i) {
    world->step();
    const Pose pose = pose_of(world, "a");
    ASSERT_NEAR(std::hypot(pose.cos_h, pose.sin_h), 1.0, 1e-6) << i;
  }
}

TEST_P(Driving, RobotsFarApartDoNotFeelOneAnother) {
  auto alone = make(scene().robot("a", -1, 0, 0.3).wheels(0.1, 0.09));
  auto both = make(scene().robot("a", -1, 0, 0.3).wheels(0.1, 0.09).robot("b", 1, 0.5, 1.0).wheels(0.03, -0.05));
  ASSERT_TRUE(alone.world && both.world);
  for (int i = 0; i < 100; ++i) {
    alone->step();
    both->step();
    ASSERT_NEAR(pose_of(alone, "a").x_m, pose_of(both, "a").x_m, 1e-9) << i;
    ASSERT_NEAR(pose_of(alone, "a").y_m, pose_of(both, "a").y_m, 1e-9) << i;
  }
}

/// An e-puck without wheels, among the kinds that there are.
const hal::Catalog& with_posts() {
  static const hal::RobotKind post = [] {
    hal::RobotKind kind = hal::epuck::kind();
    kind.name = "post";
    kind.locomotion = {};
    return kind;
  }();
  static const hal::Catalog all = [] {
    hal::Catalog made = test::catalog();
    const hal::Status good = made.add_from("posts", [](hal::Registrar& r) { r.add(post); });
    TANDEM_CHECK(good.ok(), good.error().message.c_str());
    return made;
  }();
  return all;
}

TEST_P(Driving, AKindWithoutLocomotionStaysWhereItIs) {
  Scene s = scene(4.0, "watcher").robot("a", 0.5, -0.25, 0.3).robot("b", -0.5, 0.25, 0.6);
  for (RobotItem& robot : s.scenario.robots) robot.kind = "post";
  s.scenario.controllers[0].sensors.clear();
  s.scenario.controllers[0].actuators = {
      {"leds", "default", {}}, {"body_led", "default", {}}, {"front_led", "default", {}}};
  auto world = make(s, {}, with_posts());
  ASSERT_TRUE(world.world) << world.all_problems();
  const Pose before = pose_of(world, "a");
  steps(world, 20);
  const Pose after = pose_of(world, "a");
  EXPECT_NEAR(after.x_m, before.x_m, 1e-9);
  EXPECT_NEAR(after.y_m, before.y_m, 1e-9);
  EXPECT_NEAR(after.z_m, 0.0, 1e-6);
  EXPECT_NEAR(turned_rad(before.heading_rad(), after.heading_rad()), 0.0, 1e-9);
}

TEST_P(Driving, AKindWithoutLocomotionHasNoWheelsToCommand) {
  Scene s = scene().robot("a", 0.5, -0.25, 0.3);
  s.scenario.robots[0].kind = "post";
  const auto world = make(s, {}, with_posts());
  EXPECT_FALSE(world.world);
  EXPECT_THAT(world.all_problems(),
              testing::HasSubstr("the robot 'post' has no device 'differential_steering'; take it "
                                 "out of the controller configuration"));
}

INSTANTIATE_TEST_SUITE_P(Physics, Driving, testing::ValuesIn(test::engine_kinds()), name_of_kind);

}  // namespace
}  // namespace tandem::core
