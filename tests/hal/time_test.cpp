#include "hal/time.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

namespace tandem::hal {
namespace {

TEST(TimeOfTick, IsExactWhereTheTickIs) {
  EXPECT_EQ(time_of_tick(0, 10), 0);
  EXPECT_EQ(time_of_tick(7, 10), 700 * kNsPerMs);
  EXPECT_EQ(time_of_tick(36'000, 10), 3600 * kNsPerSecond);
}

TEST(TimeOfTick, DoesNotDriftWhereTheTickIsNoWholeNumberOfNanoseconds) {
  EXPECT_EQ(time_of_tick(1, 3), 333'333'333);
  EXPECT_EQ(time_of_tick(2, 3), 666'666'666);
  EXPECT_EQ(time_of_tick(3, 3), kNsPerSecond);
  EXPECT_EQ(time_of_tick(3'000'000'000, 3), 1'000'000'000 * kNsPerSecond) << "after 31 years";
}

TEST(TimeOfTick, EveryTickIsWithinANanosecondOfTheTruthAndLaterThanTheOneBefore) {
  EXPECT_TRUE(rc::check([] {
    const auto rate = *rc::gen::inRange<std::int64_t>(1, 100'001);
    const auto tick = *rc::gen::inRange<std::int64_t>(0, 1'000'000'000);
    const TimeNs t = time_of_tick(tick, rate);
    // The quotient, rounded down. Every product here is below 2^63.
    RC_ASSERT(t * rate <= tick * kNsPerSecond);
    RC_ASSERT((t + 1) * rate > tick * kNsPerSecond);
    RC_ASSERT(time_of_tick(tick + 1, rate) > t);
    RC_ASSERT(time_of_tick(tick * rate, rate) == tick * kNsPerSecond);
  }));
}

TEST(ToSeconds, IsTheNearestDouble) {
  EXPECT_EQ(to_seconds(300 * kNsPerMs), 0.3);
  EXPECT_EQ(to_seconds(-kNsPerSecond), -1.0);
  EXPECT_EQ(to_seconds(1), 1e-9);
}

}  // namespace
}  // namespace tandem::hal
