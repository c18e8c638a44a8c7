#include "mixed_reality/time/scheduling.hpp"

#include <gtest/gtest.h>

#include "mixed_reality/time/pacer.hpp"
#include "mixed_reality/time/system_clock.hpp"
#include "tests/mixed_reality/time/fake_time.hpp"

namespace tandem::mixed_reality {
namespace {

constexpr hal::TimeNs kMs = hal::kNsPerMs;
const std::atomic<bool> kGoOn{false};

class FakeScheduling final : public SchedulingLog {
 public:
  ThreadUse thread_use() noexcept override { return use; }
  hal::TimeNs stalled_ns(hal::TimeNs, hal::TimeNs) noexcept override { return stalled; }

  ThreadUse use;
  hal::TimeNs stalled = 0;
};

class JudgedPacer : public testing::Test {
 protected:
  JudgedPacer() {
    pacer_.judge_by(scheduling_);
    pacer_.start();
  }
  /// A tick that computes and waits so long.
  void tick(hal::TimeNs runs_ns, hal::TimeNs waits_ns, hal::TimeNs blocks_ns = 0) {
    time_.pass(runs_ns + waits_ns + blocks_ns);
    scheduling_.use.ran_ns += runs_ns;
    scheduling_.use.waited_ns += waits_ns;
    EXPECT_TRUE(pacer_.wait_for_next(kGoOn));
  }
  const PaceLedger& ledger() const { return pacer_.ledger(); }

  FakeTime time_{1'000'000};
  FakeScheduling scheduling_;
  Pacer pacer_{time_, 10};
};

TEST_F(JudgedPacer, ATickThatComputedTooLongIsOurs) {
  tick(130 * kMs, 5 * kMs);
  EXPECT_EQ(ledger().deadline_misses, 1U);
  EXPECT_EQ(ledger().misses_by_machine, 0U);
  EXPECT_EQ(ledger().first_misses[0].ran_ns, 130 * kMs);
  EXPECT_EQ(ledger().first_misses[0].lateness_ns, 35 * kMs);
}

TEST_F(JudgedPacer, OneThatGotNoProcessorIsTheMachines) {
  tick(20 * kMs, 10 * kMs);
  tick(20 * kMs, 110 * kMs);
  EXPECT_EQ(ledger().deadline_misses, 1U);
  EXPECT_EQ(ledger().misses_by_machine, 1U);
  EXPECT_EQ(ledger().first_misses[0].tick, 1U);
}

TEST_F(JudgedPacer, OneThatWasBlockedIsOursUnlessTheWitnessWasKeptToo) {
  tick(10 * kMs, 0, 120 * kMs);  // a disk, a lock
  EXPECT_EQ(ledger().misses_by_machine, 0U);
  tick(10 * kMs, 0);
  scheduling_.stalled = 40 * kMs;
  tick(10 * kMs, 0, 120 * kMs);
  EXPECT_EQ(ledger().deadline_misses, 2U);
  EXPECT_EQ(ledger().misses_by_machine, 1U);
}

TEST_F(JudgedPacer, WhoWasLateBecauseOfTheTickBeforeHasTheSameCause) {
  tick(20 * kMs, 140 * kMs);  // 60 ms late
  tick(60 * kMs, 0);          // begins 60 ms late, and ends 20 ms late
  EXPECT_EQ(ledger().deadline_misses, 2U);
  EXPECT_EQ(ledger().misses_by_machine, 2U);
  tick(60 * kMs, 0);
  tick(160 * kMs, 0);
  tick(60 * kMs, 0);
  EXPECT_EQ(ledger().deadline_misses, 4U);
  EXPECT_EQ(ledger().misses_by_machine, 2U) << "ours is handed on as ours";
}

TEST(SystemSchedulingLog, KnowsThatThisThreadHasComputed) {
  SystemScheduling scheduling;
  const hal::TimeNs from_ns = MonotonicTime().now_ns();
  const auto before = scheduling.thread_use();
  volatile double sum = 0.0;
  while (scheduling.thread_use().ran_ns - before.ran_ns < 20 * kMs) sum = sum + 1.0;
  const auto after = scheduling.thread_use();
  const hal::TimeNs to_ns = MonotonicTime().now_ns();
  EXPECT_GE(after.waited_ns, before.waited_ns);
  EXPECT_LE(after.ran_ns - before.ran_ns, to_ns - from_ns + 10 * kMs)
      << "the system adds it up once a clock tick of its own";
  EXPECT_LE(scheduling.stalled_ns(from_ns, to_ns), to_ns - from_ns);
  EXPECT_EQ(scheduling.stalled_ns(from_ns, from_ns), 0);
}

TEST(SystemClockOfThisMachine, IsToldInWordsThatFit) {
  const SystemClock clock = system_clock();
  if (clock.synchronised) {
    EXPECT_NE(clock.text().find("synchronised, within"), std::string::npos);
  } else {
    EXPECT_TRUE(clock.text().starts_with("not ")) << clock.text();
  }
  SystemClock good;
  good.known = good.synchronised = true;
  good.most_error_ns = 1'300'000;
  good.estimated_error_ns = 200'000;
  EXPECT_EQ(good.text(), "synchronised, within 1.3 ms (estimated 0.2 ms)");
}

}  // namespace
}  // namespace tandem::mixed_reality
