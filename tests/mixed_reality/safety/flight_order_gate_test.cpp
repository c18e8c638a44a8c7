#include "mixed_reality/safety/flight_order_gate.hpp"

#include <gtest/gtest.h>

namespace tandem::mixed_reality {
namespace {

using hal::FlightOrder;

constexpr hal::FlightTask task(FlightOrder order) {
  hal::FlightTask t;
  t.order = order;
  return t;
}

TEST(FlightOrderGate, PassesOrdersOfAControllerThatWasNeverStopped) {
  FlightOrderGate gate;
  EXPECT_EQ(gate.pass(task(FlightOrder::Fly), false, true).order, FlightOrder::Fly);  // waiting for the start
  EXPECT_EQ(gate.pass(task(FlightOrder::TakeOff), true, true).order, FlightOrder::TakeOff);
  EXPECT_EQ(gate.pass(task(FlightOrder::TakeOff), true, true).order, FlightOrder::TakeOff);
}

TEST(FlightOrderGate, AnOrderFromBeforeTheStopDoesNotLiftARobotThatStands) {
  FlightOrderGate gate;
  (void)gate.pass(task(FlightOrder::TakeOff), true, true);
  EXPECT_EQ(gate.pass(task(FlightOrder::TakeOff), false, true).order, FlightOrder::Fly);
  for (int tick = 0; tick < 5; ++tick) {
    EXPECT_EQ(gate.pass(task(FlightOrder::TakeOff), true, true).order, FlightOrder::Fly);
  }
  EXPECT_EQ(gate.pass(task(FlightOrder::Fly), true, true).order, FlightOrder::Fly);
  EXPECT_EQ(gate.pass(task(FlightOrder::TakeOff), true, true).order, FlightOrder::TakeOff);  // a new one does
}

TEST(FlightOrderGate, InTheAirTheOrderGoesOn) {
  FlightOrderGate gate;
  (void)gate.pass(task(FlightOrder::TakeOff), true, true);
  EXPECT_EQ(gate.pass(task(FlightOrder::TakeOff), false, false).order, FlightOrder::Fly);
  EXPECT_EQ(gate.pass(task(FlightOrder::TakeOff), true, false).order, FlightOrder::TakeOff);
}

TEST(FlightOrderGate, LandingPassesAlways) {
  FlightOrderGate gate;
  EXPECT_EQ(gate.pass(task(FlightOrder::Land), false, false).order, FlightOrder::Land);
  EXPECT_EQ(gate.pass(task(FlightOrder::Land), true, true).order, FlightOrder::Land);
}

TEST(FlightOrderGate, WhatIsNotSaidIsNotTheGround) {
  hal::FlightState state;
  state.phase = hal::FlightPhase::Landed;
  EXPECT_FALSE(says_on_ground(nullptr));
  EXPECT_FALSE(says_on_ground(&state));  // absent
  state.validity = hal::Validity::Fresh;
  EXPECT_TRUE(says_on_ground(&state));
  state.phase = hal::FlightPhase::Hovering;
  EXPECT_FALSE(says_on_ground(&state));
}

}  // namespace
}  // namespace tandem::mixed_reality
