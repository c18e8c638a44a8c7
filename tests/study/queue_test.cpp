// Runs shared out among workers, and outcomes as messages.
#include "study/sweep/queue.hpp"

#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <rapidcheck.h>
#include <set>

#include "study/sweep/message.hpp"

namespace tandem::study {
namespace {

TEST(RunQueue, GivesEveryRunOnceHoweverFastWorkersAre) {
  EXPECT_TRUE(rc::check([] {
    const auto configurations = *rc::gen::inRange<std::int64_t>(1, 6);
    const auto total = *rc::gen::inRange<std::int64_t>(0, 60);
    const auto workers = *rc::gen::inRange<std::size_t>(1, 6);
    std::mt19937 chance(*rc::gen::arbitrary<std::uint32_t>());
    std::vector<std::int64_t> runs;
    for (std::int64_t n = 0; n < total; ++n) runs.push_back(n);
    RunQueue queue(runs, configurations, workers);
    std::set<std::int64_t> seen;
    std::set<std::size_t> idle;
    while (idle.size() < workers) {
      const auto worker = static_cast<std::size_t>(chance() % workers);
      const auto run = queue.next(worker);
      if (!run) {
        idle.insert(worker);
        continue;
      }
      if (chance() % 10 == 0) {
        queue.put_back(worker, *run);
        continue;
      }
      RC_ASSERT(seen.insert(*run).second);
    }
    RC_ASSERT(seen.size() == static_cast<std::size_t>(total));
  }));
}

TEST(RunQueue, LetsAWorkerStayWithItsConfiguration) {
  std::vector<std::int64_t> runs;
  for (std::int64_t n = 0; n < 40; ++n) runs.push_back(n);
  RunQueue queue(runs, 4, 2);
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(*queue.next(0) % 4, 0);
    EXPECT_EQ(*queue.next(1) % 4, 1);
  }
}

TEST(Message, ArrivesAsItWasSentInWhateverPieces) {
  RunOutcome o;
  o.done = true;
  o.ended = "length";
  o.failure = "a \"quote\"\n";
  o.ticks = 600;
  o.virtual_s = 60.0;
  o.fingerprint = 0xFEDCBA9876543210ULL;
  o.measures = {{"a", 1.0 / 3.0}, {"b", std::numeric_limits<double>::infinity()}};
  o.sample_ticks = {10, 20};
  o.samples = {{"a", {0.5, 0.25}}};
  const std::string sent = message_of(77, o) + message_of(78, {});
  std::string received;
  std::vector<ToldOutcome> told;
  for (const char c : sent) {
    received += c;
    while (auto message = take_message(received)) told.push_back(*message);
  }
  ASSERT_EQ(told.size(), 2U);
  EXPECT_EQ(told[0].run, 77);
  EXPECT_TRUE(told[0].outcome.done);
  EXPECT_EQ(told[0].outcome.failure, o.failure);
  EXPECT_EQ(told[0].outcome.fingerprint, o.fingerprint);
  EXPECT_EQ(told[0].outcome.measures, o.measures);
  EXPECT_EQ(told[0].outcome.sample_ticks, o.sample_ticks);
  EXPECT_EQ(told[0].outcome.samples, o.samples);
  EXPECT_EQ(told[1].run, 78);
  EXPECT_FALSE(told[1].outcome.done);
}

}  // namespace
}  // namespace tandem::study
