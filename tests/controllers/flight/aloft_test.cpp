// When a flying robot may be steered, and what it is told otherwise.
#include "controllers/flight/aloft.hpp"

#include <gtest/gtest.h>
#include <string>

#include "hal/robot/eyebot.hpp"

namespace tandem::controllers {
namespace {

using hal::FlightFailsafe;
using hal::FlightOrder;
using hal::FlightPhase;
using hal::Validity;

/// Ports that the test fills; everything is fresh.
class Flyer final : public hal::Robot {
 public:
  Flyer() {
    for (hal::Reading* reading : {static_cast<hal::Reading*>(&state), static_cast<hal::Reading*>(&place)})
      reading->validity = Validity::Fresh;
    at(100);
  }
  void at(hal::TimeNs ms) {
    clock.now_ns = ms * 1'000'000;
    state.taken_ns = place.taken_ns = clock.now_ns;
  }
  std::string_view id() const noexcept override { return "flyer"; }
  const hal::RobotKind& kind() const noexcept override { return hal::eyebot::kind(); }
  std::uint64_t run_seed() const noexcept override { return 1; }

  hal::FlightTask task;
  hal::FlightState state;
  hal::Positioning place;
  hal::Clock clock;

 protected:
  void* take(const hal::PortType& type) override {
    if (type.name == hal::FlightTask::kName) return &task;
    if (type.name == hal::FlightState::kName) return &state;
    if (type.name == hal::Positioning::kName) return &place;
    if (type.name == hal::Clock::kName) return &clock;
    throw hal::DeviceError("robot has no " + std::string(type.name));
  }
};

TEST(Aloft, TakesOffAndSteersInTheAir) {
  Flyer robot;
  Aloft aloft(robot);
  robot.state.phase = FlightPhase::Landed;
  EXPECT_FALSE(aloft.ready());
  EXPECT_EQ(robot.task.order, FlightOrder::TakeOff);
  robot.state.phase = FlightPhase::TakingOff;
  EXPECT_FALSE(aloft.ready());
  EXPECT_EQ(robot.task.order, FlightOrder::TakeOff);
  for (const FlightPhase phase : {FlightPhase::Hovering, FlightPhase::Flying}) {
    robot.state.phase = phase;
    EXPECT_TRUE(aloft.ready());
    EXPECT_EQ(robot.task.order, FlightOrder::Fly);
  }
}

TEST(Aloft, DoesNotSteerByWhatIsMissingOrOld) {
  Flyer robot;
  Aloft aloft(robot);
  robot.state.phase = FlightPhase::Flying;
  ASSERT_TRUE(aloft.ready());
  for (hal::Reading* reading : {static_cast<hal::Reading*>(&robot.state), static_cast<hal::Reading*>(&robot.place)}) {
    for (const Validity validity : {Validity::Absent, Validity::Stale}) {
      reading->validity = validity;
      EXPECT_FALSE(aloft.ready());
      EXPECT_EQ(robot.task.order, FlightOrder::Fly) << "which is to hover";
    }
    reading->validity = Validity::Fresh;
    EXPECT_TRUE(aloft.ready());
    robot.clock.now_ns = reading->taken_ns + 500'000'000;
    EXPECT_TRUE(aloft.ready());
    robot.clock.now_ns += 1;
    EXPECT_FALSE(aloft.ready());
    robot.at(robot.clock.now_ns / 1'000'000);
  }
}

TEST(Aloft, GoesOnTakingOffWhileNothingIsKnown) {
  Flyer robot;
  Aloft aloft(robot);
  robot.state.phase = FlightPhase::Landed;
  ASSERT_FALSE(aloft.ready());
  robot.state.validity = Validity::Stale;
  EXPECT_FALSE(aloft.ready());
  EXPECT_EQ(robot.task.order, FlightOrder::TakeOff);
}

TEST(Aloft, LeavesTheRobotToItsFailsafe) {
  Flyer robot;
  Aloft aloft(robot);
  robot.state.phase = FlightPhase::Hovering;
  for (const FlightFailsafe failsafe :
       {FlightFailsafe::LinkLost, FlightFailsafe::LowBattery, FlightFailsafe::NoPosition, FlightFailsafe::Geofence,
        FlightFailsafe::Hardware}) {
    robot.state.failsafe = failsafe;
    EXPECT_FALSE(aloft.ready());
  }
  robot.state.failsafe = FlightFailsafe::CommandTimeout;
  EXPECT_TRUE(aloft.ready()) << "the next command ends it";
  robot.state.failsafe = FlightFailsafe::LowBattery;
  robot.state.phase = FlightPhase::Landed;
  EXPECT_FALSE(aloft.ready());
  EXPECT_EQ(robot.task.order, FlightOrder::Fly) << "it does not take off again";
  for (const FlightPhase phase : {FlightPhase::Off, FlightPhase::Stopped, FlightPhase::Landing}) {
    robot.state.failsafe = FlightFailsafe::None;
    robot.state.phase = phase;
    EXPECT_FALSE(aloft.ready());
  }
}

TEST(Aloft, LandsForGood) {
  Flyer robot;
  Aloft aloft(robot);
  robot.state.phase = FlightPhase::Hovering;
  ASSERT_TRUE(aloft.ready());
  EXPECT_FALSE(aloft.down());
  aloft.land();
  for (const FlightPhase phase : {FlightPhase::Hovering, FlightPhase::Landing, FlightPhase::Landed}) {
    robot.state.phase = phase;
    EXPECT_FALSE(aloft.ready());
    EXPECT_EQ(robot.task.order, FlightOrder::Land);
    EXPECT_EQ(aloft.down(), phase == FlightPhase::Landed);
  }
}

TEST(Aloft, LetsGoOfTheCeiling) {
  Flyer robot;
  Aloft aloft(robot);
  robot.state.phase = FlightPhase::Attached;
  EXPECT_FALSE(aloft.ready());
  EXPECT_EQ(robot.task.order, FlightOrder::Detach);
}

}  // namespace
}  // namespace tandem::controllers
