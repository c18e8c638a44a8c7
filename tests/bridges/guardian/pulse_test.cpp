#include "bridges/guardian/pulse.hpp"

#include <gtest/gtest.h>

namespace tandem::bridges::guardian {
namespace {

using hal::kNsPerMs;
using hal::TimeNs;

constexpr auto kRuns = [] { return false; };
constexpr auto kStopped = [] { return true; };

/// A heart that beats, looked at every 20 ms.
class Beating : public testing::Test {
 protected:
  void SetUp() override {
    for (int i = 0; i < 10; ++i) EXPECT_FALSE(look(true));
  }
  bool look(bool beats, TimeNs after_ns = 20 * kNsPerMs, bool stopped = false) {
    now_ += after_ns;
    count_ += beats ? 1 : 0;
    return stopped ? pulse_.frozen(count_, now_, kStopped) : pulse_.frozen(count_, now_, kRuns);
  }
  /// Time of silence until it counts as frozen.
  TimeNs silence(bool stopped) {
    const TimeNs begin = now_;
    while (!look(false, 20 * kNsPerMs, stopped) && now_ - begin < hal::kNsPerSecond) {
    }
    return now_ - begin;
  }
  Pulse pulse_;
  TimeNs now_ = 5 * kNsPerMs;
  std::uint32_t count_ = 0;
};

TEST_F(Beating, IsFrozenAfterALongSilence) {
  EXPECT_EQ(silence(false), 360 * kNsPerMs);
}

TEST_F(Beating, IsFrozenSoonWhereTheSystemSaysThatItWasStopped) {
  EXPECT_EQ(silence(true), 100 * kNsPerMs);
}

TEST_F(Beating, IsNotBlamedForTheGuardiansOwnSleep) {
  EXPECT_FALSE(look(false, 10 * hal::kNsPerSecond));
  EXPECT_FALSE(look(true));
  for (int i = 0; i < 7; ++i) EXPECT_FALSE(look(false, hal::kNsPerSecond));  // each counts as 40 ms at most
  EXPECT_FALSE(look(true));
}

TEST_F(Beating, MayPauseAgainAndAgain) {
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(look(i % 16 == 0));
}

TEST(Pulse, BeginsWithTheFirstBeat) {
  Pulse pulse;
  for (TimeNs now = 0; now < hal::kNsPerSecond; now += 20 * kNsPerMs) EXPECT_FALSE(pulse.frozen(0, now, kStopped));
}

TEST(Pulse, GoesOnWhereTheNumberOfBeatsWraps) {
  Pulse pulse;
  EXPECT_FALSE(pulse.frozen(~0U, 0, kRuns));
  EXPECT_FALSE(pulse.frozen(0, 340 * kNsPerMs, kRuns));
  EXPECT_FALSE(pulse.frozen(0, 680 * kNsPerMs, kRuns));
}

TEST(OwnPulse, TellsAFreezeOfMoreThan400MsAndExcusesWhatIsShorter) {
  OwnPulse own;
  TimeNs now = 7 * hal::kNsPerSecond;
  EXPECT_EQ(own.slept(now), 0) << "the first beat";
  for (const TimeNs ms : {20, 0, 399, 419, 420}) EXPECT_EQ(own.slept(now += ms * kNsPerMs), 0) << ms;
  EXPECT_EQ(own.slept(now += 421 * kNsPerMs), 421 * kNsPerMs);
  EXPECT_EQ(own.slept(now += 20 * kNsPerMs), 0) << "it is told once";
  EXPECT_EQ(own.slept(now += 3600 * hal::kNsPerSecond), 3600 * hal::kNsPerSecond) << "a laptop that was closed";
}

}  // namespace
}  // namespace tandem::bridges::guardian
