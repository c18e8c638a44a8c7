#include "mixed_reality/fence/nearby.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "hal/robot/epuck.hpp"
#include "tests/core/space_by_hand.hpp"

namespace tandem::mixed_reality {
namespace {

class Nearby : public testing::Test {
 protected:
  Nearby() {
    robot_ = core::add_robot(space_, hal::epuck::kind(), "ep0", 0.0, 0.0, 0.0);
    found_.reserve(8);
  }
  const std::vector<Obstacle>& around(double within_m) {
    find_obstacles(space_, robot_, space_.pose(robot_), within_m, found_);
    return found_;
  }

  core::Space space_;
  core::RobotId robot_;
  std::vector<Obstacle> found_;
};

TEST_F(Nearby, OfABoxAskewTheNearestPointIsFound) {
  core::Object& o = core::add_object(space_, core::Object::Kind::Box, 0.5, 0.0, 0.0, 0.1);
  o.half_x_m = o.half_y_m = 0.2;
  o.cos_h = o.sin_h = std::numbers::sqrt2 / 2.0;
  ASSERT_EQ(around(1.0).size(), 1U);
  EXPECT_NEAR(found_[0].x_m, 0.5 - 0.2 * std::numbers::sqrt2, 1e-9);
  EXPECT_NEAR(found_[0].y_m, 0.0, 1e-9);
  EXPECT_TRUE(around(0.1).empty());
  o.z_low_m = 0.2;
  EXPECT_TRUE(around(1.0).empty()) << "it passes under it";
}

TEST_F(Nearby, SimulatedRobotsCountAndTwinsOfRealOnesDoNot) {
  const core::RobotId other = core::add_robot(space_, hal::epuck::kind(), "sim", 0.3, 0.0, 0.0);
  ASSERT_EQ(around(1.0).size(), 1U);
  EXPECT_NEAR(found_[0].beyond_m, hal::epuck::kind().body.radius_m, 1e-6);
  space_.set_external(other, true);
  EXPECT_TRUE(around(1.0).empty());
}

TEST_F(Nearby, WhatItStandsInIsLeftToOthersAndThereIsRoomForSoMany) {
  for (int i = 0; i < 12; ++i)
    core::add_object(space_, core::Object::Kind::Cylinder, 0.2, 0.01 * i, 0.0, 0.1).radius_m = 0.05;
  core::add_object(space_, core::Object::Kind::Cylinder, 0.0, 0.0, 0.0, 0.1).radius_m = 0.05;
  EXPECT_EQ(around(1.0).size(), 8U);
  for (const Obstacle& o : found_) EXPECT_EQ(o.x_m, 0.2);
}

}  // namespace
}  // namespace tandem::mixed_reality
