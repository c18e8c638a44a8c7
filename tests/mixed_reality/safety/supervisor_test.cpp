#include "mixed_reality/safety/supervisor.hpp"

#include <bit>
#include <gtest/gtest.h>
#include <set>

#include "hal/device/flight.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::mixed_reality {
namespace {

using hal::Validity;
constexpr hal::TimeNs kTick = 100 * hal::kNsPerMs;
constexpr Conditions kWell{.link = LinkHealth::Active, .pose = Validity::Fresh};

constexpr Conditions with(void (*change)(Conditions&)) {
  Conditions c = kWell;
  change(c);
  return c;
}
constexpr Conditions kLost = with([](Conditions& c) {
  c.link = LinkHealth::Lost;
  c.pose = Validity::Stale;
});
constexpr Conditions kRestarted = with([](Conditions& c) { c.robot_stopped_itself = true; });

/// Every combination.
template <class Visit>
void for_all_conditions(Visit&& visit) {
  for (const RunPhase run :
       {RunPhase::Waiting, RunPhase::Running, RunPhase::Stopping, RunPhase::Paused, RunPhase::Joining}) {
    for (const LinkHealth link : {LinkHealth::Connecting, LinkHealth::Active, LinkHealth::Suspect, LinkHealth::Lost}) {
      for (const Validity pose : {Validity::Absent, Validity::Stale, Validity::Fresh}) {
        for (unsigned bits = 0; bits < 32768; ++bits) {
          const auto is = [bits](unsigned i) { return (bits >> i & 1U) != 0; };
          Conditions c{run,  is(10), is(0), is(1),  is(2),  is(3), is(4), is(5),  Doubt::None, is(6),
                       link, is(7),  pose,  is(11), is(12), is(8), is(9), is(13), is(14)};
          visit(c);
          // A doubt with every one and every two of the others.
          if (std::popcount(bits) > 2) continue;
          for (const Doubt doubt : {Doubt::Late, Doubt::Away, Doubt::OpenedAnew, Doubt::Another}) {
            c.doubt = doubt;
            visit(c);
          }
        }
      }
    }
  }
}

TEST(SafetyTable, OneConditionAloneLetsARobotDrive) {
  int driving = 0;
  for_all_conditions([&](const Conditions& c) {
    const bool goes = c.run == RunPhase::Running || c.run == RunPhase::Joining;
    const bool well = goes && c.doubt == Doubt::None && c.link == LinkHealth::Active && c.pose == Validity::Fresh &&
                      !c.controller_failed && !c.emergency_stop && !c.operator_holds && !c.hook_holds &&
                      !c.hub_was_frozen && !c.guardian_gone && !c.robot_stopped_itself && !c.battery_low &&
                      !c.readings_missing && !c.pose_disputed && !c.links_swapped && !c.pose_jumped &&
                      !c.wheels_differ && !c.being_replaced && !c.replaced;
    EXPECT_EQ(judge(c).may_drive, well) << judge(c).reason;
    EXPECT_EQ(judge(c).controller_steps, well);
    EXPECT_EQ(judge(c).owner == StopOwner::Nobody, well);
    driving += judge(c).may_drive ? 1 : 0;
  });
  EXPECT_EQ(driving, 2);
}

TEST(SafetyTable, EveryRowIsReachedAndSaysWhyInWordsOfItsOwn) {
  std::set<std::string_view> reasons;
  std::set<StopOwner> owners;
  for_all_conditions([&](const Conditions& c) {
    reasons.insert(judge(c).reason);
    owners.insert(judge(c).owner);
  });
  EXPECT_EQ(reasons.size(), safety_table().size());
  EXPECT_EQ(owners.size(), kStopOwners);
}

TEST(SafetyTable, TheMostSeriousReasonIsTold) {
  Conditions c = kLost;
  EXPECT_EQ(judge(c).reason, "link lost");
  c.hook_holds = true;
  EXPECT_EQ(judge(c).reason, "held by a hook");
  c.controller_failed = true;
  EXPECT_EQ(judge(c).reason, "controller failed");
  c.run = RunPhase::Stopping;
  EXPECT_EQ(judge(c).reason, "the run is stopping");
}

TEST(SafetyTable, WhatNeedsARearmSaysWhatItWaitsFor) {
  for (const SafetyRule& rule : safety_table()) EXPECT_EQ(rule.waiting.empty(), rule.recovery == Recovery::Ends);
}

class ArmedSupervisor : public testing::Test {
 protected:
  void SetUp() override {
    while (!supervisor_.verdict().may_drive) tick(kWell);
    for (int i = 0; i < 20; ++i) tick(kWell);
  }
  void tick(const Conditions& c) {
    now_ += kTick;
    supervisor_.judge(c, now_);
  }
  hal::WheelSpeeds allowed(double left, double right) const {
    hal::WheelSpeeds wanted;
    wanted.set(left, right);
    return supervisor_.allowed(wanted, now_);
  }
  /// How long it takes until the robot drives, in s; 100: it does not.
  double well_until_driving() {
    for (int i = 0; i < 1000; ++i) {
      tick(kWell);
      if (supervisor_.verdict().may_drive) return 0.1 * i;
    }
    return 100.0;
  }
  void use(const RearmPolicy& policy) {
    supervisor_ = Supervisor({.policy = policy, .settle_s = 0.3, .ramp_m_s2 = 0.1});
    SetUp();
  }
  Supervisor supervisor_{{.settle_s = 0.3, .ramp_m_s2 = 0.1}};
  hal::TimeNs now_ = 0;
};

TEST_F(ArmedSupervisor, HandsCommandsThroughUnchanged) {
  EXPECT_EQ(allowed(0.1234, -0.05).left_m_s, 0.1234);
  EXPECT_EQ(allowed(0.1234, -0.05).right_m_s, -0.05);
  EXPECT_EQ(supervisor_.rearms(), 1U);
  EXPECT_EQ(supervisor_.stops(), 0U);
}

TEST_F(ArmedSupervisor, StopsInTheVeryTickInWhichSomethingFails) {
  for_all_conditions([&](const Conditions& c) {
    if (judge(c).may_drive) return;
    Supervisor s = supervisor_;
    s.judge(c, now_ + kTick);
    hal::WheelSpeeds wanted;
    wanted.set(0.1, 0.1);
    EXPECT_EQ(s.allowed(wanted, now_ + kTick).left_m_s, 0.0) << judge(c).reason;
    EXPECT_EQ(s.allowed(wanted, now_ + kTick).right_m_s, 0.0);
    EXPECT_EQ(s.stops(), 1U);
  });
}

TEST_F(ArmedSupervisor, LetsGoOnlyAfterAllHasBeenWellForAWhile) {
  tick(kLost);
  EXPECT_EQ(supervisor_.verdict().reason, "link lost");
  tick(kWell);
  EXPECT_EQ(supervisor_.verdict().reason, "settling");
  tick(kWell);
  tick(with([](Conditions& c) { c.link = LinkHealth::Suspect; }));  // not yet: the wait begins again
  for (int i = 0; i < 3; ++i) {
    tick(kWell);
    EXPECT_FALSE(supervisor_.verdict().may_drive) << i;
    EXPECT_FALSE(supervisor_.verdict().controller_steps) << i;
  }
  tick(kWell);
  EXPECT_TRUE(supervisor_.verdict().may_drive);
  EXPECT_EQ(supervisor_.stops(), 1U);
  EXPECT_EQ(supervisor_.rearms(), 2U);
}

TEST_F(ArmedSupervisor, GetsUnderWayFromZeroWithoutAJumpAndOnTheCurveWanted) {
  tick(kLost);
  while (!supervisor_.verdict().may_drive) tick(kWell);
  double before = 0.0;
  EXPECT_EQ(allowed(0.1, 0.05).left_m_s, 0.0);
  for (int i = 0; i < 10; ++i) {
    tick(kWell);
    const hal::WheelSpeeds now = allowed(0.1, 0.05);
    EXPECT_NEAR(now.left_m_s - before, 0.01, 1e-12) << i;  // 0.1 m/s2 in 0.1 s
    EXPECT_NEAR(now.right_m_s, 0.5 * now.left_m_s, 1e-12) << i;
    before = now.left_m_s;
  }
  EXPECT_NEAR(before, 0.1, 1e-12);
}

TEST_F(ArmedSupervisor, FliesOffWithoutAJumpInTheDirectionWanted) {
  hal::QuadrotorSpeed wanted;
  wanted.set(0.6, 0.0, 0.8, 0.3);
  tick(kLost);
  EXPECT_EQ(supervisor_.allowed(wanted, 0).yaw_rad_s, 0.0);
  while (!supervisor_.verdict().may_drive) tick(kWell);
  double before = -1.0;
  for (int i = 0; i < 5; ++i) {
    tick(kWell);
    const hal::QuadrotorSpeed now = supervisor_.allowed(wanted, now_);
    EXPECT_NEAR(now.velocity[2] * 0.6, now.velocity[0] * 0.8, 1e-12) << i;
    EXPECT_GT(now.velocity[0], before) << i;
    EXPECT_LT(now.velocity[0], 0.6) << i;
    EXPECT_EQ(now.yaw_rad_s, 0.3) << i;
    before = now.velocity[0];
  }
}

TEST_F(ArmedSupervisor, DrivesWithinASecondOfTheLinkThatIsBack) {
  Supervisor as_usual{RearmParams{}};
  for (hal::TimeNs t = 0; t <= hal::kNsPerSecond; t += kTick) as_usual.judge(kWell, t);
  ASSERT_TRUE(as_usual.verdict().may_drive);
  as_usual.judge(kLost, 2 * hal::kNsPerSecond);
  hal::TimeNs t = 3 * hal::kNsPerSecond;
  for (; !as_usual.judge(kWell, t).may_drive; t += kTick) ASSERT_LT(t, 4 * hal::kNsPerSecond);
  EXPECT_LE(t, 3 * hal::kNsPerSecond + hal::kNsPerSecond / 2);
}

TEST_F(ArmedSupervisor, ARobotThatStoppedByItselfWaitsForItsRearm) {
  for (const RearmPolicy& policy : {RearmPolicy{}, RearmPolicy{RearmBy::Time, 2.0}, RearmPolicy{RearmBy::Operator}}) {
    use(policy);
    tick(kRestarted);
    EXPECT_EQ(supervisor_.verdict().reason, "robot stopped by itself");
    EXPECT_EQ(supervisor_.stops_by(StopOwner::Robot), 1U);
    tick(kWell);
    EXPECT_EQ(supervisor_.verdict().reason, "robot stopped by itself; waits to be re-armed");
    EXPECT_TRUE(supervisor_.awaits_rearm());
    EXPECT_TRUE(supervisor_.unproved());
    EXPECT_EQ(well_until_driving(), 100.0);
    supervisor_.rearm();
    EXPECT_NEAR(well_until_driving(), 0.3, 1e-9);
  }
}

TEST_F(ArmedSupervisor, WhoeverIsNotProvedToBeTheArmedRobotWaitsForAPersonWhateverThePolicy) {
  for (const RearmPolicy& policy : {RearmPolicy{}, RearmPolicy{RearmBy::Time, 0.1}, RearmPolicy{RearmBy::Operator}}) {
    for (const Doubt doubt : {Doubt::Late, Doubt::Away, Doubt::OpenedAnew, Doubt::Another}) {
      use(policy);
      tick(kLost);
      Conditions back = kWell;
      back.doubt = doubt;
      tick(back);
      EXPECT_FALSE(supervisor_.verdict().may_drive);
      EXPECT_EQ(well_until_driving(), 100.0);
      EXPECT_TRUE(supervisor_.unproved());
      tick(kLost);
      supervisor_.rearm();  // of nobody: it does not answer
      EXPECT_EQ(well_until_driving(), 100.0);
      supervisor_.rearm();
      EXPECT_NEAR(well_until_driving(), 0.3, 1e-9);
      EXPECT_FALSE(supervisor_.unproved());
    }
  }
}

TEST_F(ArmedSupervisor, ByDefaultAShortOutageEndsByItselfAndEveryOtherStopWaits) {
  use({});
  tick(kLost);
  EXPECT_NEAR(well_until_driving(), 0.3, 1e-9);
  tick(with([](Conditions& c) { c.pose_jumped = true; }));
  EXPECT_EQ(well_until_driving(), 100.0);
  EXPECT_FALSE(supervisor_.unproved());
  supervisor_.rearm();
  EXPECT_NEAR(well_until_driving(), 0.3, 1e-9);
}

TEST_F(ArmedSupervisor, AfterATimeAProvedRobotGoesOnAlone) {
  use({RearmBy::Time, 2.0});
  tick(with([](Conditions& c) { c.hub_was_frozen = true; }));
  EXPECT_NEAR(well_until_driving(), 2.0, 1e-9);
}

TEST_F(ArmedSupervisor, WithTheOperatorEveryStopWaitsForAPersonButNoneBeforeItFirstDrove) {
  use({RearmBy::Operator});
  tick(with([](Conditions& c) { c.link = LinkHealth::Suspect; }));
  EXPECT_EQ(well_until_driving(), 100.0);
  EXPECT_EQ(supervisor_.verdict().reason, "link was suspect; waits to be re-armed");
  supervisor_.rearm();
  EXPECT_NEAR(well_until_driving(), 0.3, 1e-9);
  supervisor_ = Supervisor({.policy = {RearmBy::Operator}, .settle_s = 0.3});
  tick(with([](Conditions& c) { c.pose = Validity::Absent; }));
  EXPECT_NEAR(well_until_driving(), 0.3, 1e-9);
}

TEST_F(ArmedSupervisor, LettingGoOfARobotDoesNotProveWhichOneItIs) {
  tick(with([](Conditions& c) { c.doubt = Doubt::Another; }));
  tick(with([](Conditions& c) { c.operator_holds = true; }));
  EXPECT_EQ(well_until_driving(), 100.0);
  tick(with([](Conditions& c) { c.emergency_stop = true; }));
  EXPECT_EQ(well_until_driving(), 100.0);
}

TEST_F(ArmedSupervisor, AnOutageOnTheWayDoesNotReplaceTheRearm) {
  use({RearmBy::Operator});
  tick(kRestarted);
  tick(kLost);
  EXPECT_EQ(supervisor_.verdict().reason, "link lost");
  EXPECT_EQ(well_until_driving(), 100.0);
  EXPECT_EQ(supervisor_.verdict().reason, "robot stopped by itself; waits to be re-armed");
  supervisor_.rearm();
  EXPECT_NEAR(well_until_driving(), 0.3, 1e-9);
}

TEST_F(ArmedSupervisor, WhereARearmIsLeftToAnOperatorHoldingAndLettingGoIsOne) {
  use({RearmBy::Operator});
  tick(with([](Conditions& c) { c.hub_was_frozen = true; }));
  EXPECT_EQ(well_until_driving(), 100.0);
  tick(with([](Conditions& c) { c.operator_holds = true; }));
  EXPECT_EQ(supervisor_.verdict().reason, "held by the operator");
  EXPECT_NEAR(well_until_driving(), 0.3, 1e-9);
}

TEST_F(ArmedSupervisor, NeverIsNever) {
  use({RearmBy::Never});
  tick(kLost);
  EXPECT_NEAR(well_until_driving(), 0.3, 1e-9);  // an outage is no stop that needs a re-arm
  tick(kRestarted);
  supervisor_.rearm();
  EXPECT_EQ(well_until_driving(), 100.0);
}

TEST_F(ArmedSupervisor, ALowBatteryLandsAndOnlyAPersonLetsItGo) {
  use({RearmBy::Time, 2.0});
  tick(with([](Conditions& c) { c.battery_low = true; }));
  EXPECT_TRUE(supervisor_.verdict().land);
  tick(kLost);
  EXPECT_TRUE(supervisor_.verdict().land);
  tick(kWell);  // its voltage recovers when it rests
  EXPECT_TRUE(supervisor_.verdict().land);
  EXPECT_EQ(well_until_driving(), 100.0);
  supervisor_.rearm();
  EXPECT_NEAR(well_until_driving(), 0.3, 1e-9);
  EXPECT_FALSE(supervisor_.verdict().land);
}

TEST_F(ArmedSupervisor, TheStartOfARunArmsAll) {
  use({RearmBy::Never});
  Conditions before = kRestarted;
  before.run = RunPhase::Waiting;
  tick(before);
  EXPECT_NEAR(well_until_driving(), 0.3, 1e-9);
}

TEST_F(ArmedSupervisor, StopsAreCountedForWhoBeganThem) {
  tick(with([](Conditions& c) { c.hook_holds = true; }));
  tick(kLost);
  (void)well_until_driving();
  tick(kLost);
  EXPECT_EQ(supervisor_.stops(), 2U);
  EXPECT_EQ(supervisor_.stops_by(StopOwner::Hook), 1U);
  EXPECT_EQ(supervisor_.stops_by(StopOwner::Link), 1U);
  EXPECT_EQ(name_of(StopOwner::Link), "link");
}

}  // namespace
}  // namespace tandem::mixed_reality
