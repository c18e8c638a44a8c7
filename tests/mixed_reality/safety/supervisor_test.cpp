#include "mixed_reality/safety/supervisor.hpp"

#include <gtest/gtest.h>
#include <set>

namespace tandem::mixed_reality {
namespace {

using hal::Validity;
constexpr hal::TimeNs kTick = 100 * hal::kNsPerMs;
constexpr Conditions kWell{RunPhase::Running, false, LinkHealth::Active, Validity::Fresh};

template <class Visit>
void for_all_conditions(Visit&& visit) {
  for (const RunPhase run : {RunPhase::Waiting, RunPhase::Running, RunPhase::Stopping}) {
    for (const bool failed : {false, true}) {
      for (const LinkHealth link :
           {LinkHealth::Connecting, LinkHealth::Active, LinkHealth::Suspect, LinkHealth::Lost}) {
        for (const Validity pose : {Validity::Absent, Validity::Stale, Validity::Fresh})
          visit(Conditions{run, failed, link, pose});
      }
    }
  }
}

TEST(SafetyTable, OneConditionAloneLetsARobotDrive) {
  int driving = 0;
  for_all_conditions([&](const Conditions& c) {
    const bool well =
        c.run == RunPhase::Running && !c.controller_failed && c.link == LinkHealth::Active && c.pose == Validity::Fresh;
    EXPECT_EQ(judge(c).may_drive, well) << judge(c).reason;
    EXPECT_EQ(judge(c).controller_steps, well);
    driving += judge(c).may_drive ? 1 : 0;
  });
  EXPECT_EQ(driving, 1);
}

TEST(SafetyTable, EveryRowIsReachedAndSaysWhyInWordsOfItsOwn) {
  std::set<std::string_view> reasons;
  for_all_conditions([&](const Conditions& c) { reasons.insert(judge(c).reason); });
  EXPECT_EQ(reasons.size(), safety_table().size());
}

TEST(SafetyTable, TheMostSeriousReasonIsTold) {
  EXPECT_EQ(judge({RunPhase::Running, false, LinkHealth::Lost, Validity::Stale}).reason, "link lost");
  EXPECT_EQ(judge({RunPhase::Running, true, LinkHealth::Lost, Validity::Stale}).reason, "controller stopped");
  EXPECT_EQ(judge({RunPhase::Stopping, true, LinkHealth::Lost, Validity::Stale}).reason, "the run is stopping");
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
  tick({RunPhase::Running, false, LinkHealth::Lost, Validity::Stale});
  EXPECT_EQ(supervisor_.verdict().reason, "link lost");
  tick(kWell);
  EXPECT_EQ(supervisor_.verdict().reason, "settling");
  tick(kWell);
  tick({RunPhase::Running, false, LinkHealth::Suspect, Validity::Fresh});  // not yet: the wait begins again
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
  tick({RunPhase::Running, false, LinkHealth::Lost, Validity::Stale});
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
  tick({RunPhase::Running, false, LinkHealth::Lost, Validity::Stale});
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

}  // namespace
}  // namespace tandem::mixed_reality
