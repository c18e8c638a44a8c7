#include "mixed_reality/twin/mechanisms.hpp"

#include <gtest/gtest.h>
#include <map>
#include <numbers>

#include "core/space/stores.hpp"
#include "hal/device/pan_tilt.hpp"
#include "hal/device/turret.hpp"
#include "hal/robot/eyebot.hpp"
#include "hal/robot/footbot.hpp"
#include "tests/core/space_by_hand.hpp"

namespace tandem::mixed_reality {
namespace {

using hal::port_type;
constexpr double kTick_s = 0.1;

/// A real foot-bot of which each test says what it tells of itself.
class FootbotMechanisms : public testing::Test {
 protected:
  FootbotMechanisms() {
    robot_ = core::add_robot(
        space_, hal::footbot::kind(), "fb", 0.0, 0.0, 0.0,
        {&port_type<hal::TurretDrive>(), &port_type<hal::GripperDrive>(), &port_type<hal::ScannerDrive>(),
         &port_type<hal::DistanceScanner>(), &port_type<hal::Proximity>(), &port_type<hal::RangeAndBearing>()});
    core::add_state<core::TurretState>(space_, robot_);
    core::add_state<core::GripState>(space_, robot_);
    core::add_state<core::ScannerState>(space_, robot_);
    space_.set_external(robot_, true);
  }
  template <class Port>
  void has(Port& reading) {
    readings_[port_type<Port>().layout] = &reading;
  }
  void follow(Mechanisms& mechanisms) {
    mechanisms.follow(kTick_s, state_);
    apply_mechanisms(space_, robot_, state_);
  }
  Mechanisms made() {
    return {space_, robot_, [this](const hal::PortType& type) -> const void* {
              const auto found = readings_.find(type.layout);
              return found == readings_.end() || type.role != hal::Role::Sensor ? nullptr : found->second;
            }};
  }
  const core::ScannerState& scanner() { return *space_.state<core::ScannerState>(robot_); }
  std::uint8_t senses() const { return state_.senses; }

  core::Space space_;
  core::RobotId robot_;
  TwinState state_;
  std::map<std::uint64_t, const void*> readings_;
};

TEST_F(FootbotMechanisms, StandWhereTheRobotSaysThatTheyAre) {
  hal::TurretEncoder turret;
  hal::Gripper gripper;
  has(turret);
  has(gripper);
  Mechanisms mechanisms = made();
  turret.angle_rad = 0.8;
  turret.validity = gripper.validity = hal::Validity::Fresh;
  gripper.aperture_rad = 0.5F;
  space_.port<hal::TurretDrive>(robot_)->go_to(-2.0);  // it is not there yet
  follow(mechanisms);
  EXPECT_NEAR(space_.turret_rad(robot_), 0.8, 1e-12);
  EXPECT_NEAR(space_.state<core::GripState>(robot_)->aperture_rad, 0.5, 1e-6);
}

TEST_F(FootbotMechanisms, GoWhereTheyWereToldWhereNothingMeasuresThem) {
  Mechanisms mechanisms = made();
  space_.port<hal::TurretDrive>(robot_)->go_to(0.3);
  space_.port<hal::GripperDrive>(robot_)->lock();
  follow(mechanisms);
  EXPECT_NEAR(space_.turret_rad(robot_),
              std::min(0.3, hal::footbot::kind().part<hal::TurretPart>()->turn_rad_s * kTick_s), 1e-12);
  for (int i = 0; i < 20; ++i) follow(mechanisms);
  EXPECT_NEAR(space_.turret_rad(robot_), 0.3, 1e-12);
  space_.port<hal::TurretDrive>(robot_)->turn(-0.5);
  follow(mechanisms);
  EXPECT_NEAR(space_.turret_rad(robot_), 0.25, 1e-12);
  EXPECT_EQ(space_.state<core::GripState>(robot_)->aperture_rad, hal::GripperDrive::kMost_rad);
}

TEST_F(FootbotMechanisms, TheVirtualScannerMeasuresWhereTheRealOneDoes) {
  hal::DistanceScanner scan;
  has(scan);
  Mechanisms mechanisms = made();
  scan.validity = hal::Validity::Fresh;
  scan.count = 4;
  scan.turn_rad = 1.5F;
  space_.port<hal::ScannerDrive>(robot_)->turn(2.0);
  follow(mechanisms);
  EXPECT_EQ(scanner().mode, hal::ScannerMode::Speed);
  EXPECT_NEAR(scanner().angle_rad, 1.5, 1e-6);
  EXPECT_NEAR(scanner().swept_rad, 0.2, 1e-12);
  space_.port<hal::ScannerDrive>(robot_)->turn_off();  // it measures on
  follow(mechanisms);
  EXPECT_EQ(scanner().mode, hal::ScannerMode::Position);
  EXPECT_EQ(scanner().swept_rad, 0.0);
  scan.count = 0;
  follow(mechanisms);
  EXPECT_EQ(scanner().mode, hal::ScannerMode::Off);
}

TEST_F(FootbotMechanisms, SensesOfItsOwnAreThoseThatEverMeasured) {
  hal::Proximity proximity;
  hal::RangeAndBearing messages;
  has(proximity);
  has(messages);
  Mechanisms mechanisms = made();
  follow(mechanisms);
  EXPECT_EQ(senses(), 0);  // an e-puck's port of messages never measures anything: it has no board
  proximity.validity = hal::Validity::Stale;
  follow(mechanisms);
  EXPECT_EQ(senses(), core::bit(core::RealSense::Proximity));
  messages.validity = hal::Validity::Fresh;
  follow(mechanisms);
  EXPECT_EQ(senses(), core::bit(core::RealSense::Proximity) | core::bit(core::RealSense::Messages));
}

TEST(EyebotMechanisms, TheHeadFollowsItsEncoderAndTheLaserItsCommand) {
  core::Space space;
  const core::RobotId robot =
      core::add_robot(space, hal::eyebot::kind(), "eb", 0.0, 0.0, 0.0, {&port_type<hal::PanTiltDrive>()});
  const core::HeadState& head = core::add_state<core::HeadState>(space, robot);
  space.set_external(robot, true);
  hal::PanTiltEncoder encoder;
  TwinState state;
  Mechanisms mechanisms(space, robot, [&](const hal::PortType& type) -> const void* {
    return type.layout == port_type<hal::PanTiltEncoder>().layout ? &encoder : nullptr;
  });
  space.port<hal::PanTiltDrive>(robot)->laser = true;
  space.port<hal::PanTiltDrive>(robot)->pan_rad = 1.0;
  mechanisms.follow(kTick_s, state);
  apply_mechanisms(space, robot, state);
  EXPECT_NEAR(head.pan_rad, std::min(1.0, hal::eyebot::kind().part<hal::HeadPart>()->turn_rad_s * kTick_s), 1e-12);
  encoder = {};
  encoder.validity = hal::Validity::Fresh;
  encoder.pan_rad = -0.4;
  encoder.tilt_rad = 0.9;
  mechanisms.follow(kTick_s, state);
  apply_mechanisms(space, robot, state);
  EXPECT_EQ(head.pan_rad, -0.4);
  EXPECT_EQ(head.tilt_rad, 0.9);
  EXPECT_TRUE(head.laser);
}

}  // namespace
}  // namespace tandem::mixed_reality
