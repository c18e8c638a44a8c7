#include "bridges/footbot_emulator/faults.hpp"

#include "tests/bridges/footbot_emulator/bench.hpp"

namespace tandem::bridges::footbot_emulator {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr hal::TimeNs kSecond = hal::kNsPerSecond;

Fault parsed(const std::string& text) {
  const auto fault = kFaults.parse(text);
  EXPECT_TRUE(fault.ok()) << text;
  return fault.ok() ? fault.value() : Fault{};
}

std::vector<std::string> sent(FaultPlan& plan, const std::vector<std::string>& frames) {
  std::vector<TimedFrame> out;
  hal::TimeNs at = 0;
  for (const std::string& f : frames) plan.to_host({frame(f), at += kMs}, out);
  std::vector<std::string> all;
  for (const TimedFrame& f : out) all.push_back(to_text(f.frame));
  return all;
}

TEST(Faults, AreRead) {
  const Fault missing = parsed("missing=gripper@0s+3s");
  EXPECT_EQ(missing.kind, FaultKind::Missing);
  EXPECT_EQ(missing.module, Place::Gripper);
  EXPECT_EQ(missing.until, 3 * kSecond);
  EXPECT_EQ(parsed("silent=3@5s").module, Place::Proximity);
  EXPECT_EQ(parsed("deaf=left_motor").module, Place::LeftMotor);
  EXPECT_FALSE(parsed("restart@2s").module);
  EXPECT_EQ(parsed("lie=range-and-bearing:count").lie, Lie::Count);
  EXPECT_EQ(parsed("swap=0.5@1+500ms").number, 0.5);
  EXPECT_EQ(parsed("delay=20ms").time_ns, 20 * kMs);
  EXPECT_EQ(parsed("hangup@6s").until, 7 * kSecond);
}

TEST(Faults, ThatThereAreNotAreRefusedWithTheList) {
  for (const char* text :
       {"", "explode@3s", "missing", "missing=wings", "restart=left-motor", "lie=left-motor", "lie=left-motor:age",
        "drop", "drop=2", "drop=x", "hangup", "hangup=1@2s", "delay=-1s", "silent@soon"}) {
    const auto fault = kFaults.parse(text);
    ASSERT_FALSE(fault.ok()) << text;
    EXPECT_THAT(fault.error().message, HasSubstr("missing=gripper@0s+3s")) << text;
  }
}

TEST(Faults, BeginAndEndInOrder) {
  FaultPlan plan({parsed("hangup@6s"), parsed("missing=gripper@1s+1s"), parsed("restart=base@3s")}, 1);
  plan.begin(100 * kSecond);
  EXPECT_FALSE(plan.next_change(100 * kSecond));
  std::vector<std::string> told;
  while (const auto change = plan.next_change(200 * kSecond)) {
    told.push_back(std::to_string(change->at / kSecond) + (change->begins ? "+" : "-") + change->fault->text);
  }
  EXPECT_THAT(told, ElementsAre("101+missing=gripper@1s+1s", "102-missing=gripper@1s+1s", "103+restart=base@3s",
                                "106+hangup@6s", "107-hangup@6s"));
}

TEST(Faults, ConcernModules) {
  Bench bench({.protocol = Protocol::V5});
  FaultPlan plan({parsed("missing=2@0+1s"), parsed("silent=1@2s+1s"), parsed("lie=3:name@4s+1s"), parsed("silent@6s")},
                 1);
  plan.begin(bench.now);
  const auto answers = [&] {
    while (const auto change = plan.next_change(bench.now)) apply(*change, bench.robot);
    return bench.ask("300#11A00500").size();
  };
  EXPECT_EQ(answers(), 8U);
  bench.pass(kSecond);
  EXPECT_EQ(answers(), 9U);
  bench.pass(kSecond);
  EXPECT_EQ(answers(), 8U);
  bench.pass(kSecond);
  EXPECT_EQ(answers(), 9U);
  bench.pass(kSecond);
  answers();
  EXPECT_THAT(bench.ask_messages("300#10A003000500").at(4), testing::Field(&Message::payload, testing::Contains('?')));
  bench.pass(2 * kSecond);
  EXPECT_EQ(answers(), 0U);
}

TEST(Faults, LoseDoubleAndSwapFrames) {
  const std::vector<std::string> frames = {"101#01", "001#02", "201#03", "301#04"};
  FaultPlan none({}, 1);
  EXPECT_EQ(sent(none, frames), frames);
  FaultPlan drop({parsed("drop=1")}, 1);
  EXPECT_THAT(sent(drop, frames), IsEmpty());
  FaultPlan twice({parsed("double=1")}, 1);
  EXPECT_THAT(sent(twice, {"101#01", "201#03"}), ElementsAre("101#01", "101#01", "201#03", "201#03"));
  FaultPlan swap({parsed("swap=1")}, 1);
  EXPECT_THAT(sent(swap, frames), ElementsAre("001#02", "101#01", "201#03", "301#04"));
  FaultPlan others({parsed("swap=1")}, 1);
  EXPECT_THAT(sent(others, {"101#01", "302#09", "201#03"}), ElementsAre("302#09", "201#03", "101#01"));
}

TEST(Faults, HappenAsOftenAsTheyShould) {
  FaultPlan plan({parsed("lose=0.25@0s+1s")}, 3);
  plan.begin(0);
  int through = 0;
  for (int i = 0; i < 4000; ++i) through += plan.reaches_robot(0) ? 1 : 0;
  EXPECT_NEAR(through, 3000, 150);
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(plan.reaches_robot(kSecond));
}

TEST(Faults, DelayKeepsTheOrder) {
  FaultPlan plan({parsed("delay=20ms@0s+5ms")}, 1);
  plan.begin(0);
  std::vector<TimedFrame> out;
  plan.to_host({frame("301#"), 1 * kMs}, out);
  plan.to_host({frame("302#"), 10 * kMs}, out);
  plan.to_host({frame("303#"), 30 * kMs}, out);
  EXPECT_EQ(out[0].at, 21 * kMs);
  EXPECT_EQ(out[1].at, 21 * kMs);
  EXPECT_EQ(out[2].at, 30 * kMs);
}

}  // namespace
}  // namespace tandem::bridges::footbot_emulator
