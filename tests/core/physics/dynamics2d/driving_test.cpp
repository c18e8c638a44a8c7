// How wheels drive a body, alone and against others.
#include "tests/core/physics/dynamics2d/by_hand.hpp"

namespace tandem::core {
namespace {

struct Point {
  double x_m, y_m;
};

/// Where the wheels bring a robot from (x, y, heading) in `time_s` [Siegwart 2011, ch. 3].
Point arc(double x_m, double y_m, double heading_rad, double left_m_s, double right_m_s, double time_s) {
  const double turn_rad = (right_m_s - left_m_s) / hal::epuck::kind().drive()->wheel_base_m * time_s;
  const double way_m = 0.5 * (left_m_s + right_m_s) * time_s;
  if (turn_rad == 0.0) return {x_m + way_m * std::cos(heading_rad), y_m + way_m * std::sin(heading_rad)};
  const double radius_m = way_m / turn_rad;
  return {x_m + radius_m * (std::sin(heading_rad + turn_rad) - std::sin(heading_rad)),
          y_m - radius_m * (std::cos(heading_rad + turn_rad) - std::cos(heading_rad))};
}

TEST(Dynamics2dDriving, FreeRobotsFollowTheirArcsAsFarAsFloatsCanTell) {
  constexpr int kTicks = 200;
  for (const double far_m : {0.0, 19.0, 900.0}) {
    FlatByHand hand({}, 1000.0);
    const std::vector<Point> wheels = {{0.1, 0.1},    {0.005, 0.005}, {0.1288, 0.12},
                                       {-0.05, 0.05}, {0.02, -0.09},  {-0.1, -0.1}};
    for (std::size_t i = 0; i < wheels.size(); ++i)
      hand.robot(far_m, -far_m + 3.0 * static_cast<double>(i), 0.7, wheels[i].x_m, wheels[i].y_m);
    hand.ticks(kTicks);
    // Box2D's lengths are tenths of a metre, its numbers floats: each tick may round by half of their distance.
    const auto farthest = static_cast<float>(10.0 * (far_m + 20.0));
    const double bar_m = kTicks * 0.05 * static_cast<double>(std::nextafter(farthest, 2.0F * farthest) - farthest);
    for (std::size_t i = 0; i < wheels.size(); ++i) {
      const Point end = arc(far_m, -far_m + 3.0 * static_cast<double>(i), 0.7, wheels[i].x_m, wheels[i].y_m, 20.0);
      EXPECT_NEAR(hand.bodies().x_m[i], end.x_m, bar_m) << i << " at " << far_m;
      EXPECT_NEAR(hand.bodies().y_m[i], end.y_m, bar_m) << i << " at " << far_m;
      EXPECT_NEAR(hand.bodies().left_m[i], wheels[i].x_m * 20.0, 1e-9);
    }
  }
}

TEST(Dynamics2dDriving, AWeakDriveAcceleratesWithItsForceOverItsMass) {
  hal::RobotKind weak = hal::epuck::kind();
  weak.part<hal::DifferentialDrive>()->force_N = 0.015;  // 0.1 m/s^2
  FlatByHand hand;
  hand.robot(0, 0, 0.4, 0.1, 0.1, weak);
  for (int i = 1; i <= 15; ++i) {
    hand.tick();
    EXPECT_NEAR(hand.speed_m_s(0), std::min(0.1, 0.1 * kTick_s * i), 1e-6) << i;
  }
  hand.bodies().left_m_s[0] = hand.bodies().right_m_s[0] = 0.0;
  for (int i = 1; i <= 12; ++i) {
    hand.tick();
    EXPECT_NEAR(hand.speed_m_s(0), std::max(0.0, 0.1 - 0.1 * kTick_s * i), 1e-6) << i;
  }
}

TEST(Dynamics2dDriving, ARobotInAWedgeOfTwoOthersRests) {
  FlatByHand hand;
  hand.robot(0, 0, 0, 0.1288, 0.1288);
  hand.robot(0.2, 0.037, 0, 0, 0);
  hand.robot(0.2, -0.037, 0, 0, 0);
  hand.bodies().flags[1] |= kExternal;
  hand.bodies().flags[2] |= kExternal;
  constexpr double kHalfOfATicksWay_m = 0.5 * 0.1288 * kTick_s;
  double last_m = 0.0;
  const double stop_m = 0.2 - std::sqrt(4 * kRadius_m * kRadius_m - 0.037 * 0.037);
  for (int i = 0; i < 60; ++i) {
    hand.tick();
    const double x_m = hand.bodies().x_m[0];
    EXPECT_GE(x_m, last_m - kHalfOfATicksWay_m) << "thrown back in tick " << i;
    EXPECT_LE(x_m, stop_m + 1.5e-3) << i;
    last_m = x_m;
  }
  EXPECT_NEAR(last_m, stop_m, kHalfOfATicksWay_m);
}

TEST(Dynamics2dDriving, TwoThatMeetHeadOnMirrorOneAnotherToTheLastBit) {
  FlatByHand hand;
  hand.robot(-0.2, 0, 0, 0.1, 0.1);
  hand.robot(0.2, 0, M_PI, 0.1, 0.1);
  hand.bodies().cos_h[1] = -1.0;
  hand.bodies().sin_h[1] = 0.0;
  for (int i = 0; i < 60; ++i) {
    hand.tick();
    ASSERT_EQ(hand.bodies().x_m[0], -hand.bodies().x_m[1]) << i;
    ASSERT_EQ(hand.bodies().y_m[0], 0.0) << i;
  }
  EXPECT_NEAR(hand.bodies().x_m[1], kRadius_m, 5e-4);
}

TEST(Dynamics2dDriving, ABodyThatIsLedTurnsAndMovesWhatTouchesIt) {
  FlatByHand hand;
  hand.robot(-0.2, 0, 0, 0, 0);
  hand.bodies().flags[0] |= kExternal;
  hand.box(0, 0, 0.1, 0.3, 0.1);
  for (int i = 0; i < 60; ++i) {
    hand.bodies().x_m[0] += 0.005;
    const double led_m = hand.bodies().x_m[0];
    hand.tick();
    ASSERT_EQ(hand.bodies().x_m[0], led_m) << i;
  }
  EXPECT_NEAR(hand.object().x_m, 0.1 + kRadius_m + 0.05, 6e-3);
  EXPECT_NEAR(hand.object().y_m, 0.0, 1e-3);
}

}  // namespace
}  // namespace tandem::core
