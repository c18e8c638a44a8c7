#include "mixed_reality/fence/intrusion.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "hal/robot/epuck.hpp"
#include "tests/core/space_by_hand.hpp"

namespace tandem::mixed_reality {
namespace {

const double kR = hal::epuck::kind().body.radius_m;

class Intruder : public testing::Test {
 protected:
  Intruder() { robot_ = core::add_robot(space_, hal::epuck::kind(), "ep0", 0.0, 0.0, 0.0); }
  core::Object& box(double x_m, double y_m, double half_x_m, double half_y_m) {
    core::Object& o = core::add_object(space_, core::Object::Kind::Box, x_m, y_m, 0.0, 0.1);
    o.half_x_m = half_x_m;
    o.half_y_m = half_y_m;
    return o;
  }
  Intrusion at(double x_m, double y_m, double z_m = 0.0) const {
    return intrusion_of(space_, robot_, core::Pose::at(x_m, y_m, 0.0, z_m));
  }
  core::Space space_;
  core::RobotId robot_;
};

TEST_F(Intruder, IsAsDeepInABoxAsItsRimIs) {
  box(0.5, 0.0, 0.1, 0.3);
  EXPECT_EQ(at(0.0, 0.0).depth_m, 0.0);
  const Intrusion rim = at(0.4 - kR + 0.02, 0.1);
  EXPECT_NEAR(rim.depth_m, 0.02, 1e-9);
  EXPECT_NEAR(rim.out_x, -1.0, 1e-9);
  const Intrusion inside = at(0.45, 0.1);  // out by the nearest side
  EXPECT_NEAR(inside.depth_m, kR + 0.05, 1e-9);
  EXPECT_NEAR(inside.out_x, -1.0, 1e-9);
  EXPECT_EQ(name_of(space_, inside), "object0");
  EXPECT_EQ(at(0.45, 0.1, 0.2).depth_m, 0.0);  // it flies over it
}

TEST_F(Intruder, ABoxMayStandAskew) {
  core::Object& o = box(0.5, 0.0, 0.2, 0.2);
  o.cos_h = o.sin_h = std::numbers::sqrt2 / 2.0;
  const double corner_x_m = 0.5 - 0.2 * std::numbers::sqrt2;
  const Intrusion corner = at(corner_x_m - kR + 0.015, 0.0);
  EXPECT_NEAR(corner.depth_m, 0.015, 1e-9);
  EXPECT_NEAR(corner.out_x, -1.0, 1e-9);
}

TEST_F(Intruder, RobotsCountButNotTwinsOfRealOnes) {
  const core::RobotId other = core::add_robot(space_, hal::epuck::kind(), "sim", 0.0, 2.0 * kR - 0.02, 0.0);
  const Intrusion beside = at(0.0, 0.0);
  EXPECT_NEAR(beside.depth_m, 0.02, 1e-6);
  EXPECT_NEAR(beside.out_y, -1.0, 1e-9);
  EXPECT_EQ(name_of(space_, beside), "sim");
  space_.set_external(other, true);
  EXPECT_EQ(at(0.0, 0.0).depth_m, 0.0);
}

TEST_F(Intruder, ATouchIsNoIntrusion) {
  box(0.5, 0.0, 0.1, 0.3);
  const core::Pose pose = core::Pose::at(0.4 - kR + 0.005, 0.0, 0.0);
  EXPECT_GT(intrusion_of(space_, robot_, pose).depth_m, 0.0);
  EXPECT_FALSE(intrusion_of(space_, robot_, pose).deep());
}

}  // namespace
}  // namespace tandem::mixed_reality
