// When faults begin and end: on the emulator's clock, and since its robot was first driven.
#include "bridges/emulation/fault_schedule.hpp"

#include <gtest/gtest.h>

namespace tandem::bridges {
namespace {

constexpr hal::TimeNs kSecond = hal::kNsPerSecond;
constexpr hal::TimeNs kStart = 1000 * kSecond;

enum class Kind { Silent, Restart };

using Fault = FaultOf<Kind>;

Fault fault(Kind kind, const char* when) {
  const std::string text = std::string("x@") + when;
  const FaultSpec spec = split_fault(text).value();
  Fault made;
  made.kind = kind;
  made.from = spec.from();
  made.until = spec.until();
  made.since_drive = spec.since_drive;
  made.moment = kind == Kind::Restart;
  return made;
}

using Plan = FaultSchedule<Fault>;

/// "begin 3.0 end 5.0 " in seconds since `kStart`, of all that is told by `now`.
std::string changes(Plan& plan, hal::TimeNs now) {
  std::string all;
  while (const auto change = plan.next_change(now)) {
    const auto tenths = (change->at - kStart) / (kSecond / 10);
    all += change->begins ? "begin " : "end ";
    all += std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) + " ";
  }
  return all;
}

TEST(FaultSchedule, CountsFromTheStart) {
  Plan plan({fault(Kind::Silent, "3s+2s"), fault(Kind::Restart, "4s")}, 1);
  plan.begin(kStart);
  EXPECT_FALSE(plan.awaits_drive());
  EXPECT_EQ(plan.next_change_at(), kStart + 3 * kSecond);
  EXPECT_FALSE(plan.active(Kind::Silent, kStart + 3 * kSecond - 1));
  EXPECT_TRUE(plan.active(Kind::Silent, kStart + 3 * kSecond));
  EXPECT_EQ(changes(plan, kStart + 9 * kSecond), "begin 3.0 begin 4.0 end 5.0 ");
  EXPECT_FALSE(plan.next_change_at());
}

TEST(FaultSchedule, WaitsForTheDriveWithoutATime) {
  Plan plan({fault(Kind::Silent, "drive+3s+2s"), fault(Kind::Restart, "drive")}, 1);
  plan.begin(kStart);
  EXPECT_TRUE(plan.awaits_drive());
  EXPECT_FALSE(plan.next_change_at()) << "nobody is to wake up for it";
  for (const hal::TimeNs at : {hal::TimeNs{0}, kStart, kStart + 4 * kSecond, kStart + 10'000 * kSecond}) {
    EXPECT_EQ(changes(plan, at), "");
    EXPECT_FALSE(plan.active(Kind::Silent, at));
    EXPECT_FALSE(plan.active(Kind::Restart, at));
  }
}

TEST(FaultSchedule, CountsFromTheDrive) {
  Plan plan({fault(Kind::Silent, "drive+3s+2s"), fault(Kind::Silent, "1s+30s"), fault(Kind::Restart, "drive+4s")}, 1);
  plan.begin(kStart);
  EXPECT_EQ(changes(plan, kStart + 7 * kSecond), "begin 1.0 ");
  plan.driven(kStart + 10 * kSecond, kStart + 10 * kSecond + 1000);
  EXPECT_FALSE(plan.awaits_drive());
  EXPECT_EQ(plan.next_change_at(), kStart + 13 * kSecond);
  plan.driven(kStart + 20 * kSecond, kStart + 20 * kSecond);  // it is the first time that counts
  EXPECT_EQ(plan.next_change_at(), kStart + 13 * kSecond);
  EXPECT_EQ(changes(plan, kStart + 60 * kSecond), "begin 13.0 begin 14.0 end 15.0 end 31.0 ");
}

TEST(FaultSchedule, BeginsAFaultAtOnceAndInFullThatShouldHaveBegunBeforeTheDriveWasKnown) {
  Plan plan({fault(Kind::Silent, "drive+0s+500ms"), fault(Kind::Silent, "drive+2s+1s")}, 1);
  plan.begin(kStart);
  plan.driven(kStart + 10 * kSecond, kStart + 11 * kSecond);
  EXPECT_FALSE(plan.active(Kind::Silent, kStart + 11 * kSecond - 1));
  EXPECT_EQ(changes(plan, kStart + 60 * kSecond), "begin 11.0 end 11.5 begin 12.0 end 13.0 ");
}

TEST(FaultSchedule, LastsFromTheDriveToTheEndWithoutADuration) {
  Plan plan({fault(Kind::Silent, "drive")}, 1);
  plan.begin(kStart);
  plan.driven(kStart + kSecond, kStart + kSecond);
  EXPECT_EQ(changes(plan, kEndless), "begin 1.0 ");
  EXPECT_TRUE(plan.active(Kind::Silent, kStart + 1'000'000 * kSecond));
}

}  // namespace
}  // namespace tandem::bridges
