#include "mixed_reality/tracking/trackers.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>

#include "hal/robot/footbot.hpp"
#include "mixed_reality/tracking/fused_pose.hpp"

namespace tandem::mixed_reality {
namespace {

constexpr hal::TimeNs kMs = hal::kNsPerMs;
constexpr hal::TimeNs kHour = 3600 * hal::kNsPerSecond;
constexpr hal::TimeNs kUnix_ns = 1'700'000'000'000'000'000;
hal::TimeNs g_unix_ns = kUnix_ns;

class FakeTracker final : public bridges::Tracker {
 public:
  explicit FakeTracker(std::vector<bridges::Sighting>& waiting) : waiting_(waiting) {}
  hal::Status start() override { return {}; }
  std::size_t take(std::span<bridges::Sighting> into) noexcept override {
    const std::size_t count = std::min(into.size(), waiting_.size());
    std::copy_n(waiting_.begin(), count, into.begin());
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(count));
    return count;
  }
  bridges::TrackerReport report() const override { return {}; }

 private:
  std::vector<bridges::Sighting>& waiting_;
};

class AllTrackers : public testing::Test {
 protected:
  AllTrackers()
      : pose_(core::Pose::at(0.0, 0.0, 0.0), *hal::footbot::kind().drive(), encoders_, nullptr, {}),
        trackers_({-2.0, -2.0, 2.0, 2.0}, []() noexcept { return g_unix_ns; }) {
    g_unix_ns = kUnix_ns;
  }
  void add(const std::string& clock, double latency_s = 0.0) {
    core::TrackerItem item;
    item.id = "ceiling";
    item.clock = clock;
    item.latency_s = latency_s;
    item.p_WT = {1.0, 0.5, 0.0};
    item.turn_rad = std::numbers::pi / 2;
    trackers_.add(item, std::make_unique<FakeTracker>(waiting_));
    trackers_.add_robot({"7", "ep0"}, {.turn_rad = 0.25}, pose_);
  }
  void see(std::optional<std::int64_t> stamp_ns, const std::string& who = "7") {
    bridges::Sighting s;
    s.set_name(who);
    s.stamp_ns = stamp_ns;
    s.received_ns = now_ns_;
    s.p_m = {0.2, 0.1, 0.0};
    s.heading_rad = 0.5;
    waiting_.push_back(s);
  }
  void latch() { trackers_.latch({0, now_ns_}); }
  TrackerStatus status() const { return trackers_.status(now_ns_).front(); }

