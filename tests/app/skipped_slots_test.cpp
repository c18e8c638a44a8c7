// What a record of a mixed run tells of slots in which no tick could begin, in time that the test turns by hand.
#include <array>
#include <cstdio>
#include <gtest/gtest.h>
#include <map>

#include "app/real/real_robots.hpp"
#include "core/record/record.hpp"
#include "core/record/record_reader.hpp"
#include "mixed_reality/session/mixed_session.hpp"
#include "tests/core/scenes.hpp"
#include "tests/mixed_reality/fake_robot.hpp"
#include "tests/mixed_reality/time/fake_time.hpp"

namespace tandem::app {
namespace {

using mixed_reality::FakeBody;
using mixed_reality::FakeRobot;
using mixed_reality::FakeTime;
using mixed_reality::MixedSession;

constexpr hal::TimeNs kMs = hal::kNsPerMs;
const std::atomic<bool> kGoOn{false};

class SkippedSlots : public testing::Test {
 protected:
  void TearDown() override { std::remove(path_.c_str()); }
  /// Sixty ticks of 100 ms; after tick t the hub stands still for `stalls[t]`.
  void run(std::map<hal::Tick, hal::TimeNs> stalls) {
    core::Scene scene;
    scene.robot("ep0", -1.0, 0.0);
    scene.scenario.robots[0].bridge = core::BridgeConfig{"fake:ep0", 0.5, {}, 7};
    core::MadeWorld made = core::make(scene);
    ASSERT_TRUE(made.world) << made.all_problems();
    auto opened = MixedSession::make(std::move(made.world),
                                     [this](const bridges::BridgeRequest&) -> bridges::MadeBridge {
                                       return std::unique_ptr<bridges::RobotBridge>(std::make_unique<FakeRobot>(body_));
                                     },
                                     time_, {});
    ASSERT_TRUE(opened.ok()) << opened.error().message;
    const std::unique_ptr<MixedSession> session = std::move(opened).value();
    ASSERT_TRUE(session->connect(kGoOn).ok());
    core::RecordConfig config;
    config.path = path_;
    auto recorder = core::Recorder::open(config, session->world().space(), {{"program", "test"}});
    ASSERT_TRUE(recorder.ok()) << recorder.error().message;
    std::uint32_t told = 0;
    const hal::Status done = session->run(60, kGoOn, [&](core::World& world) {
      const hal::Tick tick = world.tick() - 1;
      began_ns_[tick] = session->clock().monotonic_ns;
      EXPECT_TRUE(recorder.value()->tick_done(world.space(), tick).ok());
      if (const auto skipped = skipped_event(session->clock(), told)) {
        EXPECT_TRUE(recorder.value()->event(tick, *skipped).ok());
      }
      if (const auto stall = stalls.find(tick); stall != stalls.end()) time_.pass(stall->second);
    });
    ASSERT_TRUE(done.ok()) << done.error().message;
    ASSERT_TRUE(recorder.value()->close(59, {}).ok());
  }
  std::vector<core::RecordEvent> events() {
    auto reader = core::RecordReader::open(path_);
    EXPECT_TRUE(reader.ok());
    return reader.ok() ? reader.value().events() : std::vector<core::RecordEvent>();
  }

  const std::string path_ =
      testing::TempDir() + "skipped_slots_" + testing::UnitTest::GetInstance()->current_test_info()->name();
  FakeTime time_{7'000'000'000};
  FakeBody body_;
  std::map<hal::Tick, hal::TimeNs> began_ns_;  // by this test's own clock
};

TEST_F(SkippedSlots, AreAnEventOfTheTickThatCameThen) {
  run({{10, 350 * kMs}, {30, 1030 * kMs}, {31, 220 * kMs}});
  const auto told = events();
  ASSERT_EQ(told.size(), 3U);
  // The last stall begins 30 ms into its slot.
  const std::array<std::pair<hal::Tick, int>, 3> expected = {{{11, 2}, {31, 9}, {32, 1}}};
  for (std::size_t i = 0; i < told.size(); ++i) {
    const auto [tick, slots] = expected[i];
    EXPECT_EQ(told[i].json["kind"], "skipped");
    EXPECT_EQ(told[i].tick, tick);
    EXPECT_EQ(told[i].json["slots"], slots);
    EXPECT_EQ(told[i].json["monotonic_ns"], began_ns_[tick]);
  }
}

TEST_F(SkippedSlots, AreNoneWhereTheHubIsLateForLessThanASlot) {
  run({{10, 90 * kMs}, {20, 199 * kMs}});
  EXPECT_TRUE(events().empty());
}

}  // namespace
}  // namespace tandem::app
