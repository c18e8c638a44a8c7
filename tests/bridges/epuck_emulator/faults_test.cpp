#include "bridges/epuck_emulator/faults.hpp"

#include <gtest/gtest.h>

namespace tandem::bridges::epuck_emulator {
namespace {

using hal::TimeNs;
constexpr TimeNs kSecond = hal::kNsPerSecond;

Fault parsed(std::string_view spec) {
  const auto fault = kFaults.parse(spec);
  EXPECT_TRUE(fault.ok()) << fault.error().message;
  return fault.ok() ? fault.value() : Fault{};
}

TEST(Faults, AreReadAsWritten) {
  const Fault silent = parsed("silent@5s+2s");
  EXPECT_EQ(silent.kind, FaultKind::Silent);
  EXPECT_EQ(silent.from, 5 * kSecond);
  EXPECT_EQ(silent.until, 7 * kSecond);
  EXPECT_EQ(parsed("reset@3s").from, 3 * kSecond);
  EXPECT_EQ(parsed("drop=0.01").number, 0.01);
  EXPECT_EQ(parsed("drop=1%").number, 0.01);
  EXPECT_EQ(parsed("corrupt=0.001@1+500ms").until, 3 * kSecond / 2);
  EXPECT_EQ(parsed("delay=20ms").time_ns, 20 * hal::kNsPerMs);
  EXPECT_EQ(parsed("hangup@6s").until, 7 * kSecond);
  EXPECT_EQ(parsed("garbage@0.5").from, kSecond / 2);
  EXPECT_EQ(parsed("truncate@2s").kind, FaultKind::Truncate);
  EXPECT_EQ(parsed("deaf@1min").from, 60 * kSecond);
}

TEST(Faults, AreRefusedWithTheListOfThoseThereAre) {
  for (const char* wrong : {"", "nonsense", "silent@", "silent@-1s", "silent@5m", "reset", "drop", "drop=2", "drop=x",
                            "delay=3cm", "delay=-1", "silent=1", "hangup@1s+", "silent@1s+2s+3s"}) {
    const auto fault = kFaults.parse(wrong);
    ASSERT_FALSE(fault.ok()) << wrong;
    EXPECT_NE(fault.error().message.find(wrong), std::string::npos);
    for (const char* known : {"silent", "deaf", "reset", "garbage", "truncate", "drop", "corrupt", "hangup", "delay"}) {
      EXPECT_NE(fault.error().message.find(known), std::string::npos) << known;
    }
  }
}

TEST(Faults, AreAtWorkInTheirTimeOnly) {
  FaultPlan plan({parsed("silent@1s+1s"), parsed("deaf@3s+1s")}, 1);
  plan.begin(100 * kSecond);
  EXPECT_TRUE(plan.to_host(7, 100 * kSecond).has_value());
  EXPECT_FALSE(plan.to_host(7, 101 * kSecond).has_value());
  EXPECT_TRUE(plan.to_robot(7, 101 * kSecond).has_value());
  EXPECT_TRUE(plan.to_host(7, 102 * kSecond).has_value());
  EXPECT_FALSE(plan.to_robot(7, 103 * kSecond + 1).has_value());
}

TEST(Faults, BeginAndEndOnceInOrder) {
  FaultPlan plan({parsed("hangup@2s+1s"), parsed("reset@1s"), parsed("drop=0.5")}, 1);
  plan.begin(0);
  EXPECT_EQ(plan.next_change(0)->fault->kind, FaultKind::Drop);
  EXPECT_FALSE(plan.next_change(0).has_value());
  EXPECT_EQ(plan.next_change_at(), kSecond);
  EXPECT_EQ(plan.next_change(10 * kSecond)->fault->kind, FaultKind::Reset);
  EXPECT_TRUE(plan.next_change(10 * kSecond)->begins);
  EXPECT_FALSE(plan.next_change(10 * kSecond)->begins);
  EXPECT_FALSE(plan.next_change(10 * kSecond).has_value());
  EXPECT_FALSE(plan.next_change_at().has_value());
}

TEST(Faults, HitAsOftenAsTheySayAndTheSameForTheSameSeed) {
  const auto run = [](std::uint64_t seed) {
    FaultPlan plan({parsed("drop=0.1"), parsed("corrupt=0.05")}, seed);
    plan.begin(0);
    std::vector<int> outcome;
    for (int i = 0; i < 20000; ++i) {
      const auto byte = plan.to_host(0x55, i);
      outcome.push_back(byte ? *byte : -1);
    }
    return outcome;
  };
  const auto outcome = run(7);
  const auto lost = std::count(outcome.begin(), outcome.end(), -1);
  const auto whole = std::count(outcome.begin(), outcome.end(), 0x55);
  EXPECT_NEAR(static_cast<double>(lost), 2000, 5 * 42);  // five standard deviations
  EXPECT_NEAR(static_cast<double>(20000 - lost - whole), 900, 5 * 30);
  EXPECT_EQ(run(7), outcome);
  EXPECT_NE(run(8), outcome);
}

TEST(Faults, GarbleEveryByte) {
  FaultPlan plan({}, 1);
  for (int i = 0; i < 10000; ++i) EXPECT_NE(plan.garble(static_cast<std::uint8_t>(i)), static_cast<std::uint8_t>(i));
}

TEST(Faults, DoubleSomeBytesAndOnlyWhileTheyAreAtWork) {
  FaultPlan plan({parsed("double=0.5@1s+1s")}, 3);
  plan.begin(0);
  int twice = 0;
  for (int i = 0; i < 1000; ++i) {
    EXPECT_FALSE(plan.doubles(kSecond / 2));
    if (plan.doubles(3 * kSecond / 2)) ++twice;
  }
  EXPECT_NEAR(twice, 500, 80);
}

}  // namespace
}  // namespace tandem::bridges::epuck_emulator
