// Lateness of our own thread.
#include "bridges/link/stall_meter.hpp"

#include <gtest/gtest.h>

namespace tandem::bridges {
namespace {

constexpr hal::TimeNs kMs = hal::kNsPerMs;

TEST(StallMeter, CountsWhatIsBeyondThePromise) {
  StallMeter meter;
  EXPECT_EQ(meter.turn(1000 * kMs), 0);
  EXPECT_EQ(meter.turn(1020 * kMs), 0);
  EXPECT_EQ(meter.turn(1059 * kMs), 0);  // a little late is no stall
  EXPECT_EQ(meter.turn(1379 * kMs), 300 * kMs);
}

TEST(StallMeter, ExcusesAStallWhileItsAnswersComeAndThenOnlySoMuch) {
  StallMeter meter;
  (void)meter.turn(0);
  EXPECT_EQ(meter.patience_ns(0), 0);
  (void)meter.turn(620 * kMs);
  EXPECT_EQ(meter.patience_ns(620 * kMs), 600 * kMs);
  EXPECT_EQ(meter.patience_ns(919 * kMs), 600 * kMs);
  EXPECT_EQ(meter.patience_ns(920 * kMs), StallMeter::kMostPatience);
}

TEST(StallMeter, ForgetsAfterAWhile) {
  StallMeter meter;
  hal::TimeNs now = 0;
  (void)meter.turn(now);
  (void)meter.turn(now += 120 * kMs);
  for (int i = 0; i < 450; ++i) (void)meter.turn(now += 20 * kMs);
  EXPECT_EQ(meter.patience_ns(now), 100 * kMs);
  for (int i = 0; i < 1000; ++i) (void)meter.turn(now += 20 * kMs);
  EXPECT_EQ(meter.patience_ns(now), 0);
}

TEST(StallMeter, AFreezeIsNotExcused) {
  StallMeter meter;
  (void)meter.turn(0);
  EXPECT_EQ(meter.turn(4000 * kMs), 0);
  EXPECT_EQ(meter.patience_ns(4000 * kMs), StallMeter::kMostPatience);
}

}  // namespace
}  // namespace tandem::bridges
