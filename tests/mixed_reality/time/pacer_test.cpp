#include "mixed_reality/time/pacer.hpp"

#include <gtest/gtest.h>

#include "tests/mixed_reality/time/allocations.hpp"
#include "tests/mixed_reality/time/fake_time.hpp"

namespace tandem::mixed_reality {
namespace {

constexpr hal::TimeNs kMs = hal::kNsPerMs;
const std::atomic<bool> kGoOn{false};

TEST(Pacer, BeginsEveryTickOnAnAbsoluteScheduleThatNeverDrifts) {
  FakeTime time(5'000);
  time.oversleep_ns = 90'000;  // a relative sleep would add this up
  Pacer pacer(time, 30);       // 33 333 333.3 ns: no whole number
  pacer.start();
  for (int i = 0; i < 3'000; ++i) {
    time.pass(kMs);
    ASSERT_TRUE(pacer.wait_for_next(kGoOn));
  }
  EXPECT_EQ(pacer.scheduled_ns(), 5'000 + 100 * hal::kNsPerSecond);
  EXPECT_EQ(time.now_ns(), pacer.scheduled_ns() + 90'000);
  EXPECT_EQ(pacer.ledger().ticks, 3'000U);
  EXPECT_EQ(pacer.ledger().deadline_misses, 0U);
  EXPECT_EQ(pacer.ledger().skipped_slots, 0U);
  EXPECT_EQ(pacer.ledger().wake_up.largest_ns(), 90'000);
}

TEST(Pacer, ALateTickIsCountedTheNextBeginsAtOnceAndTheOneAfterIsOnScheduleAgain) {
  FakeTime time(0);
  Pacer pacer(time, 10);
  pacer.start();
  time.pass(130 * kMs);
  ASSERT_TRUE(pacer.wait_for_next(kGoOn));
  EXPECT_EQ(time.sleeps, 0);
  EXPECT_EQ(time.now_ns(), 130 * kMs);
  EXPECT_EQ(pacer.ledger().deadline_misses, 1U);
  EXPECT_EQ(pacer.ledger().largest_lateness_ns, 30 * kMs);
  EXPECT_EQ(pacer.ledger().skipped_slots, 0U);
  EXPECT_EQ(pacer.deadline_ns(), 200 * kMs);

  time.pass(20 * kMs);
  ASSERT_TRUE(pacer.wait_for_next(kGoOn));
  EXPECT_EQ(time.now_ns(), 200 * kMs);
  EXPECT_EQ(pacer.ledger().deadline_misses, 1U);
}

TEST(Pacer, LeavesOutWholeSlotsAfterAStallAndCountsEachOfThem) {
  FakeTime time(0);
  Pacer pacer(time, 10);
  pacer.start();
  time.pass(3'050 * kMs);  // slots 1 to 29 are gone, 30 is running
  ASSERT_TRUE(pacer.wait_for_next(kGoOn));
  EXPECT_EQ(time.now_ns(), 3'050 * kMs);
  EXPECT_EQ(pacer.scheduled_ns(), 3'000 * kMs);
  EXPECT_EQ(pacer.ledger().skipped_slots, 29U);
  EXPECT_EQ(pacer.ledger().deadline_misses, 1U);
  EXPECT_EQ(pacer.ledger().largest_lateness_ns, 2'950 * kMs);
  ASSERT_TRUE(pacer.wait_for_next(kGoOn));
  EXPECT_EQ(time.now_ns(), 3'100 * kMs);
}

TEST(Pacer, ATickThatEndsExactlyAtItsDeadlineIsNoMiss) {
  FakeTime time(0);
  Pacer pacer(time, 10);
  pacer.start();
  time.pass(100 * kMs);
  ASSERT_TRUE(pacer.wait_for_next(kGoOn));
  EXPECT_EQ(pacer.ledger().deadline_misses, 0U);
  EXPECT_EQ(pacer.scheduled_ns(), 100 * kMs);
}

TEST(Pacer, TheLedgerAddsUp) {
  FakeTime time(0);
  Pacer pacer(time, 3);  // slots of 333 333 333.3 ns
  pacer.start();
  for (int i = 0; i < 500; ++i) {
    time.pass((i * 37 % 11) * 100 * kMs);
    ASSERT_TRUE(pacer.wait_for_next(kGoOn));
  }
  const PaceLedger& ledger = pacer.ledger();
  EXPECT_EQ(static_cast<std::int64_t>(ledger.ticks + ledger.skipped_slots) * hal::kNsPerSecond / 3,
            pacer.scheduled_ns());
  EXPECT_EQ(ledger.step.count(), 500U);
  EXPECT_EQ(ledger.step.largest_ns(), 1'000 * kMs);
}

TEST(Pacer, BeginsNoTickOnceAskedToStop) {
  FakeTime time(0);
  Pacer pacer(time, 10);
  pacer.start();
  const std::atomic<bool> stop{true};
  EXPECT_FALSE(pacer.wait_for_next(stop));
  EXPECT_EQ(time.now_ns(), 0);
  EXPECT_EQ(pacer.ledger().ticks, 1U);
}

TEST(Pacer, TheLastTickIsInTheLedgerToo) {
  FakeTime time(0);
  Pacer pacer(time, 10);
  pacer.start();
  ASSERT_TRUE(pacer.wait_for_next(kGoOn));
  time.pass(130 * kMs);
  pacer.finish();
  EXPECT_EQ(pacer.ledger().ticks, 2U);
  EXPECT_EQ(pacer.ledger().deadline_misses, 1U);
  EXPECT_EQ(time.sleeps, 1);
}

TEST(Pacer, AllocatesNothing) {
  FakeTime time(0);
  Pacer pacer(time, 10);
  pacer.start();
  const std::size_t before = allocation_count();
  for (int i = 0; i < 1'000; ++i) {
    time.pass((i % 5) * 60 * kMs);
    (void)pacer.wait_for_next(kGoOn);
  }
  EXPECT_EQ(allocation_count(), before);
}

}  // namespace
}  // namespace tandem::mixed_reality