  hal::TimeNs now_ns_ = 10 * hal::kNsPerSecond;
  std::vector<bridges::Sighting> waiting_;
  hal::WheelEncoders encoders_;
  FusedPose pose_;
  Trackers trackers_;
};

TEST_F(AllTrackers, TurnsWhatIsSeenIntoTheArenasFrame) {
  add("monotonic");
  see(now_ns_ - 60 * kMs);
  latch();
  ASSERT_TRUE(pose_.seen()[0].has_value());
  const PoseMeasurement& m = *pose_.seen()[0];
  EXPECT_NEAR(m.x_m, 0.9, 1e-12);
  EXPECT_NEAR(m.y_m, 0.7, 1e-12);
  EXPECT_NEAR(*m.heading_rad, 0.25 + std::numbers::pi / 2, 1e-12);
  EXPECT_EQ(m.taken_ns, now_ns_ - 60 * kMs);
  EXPECT_NEAR(status().newest_age_s, 0.06, 1e-9);
}

TEST_F(AllTrackers, TakesATagThatIsNotInTheMiddleOfItsRobot) {
  add("monotonic");
  trackers_.remove_robot(pose_);
  trackers_.add_robot({"7"}, {.turn_rad = 0.5, .x_m = 0.02, .y_m = 0.01}, pose_);
  see(now_ns_);
  latch();
  ASSERT_TRUE(pose_.seen()[0].has_value());
  EXPECT_NEAR(*pose_.seen()[0]->heading_rad, std::numbers::pi / 2, 1e-12);
  EXPECT_NEAR(pose_.seen()[0]->x_m, 0.9 + 0.01, 1e-12);
  EXPECT_NEAR(pose_.seen()[0]->y_m, 0.7 - 0.02, 1e-12);
}

TEST_F(AllTrackers, KnowsARobotByEachOfItsNamesAndCountsStrangers) {
  add("monotonic");
  see(now_ns_, "ep0");
  see(now_ns_ - 1, "8");
  see(now_ns_ - 2, "8");
  latch();
  EXPECT_TRUE(pose_.seen()[0].has_value());
  EXPECT_EQ(status().unknown, 2U);
  EXPECT_EQ(status().unknown_names, std::vector<std::string>{"8"});
}

TEST_F(AllTrackers, TakesTheDateOfTheSystem) {
  add("unix");
  see(kUnix_ns - 40 * kMs);
  latch();
  EXPECT_EQ(pose_.seen()[0]->taken_ns, now_ns_ - 40 * kMs);
}

TEST_F(AllTrackers, ADateThatIsAnHourOffIsNotBelieved) {
  add("unix");
  g_unix_ns += kHour;
  see(kUnix_ns - 40 * kMs);
  latch();
  g_unix_ns -= 2 * kHour;
  see(kUnix_ns - 40 * kMs);
  latch();
  EXPECT_FALSE(pose_.seen()[0].has_value());
  EXPECT_EQ(status().old, 1U);
  EXPECT_EQ(status().from_future, 1U);
}

TEST_F(AllTrackers, WhenThisComputersDateIsSetATrackersStampsAreGoodByTheFormerOne) {
  add("unix");
  const auto see_one = [&](hal::TimeNs tracker_ahead_ns) {
    now_ns_ += 33 * kMs;
    g_unix_ns += 33 * kMs;
    see(kUnix_ns + now_ns_ - 10 * hal::kNsPerSecond + tracker_ahead_ns - 40 * kMs);
    latch();
    return now_ns_ - pose_.seen()[0]->taken_ns;
  };
  EXPECT_EQ(see_one(0), 40 * kMs);
  g_unix_ns += kHour;
  for (int i = 0; i < 30; ++i) EXPECT_EQ(see_one(0), 40 * kMs);
  EXPECT_EQ(status().by_former_date, 30U);
  EXPECT_EQ(status().old + status().from_future, 0U);
  EXPECT_EQ(see_one(kHour), 40 * kMs) << "the tracker's date was set as well";
  EXPECT_EQ(status().by_former_date, 30U);
  // It was the tracker's alone: nobody knows by how much.
  EXPECT_GT(see_one(3 * kHour), 40 * kMs) << "the last one that was believed";
  EXPECT_EQ(status().from_future, 1U);
}

TEST_F(AllTrackers, TellsByHowMuchTheDatesOfTwoComputersAreApart) {
  add("unix");
  for (int i = 0; i < 20; ++i) {
    now_ns_ += 33 * kMs;
    g_unix_ns += 33 * kMs;
    see(g_unix_ns + 500 * kMs - (20 + i) * kMs);  // its clock is half a second ahead
    latch();
  }
  ASSERT_TRUE(status().shortest_way_s);
  EXPECT_NEAR(*status().shortest_way_s, -0.48, 1e-3);
  EXPECT_EQ(status().from_future, 20U);
}

TEST_F(AllTrackers, StampsThatNoClockShowsAreCountedAndNotBelieved) {
  add("unix");
  see(std::numeric_limits<std::int64_t>::min());
  see(std::numeric_limits<std::int64_t>::max());
  latch();
  EXPECT_FALSE(pose_.seen()[0].has_value());
  EXPECT_EQ(status().old, 2U);
  EXPECT_EQ(status().clock_jumps, 2U);
}

TEST_F(AllTrackers, FindsOutTheOffsetOfAClockOfItsOwnAndFollowsAJump) {
  add("own", 0.03);
  hal::TimeNs offset = 5 * kHour;
  const auto run = [&](int count) {
    for (int i = 0; i < count; ++i) {
      now_ns_ += 33 * kMs;
      const hal::TimeNs delay = (30 + (i * 7) % 20) * kMs;
      see(now_ns_ - delay + offset);
      latch();
      if (i < count - 3) continue;
      EXPECT_NEAR(static_cast<double>(pose_.seen()[0]->taken_ns - (now_ns_ - delay)), 0.0, 3e6);
    }
  };
  run(60);
  EXPECT_EQ(status().clock_jumps, 0U);
  offset += kHour;
  run(60);
  EXPECT_EQ(status().clock_jumps, 1U);
  EXPECT_GT(status().from_future, 0U);
  offset -= 2 * kHour;
  run(60);
  EXPECT_EQ(status().clock_jumps, 2U);
  EXPECT_GT(status().old, 0U);
}

TEST_F(AllTrackers, WithoutStampsTheLatencyIsTakenOff) {
  add("own", 0.05);
  see({});
  latch();
  EXPECT_EQ(pose_.seen()[0]->taken_ns, now_ns_ - 50 * kMs);
}

TEST_F(AllTrackers, WhatIsFarOutsideOfTheArenaIsImpossible) {
  add("monotonic");
  see(now_ns_);
  waiting_.back().p_m = {40.0, 0.0, 0.0};
  see(now_ns_ - 1);
  waiting_.back().p_m = {std::nan(""), 0.0, 0.0};
  latch();
  EXPECT_EQ(status().outside, 2U);
  EXPECT_EQ(pose_.counts().impossible, 2U);
  EXPECT_FALSE(pose_.seen()[0].has_value());
}

}  // namespace
}  // namespace tandem::mixed_reality
