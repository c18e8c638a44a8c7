#include "bridges/emulation/fault_spec.hpp"

#include <gtest/gtest.h>

namespace tandem::bridges {
namespace {

constexpr hal::TimeNs kSecond = hal::kNsPerSecond;

TEST(FaultSpec, HasItsParts) {
  const auto whole = split_fault("missing=gripper@1500ms+2");
  ASSERT_TRUE(whole.ok());
  EXPECT_EQ(whole.value().name, "missing");
  EXPECT_EQ(whole.value().value, "gripper");
  EXPECT_EQ(whole.value().from(), 3 * kSecond / 2);
  EXPECT_EQ(whole.value().until(), 7 * kSecond / 2);
  const auto bare = split_fault("silent");
  ASSERT_TRUE(bare.ok());
  EXPECT_EQ(bare.value().name, "silent");
  EXPECT_FALSE(bare.value().value);
  EXPECT_EQ(bare.value().from(), 0);
  EXPECT_EQ(bare.value().until(), kEndless);
  EXPECT_EQ(split_fault("drop=").value().value, "");
}

TEST(FaultSpec, LastsAsLongAsItsKindUsuallyDoes) {
  EXPECT_EQ(split_fault("hangup@6s").value().until(kSecond), 7 * kSecond);
  EXPECT_EQ(split_fault("hangup@6s+3s").value().until(kSecond), 9 * kSecond);
  EXPECT_EQ(split_fault("reset@6s").value().until(0), 6 * kSecond);
}

TEST(FaultSpec, MayCountFromWhenTheRobotIsDriven) {
  const auto whole = split_fault("restart=left-motor@drive+2s+500ms");
  ASSERT_TRUE(whole.ok());
  EXPECT_TRUE(whole.value().since_drive);
  EXPECT_EQ(whole.value().value, "left-motor");
  EXPECT_EQ(whole.value().from(), 2 * kSecond);
  EXPECT_EQ(whole.value().until(), 5 * kSecond / 2);
  const auto at_once = split_fault("silent@drive");
  ASSERT_TRUE(at_once.ok());
  EXPECT_TRUE(at_once.value().since_drive);
  EXPECT_EQ(at_once.value().start, 0);
  EXPECT_EQ(at_once.value().until(), kEndless);
  EXPECT_FALSE(split_fault("silent@2s").value().since_drive);
  EXPECT_FALSE(split_fault("drive").value().since_drive) << "a name";
}

TEST(FaultSpec, RefusesTimesThatAreNone) {
  for (const char* text : {"silent@", "silent@soon", "silent@-1s", "silent@1s+", "silent@1s+2m/s", "silent@drive+",
                           "silent@drive+-1s", "silent@drive-1s", "silent@drives", "silent@drive 2s",
                           "silent@drive+1s+", "silent@drive+drive+1s", "silent@Drive+1s", "silent@1s+drive"}) {
    EXPECT_FALSE(split_fault(text).ok()) << text;
  }
  const std::string why = split_fault("silent@drvie+2s").error().message;
  EXPECT_NE(why.find("'drvie'"), std::string::npos) << why;
  EXPECT_NE(why.find("@drive+5s"), std::string::npos) << why;
}

TEST(FaultSpec, ReadsProbabilities) {
  EXPECT_EQ(parse_probability("0.25").value(), 0.25);
  for (const char* text : {"", "-0.1", "1.1", "often"}) EXPECT_FALSE(parse_probability(text).ok()) << text;
}

TEST(Chance, IsItsSeeds) {
  Chance a(7);
  Chance b(7);
  Chance c(8);
  EXPECT_EQ(a.draw(), b.draw());
  EXPECT_NE(a.draw(), c.draw());
  int hits = 0;
  for (int i = 0; i < 10'000; ++i) hits += a.hits(0.25) ? 1 : 0;
  EXPECT_NEAR(hits, 2500, 150);
  EXPECT_TRUE(a.hits(1.0));
  EXPECT_FALSE(a.hits(0.0));
}

TEST(FaultSpec, ClocksJumpByHoursForwardsAndBackwards) {
  EXPECT_EQ(parse_jump("1h").value(), 3600 * hal::kNsPerSecond);
  EXPECT_EQ(parse_jump("-90s").value(), -90 * hal::kNsPerSecond);
  EXPECT_FALSE(parse_jump("soon").ok());
  EXPECT_FALSE(parse_jump("1000000h").ok());
}

}  // namespace
}  // namespace tandem::bridges
