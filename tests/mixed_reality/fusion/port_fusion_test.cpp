#include "mixed_reality/fusion/port_fusion.hpp"

#include <gtest/gtest.h>

#include "hal/device/body_sensors.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"
#include "hal/robot/epuck.hpp"
#include "tests/core/space_by_hand.hpp"

namespace tandem::mixed_reality {
namespace {

using hal::port_type;
using hal::Validity;

class FusedPorts : public testing::Test {
 protected:
  void SetUp() override {
    robot_ = core::add_robot(space_, hal::epuck::kind(), "ep0", 0.0, 0.0, 0.0,
                             {&port_type<hal::WheelSpeeds>(), &port_type<hal::Proximity>(), &port_type<hal::Ground>(),
                              &port_type<hal::RangeAndBearing>(), &port_type<hal::Accelerometer>(),
                              &port_type<hal::Clock>(), &port_type<hal::WheelEncoders>()});
    fill(port<hal::Proximity>(), 0.1F, 0.03F);
    fill(real_proximity_, 0.02F, 0.1F);
    port<hal::Ground>().count = 3;
    port<hal::Ground>().reflectance = {0.1F, 0.2F, 0.3F};
    fresh(port<hal::Ground>());
    const std::uint8_t payload[2] = {4, 2};
    port<hal::RangeAndBearing>().insert(0.5F, 1.0F, 0.0F, payload, 2);
    fresh(port<hal::RangeAndBearing>());
    port<hal::Accelerometer>().force_m_s2 = {0.0F, 0.0F, 9.81F};
    fresh(port<hal::Accelerometer>());
    port<hal::Clock>().tick = 77;
    fresh(port<hal::Clock>());
    fresh(port<hal::WheelEncoders>());
    real_encoders_.left_m = 1.5;
    fresh(real_encoders_);
  }
  static void fresh(hal::Reading& reading) { reading.validity = Validity::Fresh; }
  static void fill(hal::Proximity& p, float first_m, float second_m) {
    p.count = 2;
    p.range_m = 0.1F;
    p.distance_m[0] = first_m;
    p.distance_m[1] = second_m;
    fresh(p);
  }
  template <class T>
  T& port() {
    return *space_.port<T>(robot_);
  }
  void fuse() {
    PortFusion fusion(space_, robot_, [this](const hal::PortType& type) -> const void* {
      if (type.layout == port_type<hal::Proximity>().layout) return &real_proximity_;
      if (type.layout == port_type<hal::WheelEncoders>().layout) return &real_encoders_;
      return nullptr;
    });
    fusion.latch();
    fusion.fuse();
  }

  core::Space space_;
  core::RobotId robot_;
  hal::Proximity real_proximity_;
  hal::WheelEncoders real_encoders_;
};

TEST_F(FusedPorts, ProximityTakesTheNearerOfBothWorldsSensorBySensor) {
  fuse();
  EXPECT_FLOAT_EQ(port<hal::Proximity>().distance_m[0], 0.02F);  // a real thing, where the virtual world is free
  EXPECT_FLOAT_EQ(port<hal::Proximity>().distance_m[1], 0.03F);  // a virtual robot, where the real world is free
  EXPECT_EQ(port<hal::Proximity>().count, 2U);
}

TEST_F(FusedPorts, WhatBothWorldsShowIsSeenOnce) {
  fill(real_proximity_, 0.05F, 0.05F);
  fill(port<hal::Proximity>(), 0.05F, 0.06F);
  fuse();
  EXPECT_FLOAT_EQ(port<hal::Proximity>().distance_m[0], 0.05F);
  EXPECT_FLOAT_EQ(port<hal::Proximity>().distance_m[1], 0.05F);
}

TEST_F(FusedPorts, FloorMessagesAndClockComeFromTheVirtualWorld) {
  fuse();
  EXPECT_FLOAT_EQ(port<hal::Ground>().reflectance[2], 0.3F);
  EXPECT_EQ(port<hal::Ground>().validity, Validity::Fresh);
  EXPECT_EQ(port<hal::RangeAndBearing>().count, 1U);
  EXPECT_EQ(port<hal::Clock>().tick, 77);
  EXPECT_EQ(port<hal::Clock>().validity, Validity::Fresh);
}

TEST_F(FusedPorts, WheelsAreTheRealOnesAlone) {
  fuse();
  EXPECT_DOUBLE_EQ(port<hal::WheelEncoders>().left_m, 1.5);
}

TEST_F(FusedPorts, WhatTheRobotDoesNotHaveIsAbsentNotInvented) {
  fuse();
  EXPECT_EQ(port<hal::Accelerometer>().validity, Validity::Absent);
}

TEST_F(FusedPorts, AReadingThatNeverCameIsNamed) {
  hal::Accelerometer accelerometer;
  hal::RangeAndBearing board;
  const PortFusion fusion(space_, robot_, [&](const hal::PortType& type) -> const void* {
    if (type.layout == port_type<hal::Accelerometer>().layout) return &accelerometer;
    if (type.layout == port_type<hal::RangeAndBearing>().layout) return &board;  // the virtual one stands in for it
    return nullptr;
  });
  EXPECT_EQ(fusion.missing(), &port_type<hal::Accelerometer>());
  accelerometer.validity = Validity::Stale;
  EXPECT_EQ(fusion.missing(), nullptr);
}

TEST_F(FusedPorts, AStaleOrAbsentRealReadingIsNotMadeFreshByAVirtualOne) {
  real_proximity_.validity = Validity::Stale;
  fuse();
  EXPECT_EQ(port<hal::Proximity>().validity, Validity::Stale);
  fill(port<hal::Proximity>(), 0.01F, 0.01F);
  real_proximity_.validity = Validity::Absent;
  fuse();
  EXPECT_EQ(port<hal::Proximity>().validity, Validity::Absent);
}

TEST_F(FusedPorts, CommandsAreLeftAlone) {
  port<hal::WheelSpeeds>().set(0.1, 0.2);
  fuse();
  EXPECT_EQ(port<hal::WheelSpeeds>().right_m_s, 0.2);
}

}  // namespace
}  // namespace tandem::mixed_reality
