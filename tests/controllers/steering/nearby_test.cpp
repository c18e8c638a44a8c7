#include "controllers/steering/nearby.hpp"

#include <gtest/gtest.h>
#include <numbers>

#include "controllers/steering/drive.hpp"
#include "hal/angle.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/robot/footbot.hpp"
#include "tests/controllers/test_robot.hpp"

namespace tandem::controllers {
namespace {

constexpr double kPi = std::numbers::pi;

struct Nearby : ::testing::Test {
  test::TestRobot robot{hal::footbot::kind()};
  hal::RangeAndBearing heard;

  Thing thing() const {
    return nearest_thing(robot.proximity, hal::footbot::kind().part<hal::ProximityPart>()->mounts, heard);
  }
  /// What the ring sees of a disc.
  void see_disc(double x_m, double y_m, double radius_m) {
    robot.clear();
    for (std::size_t i = 0; i < 24; ++i) {
      const hal::Mount& m = hal::footbot::kind().part<hal::ProximityPart>()->mounts[i];
      const double dx = std::cos(m.bearing_rad), dy = std::sin(m.bearing_rad);
      const double along = (x_m - m.x_m) * dx + (y_m - m.y_m) * dy;
      const double aside = (x_m - m.x_m) * dy - (y_m - m.y_m) * dx;
      if (along <= 0.0 || std::fabs(aside) >= radius_m) continue;
      const double gap_m = along - std::sqrt(radius_m * radius_m - aside * aside);
      if (gap_m < 0.1) robot.proximity.distance_m[i] = static_cast<float>(gap_m);
    }
  }
  void hear(double range_m, double bearing_rad) {
    const std::uint8_t byte = 0;
    heard.insert(static_cast<float>(range_m), static_cast<float>(bearing_rad), 0.0F, &byte, 1);
  }
};

TEST_F(Nearby, NothingIsSeenWhereNothingIs) {
  EXPECT_FALSE(thing().seen);
  EXPECT_EQ(hal::length_of(push_away(robot.proximity, hal::footbot::kind().part<hal::ProximityPart>()->mounts)), 0.0);
}

TEST_F(Nearby, ADiscIsSeenWhereItIsAndAsBroadAsItIs) {
  for (const double bearing_rad : {0.0, 1.0, 3.1, -2.0}) {
    see_disc(0.17 * std::cos(bearing_rad), 0.17 * std::sin(bearing_rad), 0.06);
    EXPECT_TRUE(thing().seen);
    EXPECT_NEAR(hal::wrapped(thing().bearing_rad - bearing_rad), 0.0, 0.1);
    EXPECT_NEAR(thing().gap_m, 0.17 - 0.06 - hal::footbot::kind().body.radius_m, 0.005);
    EXPECT_LT(thing().breadth_m, 0.12);
    EXPECT_GT(thing().breadth_m, 0.025);  // two neighbouring sensors
  }
}

TEST_F(Nearby, AWallIsBroaderThanAnyObject) {
  test::Room room{.walls = {{1, 0, 0.12}}};
  room.look(robot);
  EXPECT_NEAR(thing().bearing_rad, 0.0, 0.01);
  EXPECT_GT(thing().breadth_m, 0.15);
}

TEST_F(Nearby, RobotsThatSendAreNoThings) {
  see_disc(0.2, 0.0, hal::footbot::kind().body.radius_m);
  EXPECT_TRUE(thing().seen);
  hear(0.2, 0.0);
  EXPECT_FALSE(thing().seen);
  see_disc(0.0, 0.16, 0.06);  // something else, to the left
  EXPECT_TRUE(thing().seen);
  EXPECT_NEAR(thing().bearing_rad, 0.5 * kPi, 0.1);
}

TEST_F(Nearby, PushesAwayFromWhatIsNearButNotFromTheLoad) {
  see_disc(0.0, 0.16, 0.06);
  const hal::Vector2 push = push_away(robot.proximity, hal::footbot::kind().part<hal::ProximityPart>()->mounts);
  EXPECT_LT(push.y(), -0.03);
  EXPECT_NEAR(push.x(), 0.0, 1e-6);
  see_disc(0.16, 0.0, 0.06);
  EXPECT_GT(hal::length_of(push_away(robot.proximity, hal::footbot::kind().part<hal::ProximityPart>()->mounts)), 0.03);
  EXPECT_EQ(hal::length_of(push_away(robot.proximity, hal::footbot::kind().part<hal::ProximityPart>()->mounts, 1.0)),
            0.0);
}

TEST_F(Nearby, TheLightIsWhereTheSensorsSeeMoreOfIt) {
  hal::Light light;
  light.count = 24;
  for (std::size_t i = 0; i < 24; ++i)
    light.level[i] = static_cast<float>(
        std::max(0.0, std::cos(hal::footbot::kind().part<hal::ProximityPart>()->mounts[i].bearing_rad - 2.0)));
  EXPECT_NEAR(hal::bearing_of(to_light(light, hal::footbot::kind().part<hal::ProximityPart>()->mounts)), 2.0, 1e-6);
}

TEST(Drive, LeadsToTheBearing) {
  hal::WheelSpeeds wheels;
  drive_towards(wheels, 0.0, 0.1);
  EXPECT_EQ(wheels.left_m_s, 0.1);
  EXPECT_EQ(wheels.right_m_s, 0.1);
  drive_towards(wheels, 0.3, 0.1);  // left: the right wheel is faster
  EXPECT_LT(wheels.left_m_s, 0.1);
  EXPECT_EQ(wheels.right_m_s, 0.1);
  drive_towards(wheels, -1.0, 0.1);  // on the spot
  EXPECT_EQ(wheels.left_m_s, 0.05);
  EXPECT_EQ(wheels.right_m_s, -0.05);
  EXPECT_FALSE(turn_by(wheels, 0.5, 0.04));
  EXPECT_EQ(wheels.right_m_s, 0.04);
  EXPECT_TRUE(turn_by(wheels, 0.05, 0.04));
  EXPECT_EQ(wheels.right_m_s, 0.0);
}

}  // namespace
}  // namespace tandem::controllers
