// Offset, drift and error of another clock, against clocks that are known exactly.
#include "bridges/clock_estimator.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace tandem::bridges {
namespace {

constexpr hal::TimeNs kMs = hal::kNsPerMs;
constexpr hal::TimeNs kS = hal::kNsPerSecond;
constexpr std::int64_t kEpoch = 1'700'000'000'000'000;  // what the other clock shows at our 0, microseconds

/// Another clock, and messages on their way: at least `shortest_ns`, and longer by chance.
struct Other {
  explicit Other(unsigned seed) : chance(seed) {}

  std::int64_t ahead_ns = kEpoch * 1000;
  double rate_ppm = 0.0;  // by which it is slow
  hal::TimeNs shortest_ns = kMs;
  double mean_more_ns = 2e6;
  std::mt19937_64 chance;

  std::int64_t shows(hal::TimeNs at_ns) const {
    return ahead_ns + at_ns - static_cast<std::int64_t>(std::llround(static_cast<double>(at_ns) * rate_ppm * 1e-6));
  }
  hal::TimeNs way() {
    return shortest_ns + static_cast<hal::TimeNs>(std::exponential_distribution<double>(1.0 / mean_more_ns)(chance));
  }
  void tell(ClockEstimator& clock, hal::TimeNs at_ns) { clock.note(shows(at_ns), at_ns + way()); }
  void answer(ClockEstimator& clock, hal::TimeNs asked_ns) {
    const hal::TimeNs at_ns = asked_ns + way();
    clock.note_answer(shows(at_ns), asked_ns, at_ns + way());
  }
  double error_ns(const ClockEstimator& clock, hal::TimeNs at_ns) const {
    return static_cast<double>(clock.offset_ns(at_ns) - (at_ns - shows(at_ns)));
  }
};

TEST(OtherClock, TakesTheQuickestMessageForTheOffset) {
  ClockEstimator clock;
  EXPECT_EQ(clock.local(1000 * (kEpoch), 5 * kMs), 5 * kMs);  // nothing known: as it came
  for (int i = 0; i < 100; ++i) {
    const hal::TimeNs sent = i * 20 * kMs;
    const hal::TimeNs delay = (1 + i % 7) * kMs;
    clock.note(1000 * (kEpoch + sent / 1000), sent + delay);
  }
  EXPECT_EQ(clock.local(1000 * (kEpoch + 3'000'000), 4 * kS), 3 * kS + kMs);
  EXPECT_EQ(clock.local(1000 * (kEpoch + 9'000'000), 4 * kS), 4 * kS);  // nothing comes from the future
  EXPECT_EQ(clock.jumps(), 0U);
}

TEST(OtherClock, HalvesARoundTrip) {
  ClockEstimator clock;
  clock.note(1000 * (kEpoch + 10'000), 14 * kMs);                      // 4 ms on its way here
  clock.note_answer(1000 * (kEpoch + 104'000), 100 * kMs, 108 * kMs);  // 4 ms there, 4 ms back
  EXPECT_EQ(clock.local(1000 * (kEpoch + 1'000'000), 2 * kS), kS);
}

TEST(OtherClock, FollowsADrift) {
  ClockEstimator clock;
  for (int i = 0; i < 3000; ++i) {  // a minute, 100 parts in a million too slow
    const hal::TimeNs sent = i * 20 * kMs;
    clock.note(1000 * (kEpoch + (sent - sent / 10000) / 1000), sent + kMs);
  }
  const hal::TimeNs sent = 60 * kS;
  EXPECT_NEAR(static_cast<double>(clock.local(1000 * (kEpoch + (sent - sent / 10000) / 1000), sent + kMs)),
              static_cast<double>(sent), 2e6);
}

TEST(OtherClock, NoticesThatItWasSetBackAfterFiveMessages) {
  ClockEstimator clock;
  for (int i = 0; i < 10; ++i) clock.note(1000 * (kEpoch + i * 20'000), i * 20 * kMs);
  const std::int64_t hour = 3'600'000'000;
  for (int i = 10; i < 14; ++i) clock.note(1000 * (kEpoch - hour + i * 20'000), i * 20 * kMs);
  EXPECT_EQ(clock.jumps(), 0U);
  EXPECT_LT(clock.local(1000 * (kEpoch - hour + 260'000), 260 * kMs), -3000 * kS);
  clock.note(1000 * (kEpoch - hour + 14 * 20'000), 280 * kMs);
  EXPECT_EQ(clock.jumps(), 1U);
  EXPECT_EQ(clock.local(1000 * (kEpoch - hour + 280'000), 280 * kMs), 280 * kMs);
}

TEST(OtherClock, OneStampOfTheFutureChangesNothing) {
  for (const std::int64_t ahead_us : {std::int64_t{200'000}, std::int64_t{3'600'000'000}}) {
    ClockEstimator clock;
    clock.note_answer(1000 * (kEpoch), 0, 2 * kMs);
    for (int i = 1; i < 10; ++i) clock.note(1000 * (kEpoch + i * 20'000), i * 20 * kMs);
    const hal::TimeNs before = clock.offset_ns(200 * kMs);
    clock.note(1000 * (kEpoch + 200'000 + ahead_us), 200 * kMs);
    EXPECT_EQ(clock.local(1000 * (kEpoch + 200'000 + ahead_us), 200 * kMs), 200 * kMs);
    EXPECT_EQ(clock.offset_ns(200 * kMs), before);
    EXPECT_EQ(clock.jumps(), 0U);
  }
}

TEST(OtherClock, AnAnswerStampedBeforeItsQuestionProvesThatItWasSetBack) {
  ClockEstimator clock;
  for (int i = 0; i < 10; ++i) clock.note(1000 * (kEpoch + i * 20'000), i * 20 * kMs);
  clock.note_answer(1000 * (kEpoch + 200'000 - 400'000), 199 * kMs, 201 * kMs);
  EXPECT_EQ(clock.jumps(), 1U);
  EXPECT_NEAR(static_cast<double>(clock.local(1000 * (kEpoch + 300'000 - 400'000), 301 * kMs)), 300e6, 2e6);
}

TEST(OtherClock, LeavesOutWhatNoClockShows) {
  ClockEstimator clock;
  clock.note(std::numeric_limits<std::int64_t>::min(), kS);
  clock.note(std::numeric_limits<std::int64_t>::max(), kS);
  EXPECT_FALSE(clock.known());
  EXPECT_EQ(clock.state(kS).implausible, 2U);
  EXPECT_EQ(clock.local(std::numeric_limits<std::int64_t>::max(), kS), kS);
}

TEST(OtherClock, LearnsItsDriftByMessagesThatComeOneWay) {
  for (const double ppm : {-80.0, 0.0, 35.0, 150.0}) {
    Other other(static_cast<unsigned>(ppm) + 1000U);
    other.rate_ppm = ppm;
    ClockEstimator clock;
    for (hal::TimeNs at = 0; at < 180 * kS; at += 50 * kMs) {
      other.tell(clock, at);
      if (at < 20 * kS) continue;
      EXPECT_NEAR(other.error_ns(clock, at), 1e6, 3e6) << ppm << " ppm, " << at;
    }
    const ClockState state = clock.state(180 * kS);
    EXPECT_NEAR(state.drift_ppm, ppm, 2.0);
    EXPECT_LE(state.drift_bound_ppm, 10.0);
    EXPECT_FALSE(state.bound_ns) << "the shortest way is not known";
    EXPECT_EQ(state.jumps + state.shifts, 0U);
    // Silent for half a minute, it is still known.
    EXPECT_NEAR(other.error_ns(clock, 210 * kS), 1e6, 0.5e6);
  }
}

TEST(OtherClock, ItsErrorIsWithinTheBoundThatExchangesGive) {
  int tight = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    Other other(seed);
    other.rate_ppm = -100.0 + 5.0 * seed;
    other.mean_more_ns = 3e6;
    ClockEstimator clock;
    for (hal::TimeNs at = 0; at < 300 * kS; at += kS) {
      other.answer(clock, at);
      const ClockState state = clock.state(at + kS / 2);
      ASSERT_TRUE(state.bound_ns);
      EXPECT_LE(std::fabs(other.error_ns(clock, at + kS / 2)), static_cast<double>(*state.bound_ns))
          << seed << ' ' << at;
      EXPECT_NEAR(state.drift_ppm, other.rate_ppm, state.drift_bound_ppm + 1.0) << seed << ' ' << at;
    }
    const ClockState state = clock.state(300 * kS);
    tight += *state.bound_ns <= 2 * kMs ? 1 : 0;
    EXPECT_EQ(state.jumps, 0U);
    EXPECT_EQ(state.exchanges, 300U);
    EXPECT_NEAR(state.drift_ppm, other.rate_ppm, 5.0);
  }
  EXPECT_GE(tight, 38) << "shortest round trip 2 ms: half of it, and what chance adds";
}

TEST(OtherClock, FollowsWhenItIsSetWhateverTheDirectionAndKeepsItsDrift) {
  for (const std::int64_t by_ns : {3600 * kS, -3600 * kS, 5 * kS, -5 * kS}) {
    Other other(7);
    other.rate_ppm = 60.0;
    ClockEstimator clock;
    for (hal::TimeNs at = 0; at < 60 * kS; at += 50 * kMs) other.tell(clock, at);
    other.ahead_ns += by_ns;
    for (hal::TimeNs at = 60 * kS; at < 61 * kS; at += 50 * kMs) other.tell(clock, at);
    EXPECT_EQ(clock.jumps(), 1U) << by_ns;
    EXPECT_NEAR(other.error_ns(clock, 61 * kS), 1e6, 4e6);
    EXPECT_NEAR(clock.state(61 * kS).drift_ppm, 60.0, 10.0);
  }
}

TEST(OtherClock, SetByATenthOfASecondIsFollowedToo) {
  for (const std::int64_t by_ns : {100 * kMs, -100 * kMs}) {
    Other other(8);
    ClockEstimator clock;
    for (hal::TimeNs at = 0; at < 60 * kS; at += 50 * kMs) other.tell(clock, at);
    other.ahead_ns += by_ns;
    for (hal::TimeNs at = 60 * kS; at < 76 * kS; at += 50 * kMs) other.tell(clock, at);
    EXPECT_NEAR(other.error_ns(clock, 76 * kS), 1e6, 4e6) << by_ns;
    EXPECT_EQ(clock.state(76 * kS).shifts, 1U);
    EXPECT_EQ(clock.jumps(), 0U) << "nobody can know that it was no longer way";
  }
}

TEST(OtherClock, AWayThatIsLongerForAWhileShiftsNothingWhereAnswersVouch) {
  Other other(9);
  ClockEstimator clock;
  for (hal::TimeNs at = 0; at < 60 * kS; at += 50 * kMs) {
    other.tell(clock, at);
    if (at % kS == 0) other.answer(clock, at);
  }
  other.shortest_ns = 40 * kMs;
  for (hal::TimeNs at = 60 * kS; at < 90 * kS; at += 50 * kMs) {
    other.tell(clock, at);
    if (at % kS == 0) other.answer(clock, at);
  }
  const ClockState state = clock.state(90 * kS);
  EXPECT_EQ(state.jumps + state.shifts, 0U);
  EXPECT_NEAR(other.error_ns(clock, 90 * kS), 0.0, 2e6);
}

TEST(OtherClock, MessagesMayBeToldInAnotherOrderThanTheyCame) {
  Other other(12);
  other.rate_ppm = 40.0;
  ClockEstimator clock;
  for (hal::TimeNs at = 0; at < 120 * kS; at += 20 * kMs) {
    for (const hal::TimeNs ago : {0, 12, 5, 17})
      clock.note(other.shows(at - ago * kMs + 20 * kMs), at - ago * kMs + 21 * kMs);
  }
  EXPECT_EQ(clock.state(120 * kS).jumps + clock.state(120 * kS).shifts, 0U);
  EXPECT_NEAR(clock.state(120 * kS).drift_ppm, 40.0, 1.0);
}

TEST(OtherClock, DamagedStampsChangeNothing) {
  Other other(10);
  std::mt19937_64 chance(11);
  ClockEstimator clock;
  for (hal::TimeNs at = 0; at < 120 * kS; at += 50 * kMs) {
    other.tell(clock, at);
    if (at % kS == 0 && at > 20 * kS) clock.note(static_cast<std::int64_t>(chance()), at + kMs);
  }
  EXPECT_EQ(clock.jumps(), 0U);
  EXPECT_NEAR(other.error_ns(clock, 120 * kS), 1e6, 1e6);
}

}  // namespace
}  // namespace tandem::bridges
