#include "bridges/eyebot/flight_plan.hpp"

#include <gtest/gtest.h>

namespace tandem::bridges::eyebot {

std::ostream& operator<<(std::ostream& out, const Step& s) {
  return out << action_name(s.action) << (s.fly ? ", flies" : "") << (s.done ? ", done" : "");
}
bool operator==(const Step& a, const Step& b) {
  return a.action == b.action && a.fly == b.fly && a.done == b.done;
}

namespace {

using hal::FlightFailsafe;
using hal::FlightOrder;

constexpr Step kWait = {};
constexpr Step kDone = {Action::Nop, false, true};
constexpr Step ask(Action a) {
  return {a, false, false};
}

Step obey(FlightOrder order, Mode mode) {
  return next_step({mode, true, FlightFailsafe::None, true, Goal::Obey, order, order != FlightOrder::Fly});
}

TEST(FlightPlan, IsATableOfOrderAndMode) {
  struct Row {
    Mode mode;
    Step fly, take_off, land, attach, detach;
  };
  const Step flies = {Action::Nop, true, true};
  const Row table[] = {{Mode::Off, kWait, kWait, kDone, kWait, kDone},
                       {Mode::Idle, kWait, ask(Action::TakeOff), ask(Action::Disarm), ask(Action::TakeOff), kDone},
                       {Mode::TakeOff, kWait, kWait, ask(Action::Land), kWait, kDone},
                       {Mode::Hover, flies, kDone, ask(Action::Land), ask(Action::Attach), kDone},
                       {Mode::Position, flies, kDone, ask(Action::Land), ask(Action::Attach), kDone},
                       {Mode::Velocity, flies, kDone, ask(Action::Land), ask(Action::Attach), kDone},
                       {Mode::Land, ask(Action::Hover), ask(Action::Hover), kWait, ask(Action::Hover), kDone},
                       {Mode::Attaching, ask(Action::Hover), ask(Action::Hover), ask(Action::Hover), kWait, kDone},
                       {Mode::Attached, kWait, kDone, ask(Action::Detach), kDone, ask(Action::Detach)},
                       {Mode::Detaching, kWait, kWait, kWait, kWait, kDone},
                       {Mode::Stopped, kWait, kWait, kDone, kWait, kDone}};
  for (const Row& row : table) {
    EXPECT_EQ(obey(FlightOrder::Fly, row.mode), row.fly) << mode_name(row.mode);
    EXPECT_EQ(obey(FlightOrder::TakeOff, row.mode), row.take_off) << mode_name(row.mode);
    EXPECT_EQ(obey(FlightOrder::Land, row.mode), row.land) << mode_name(row.mode);
    EXPECT_EQ(obey(FlightOrder::Attach, row.mode), row.attach) << mode_name(row.mode);
    EXPECT_EQ(obey(FlightOrder::Detach, row.mode), row.detach) << mode_name(row.mode);
  }
}

TEST(FlightPlan, AnOrderThatWasCarriedOutIsNotCarriedOutAgain) {
  for (int mode = 0; mode <= 10; ++mode) {
    const Situation s = {static_cast<Mode>(mode), true, FlightFailsafe::None, true, Goal::Obey,
                         FlightOrder::TakeOff,    false};
    EXPECT_EQ(next_step(s), kDone) << mode;
  }
}

TEST(FlightPlan, NeverSwitchesMotorsOffInTheAir) {
  for (int mode = 0; mode <= 10; ++mode) {
    for (int goal = 0; goal <= 2; ++goal) {
      for (int order = 0; order <= 4; ++order) {
        for (int failsafe = 0; failsafe <= 6; ++failsafe) {
          for (int flags = 0; flags < 8; ++flags) {
            const Situation s = {
                static_cast<Mode>(mode), (flags & 1) != 0,        static_cast<FlightFailsafe>(failsafe),
                (flags & 2) != 0,        static_cast<Goal>(goal), static_cast<FlightOrder>(order),
                (flags & 4) != 0};
            const Step step = next_step(s);
            EXPECT_NE(step.action, Action::Stop);
            EXPECT_TRUE(s.mode == Mode::Idle || step.action != Action::Disarm) << mode;
            if (step.fly) {
              EXPECT_TRUE(s.controlled && s.goal == Goal::Obey && obeys_setpoints(s.mode));
              EXPECT_TRUE(s.failsafe == FlightFailsafe::None || s.failsafe == FlightFailsafe::CommandTimeout);
            }
            EXPECT_TRUE(s.controlled || s.goal == Goal::Obey || step.action == Action::Nop) << mode;
          }
        }
      }
    }
  }
}

TEST(FlightPlan, HoversWhateverTheOrder) {
  for (const Mode mode : {Mode::TakeOff, Mode::Position, Mode::Velocity, Mode::Attaching, Mode::Detaching}) {
    EXPECT_EQ(next_step({mode, true, FlightFailsafe::None, true, Goal::Hover, FlightOrder::Attach, true}),
              ask(Action::Hover));
  }
  for (const Mode mode : {Mode::Off, Mode::Idle, Mode::Hover, Mode::Land, Mode::Attached, Mode::Stopped}) {
    EXPECT_EQ(next_step({mode, true, FlightFailsafe::None, true, Goal::Hover, FlightOrder::Attach, true}), kDone);
  }
}

TEST(FlightPlan, LandsAtTheEndButLeavesItAtTheCeiling) {
  const auto end = [](Mode mode, bool armed) {
    return next_step({mode, armed, FlightFailsafe::None, true, Goal::Land, FlightOrder::Fly, false});
  };
  EXPECT_EQ(end(Mode::Velocity, true), ask(Action::Land));
  EXPECT_EQ(end(Mode::Land, true), kWait);
  EXPECT_EQ(end(Mode::Idle, true), ask(Action::Disarm));
  EXPECT_EQ(end(Mode::Idle, false), kDone);
  EXPECT_EQ(end(Mode::Attached, true), kDone);
}

TEST(FlightPlan, AsksToGoOnAfterALostLink) {
  const auto after = [](Mode mode, FlightOrder order, bool pending) {
    return next_step({mode, true, FlightFailsafe::LinkLost, true, Goal::Obey, order, pending}).action;
  };
  EXPECT_EQ(after(Mode::Hover, FlightOrder::Fly, false), Action::ClearFailsafe);
  EXPECT_EQ(after(Mode::Idle, FlightOrder::Fly, false), Action::Nop);
  EXPECT_EQ(after(Mode::Idle, FlightOrder::TakeOff, true), Action::ClearFailsafe);
  EXPECT_EQ(after(Mode::Land, FlightOrder::Fly, false), Action::Nop);  // it goes on landing
}

TEST(FlightPlan, NumbersFromTheWireAreNotBelieved) {
  EXPECT_EQ(mode_of(-1), Mode::Off);
  EXPECT_EQ(mode_of(11), Mode::Off);
  EXPECT_EQ(mode_of(10), Mode::Stopped);
  EXPECT_EQ(failsafe_of(7), FlightFailsafe::None);
  EXPECT_EQ(failsafe_of(-128), FlightFailsafe::None);
}

}  // namespace
}  // namespace tandem::bridges::eyebot
