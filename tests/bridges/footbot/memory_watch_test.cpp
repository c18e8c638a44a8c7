// What a module's words tell of a restart, and what they do not.
#include "bridges/footbot/memory_watch.hpp"

#include <gtest/gtest.h>
#include <vector>

namespace tandem::bridges::footbot {
namespace {

constexpr hal::TimeNs kMs = hal::kNsPerMs;
const std::vector<std::int16_t> kZero = {0, 0}, kA = {24, 0}, kB = {0, 12};

TEST(ToldWords, AreForgottenWhenTheyAreZerosThatNobodySent) {
  ToldWords told;
  told.sent(kZero, 10 * kMs);
  EXPECT_FALSE(told.forgotten(kZero, 20 * kMs));  // as it was found
  told.sent(kA, 1000 * kMs);
  EXPECT_FALSE(told.forgotten(kA, 1100 * kMs));
  told.sent(kB, 1200 * kMs);
  EXPECT_FALSE(told.forgotten(kA, 1300 * kMs));  // lost
  EXPECT_TRUE(told.forgotten(kZero, 1400 * kMs));
  EXPECT_FALSE(told.forgotten(kZero, 1400 * kMs));
  EXPECT_FALSE(told.forgotten(kZero, 1500 * kMs));  // told once
  EXPECT_FALSE(told.forgotten(kB, 1600 * kMs));
  EXPECT_TRUE(told.forgotten(kZero, 1700 * kMs));
}

TEST(ToldWords, AreNotForgottenWhereAnAnswerFromBeforeAStopComesLate) {
  ToldWords told;
  told.sent(kA, 1000 * kMs);
  EXPECT_FALSE(told.forgotten(kA, 1100 * kMs));
  told.sent(kZero, 1200 * kMs);
  EXPECT_FALSE(told.forgotten(kA, 1250 * kMs));
  told.sent(kB, 1260 * kMs);
  EXPECT_FALSE(told.forgotten(kZero, 1300 * kMs));
  EXPECT_FALSE(told.forgotten(kB, 1400 * kMs));
  EXPECT_TRUE(told.forgotten(kZero, 1800 * kMs));
}

TEST(ModuleCounter, BeginsAnewAtZero) {
  ModuleCounter counter;
  EXPECT_FALSE(counter.began_anew(5000, 100 * kMs));
  EXPECT_FALSE(counter.began_anew(5480, 200 * kMs));
  EXPECT_FALSE(counter.began_anew(5480, 200 * kMs));
  EXPECT_TRUE(counter.began_anew(0, 500 * kMs));
  EXPECT_FALSE(counter.began_anew(0, 600 * kMs));
  EXPECT_FALSE(counter.began_anew(480, 700 * kMs));
}

TEST(ModuleCounter, BeginsAnewInASilenceAndMayCountBeforeItIsRead) {
  ModuleCounter counter;
  for (int i = 1; i <= 20; ++i) EXPECT_FALSE(counter.began_anew(240 * i, i * 100 * kMs));
  EXPECT_TRUE(counter.began_anew(96, 2300 * kMs));
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(counter.began_anew(96, (2400 + i * 100) * kMs));
  EXPECT_FALSE(counter.began_anew(336, 2900 * kMs));
}

TEST(ModuleCounter, NearZeroAfterASilenceMayHaveCountedOn) {
  ModuleCounter counter;
  for (int i = 1; i <= 5; ++i) EXPECT_FALSE(counter.began_anew(1200 - 100 * i, i * 100 * kMs));
  EXPECT_FALSE(counter.began_anew(100, 1100 * kMs));  // as fast as before
  ModuleCounter still;
  for (int i = 1; i <= 5; ++i) EXPECT_FALSE(still.began_anew(700, i * 100 * kMs));
  EXPECT_FALSE(still.began_anew(40, 1100 * kMs));  // it was not counting: it has begun to
}

TEST(ModuleCounter, MayCountThroughZero) {
  ModuleCounter counter;
  std::int32_t raw = 960;
  for (int i = 1; i < 10; ++i, raw -= 160) EXPECT_FALSE(counter.began_anew(raw, i * 100 * kMs)) << raw;
}

TEST(ModuleCounter, FoundAtZeroHasNotBegunAnew) {
  ModuleCounter counter;
  EXPECT_FALSE(counter.began_anew(0, 100 * kMs));
  EXPECT_FALSE(counter.began_anew(80, 200 * kMs));
  EXPECT_FALSE(counter.began_anew(0, 300 * kMs));  // it rolled back and forth
}

}  // namespace
}  // namespace tandem::bridges::footbot
