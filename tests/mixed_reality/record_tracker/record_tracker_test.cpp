#include "mixed_reality/record_tracker/record_tracker.hpp"

#include <chrono>
#include <cstdio>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <thread>
#include <unistd.h>

#include "core/record/record.hpp"
#include "hal/robot/epuck.hpp"
#include "tests/core/space_by_hand.hpp"

namespace tandem::mixed_reality {
namespace {

using testing::HasSubstr;

class ARecord : public testing::Test {
 protected:
  ARecord() : path_(testing::TempDir() + "tandem_record_tracker_" + std::to_string(::getpid())) {
    core::Space space;
    const core::RobotId robot = core::add_robot(space, hal::epuck::kind(), "ep1", 0.0, 0.5, 0.25);
    core::add_robot(space, hal::epuck::kind(), "other", 1.0, 0.0, 0.0);
    core::RecordConfig config;
    config.path = path_;
    auto recorder = core::Recorder::open(config, space, {{"ticks_per_second", 100}});
    EXPECT_TRUE(recorder.ok()) << recorder.error().message;
    for (hal::Tick tick = 0; tick < 20; ++tick) {
      space.set_pose(robot, core::Pose::at(0.01 * static_cast<double>(tick), 0.5, 0.25));
      EXPECT_TRUE(recorder.value()->tick_done(space, tick).ok());
    }
    EXPECT_TRUE(recorder.value()->close(19, {{"finished", true}}).ok());
    options_->file = path_;
  }
  ~ARecord() override { std::remove(path_.c_str()); }
  bridges::TrackerRequest request() const { return {"record", "r", "", options_, {}}; }

  std::string path_;
  std::shared_ptr<RecordTrackerOptions> options_ = std::make_shared<RecordTrackerOptions>();
};

TEST_F(ARecord, IsPlayedAsFastAsItWas) {
  options_->entities = "ep*";
  options_->from_s = 0.05;
  ASSERT_TRUE(check_record_tracker(request()).ok());
  auto tracker = make_record_tracker(request(), {});
  ASSERT_TRUE(tracker.ok()) << tracker.error().message;
  const auto began = std::chrono::steady_clock::now();
  ASSERT_TRUE(tracker.value()->start().ok());
  while (tracker.value()->report().trouble.empty() &&
         std::chrono::steady_clock::now() - began < std::chrono::seconds(20))
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_GE(std::chrono::steady_clock::now() - began, std::chrono::milliseconds(150));
  EXPECT_EQ(tracker.value()->report().trouble, "the record is over");
  std::vector<bridges::Sighting> seen(100);
  seen.resize(tracker.value()->take(seen));
  ASSERT_EQ(seen.size(), 16U) << "ticks 4 to 19, of one robot";
  EXPECT_EQ(seen[0].who(), "ep1");
  EXPECT_NEAR(seen[0].p_m[0], 0.04, 1e-6);
  EXPECT_NEAR(*seen[0].heading_rad, 0.25, 1e-6);
  EXPECT_EQ(*seen[1].stamp_ns - *seen[0].stamp_ns, 10 * hal::kNsPerMs);
  EXPECT_GE(seen[15].received_ns - seen[0].received_ns, 140 * hal::kNsPerMs);
}

TEST_F(ARecord, MustBeOneAndLongEnough) {
  options_->from_s = 1.0;
  EXPECT_THAT(check_record_tracker(request()).error().message, HasSubstr("ends before 'from'"));
  options_->file = path_ + ".none";
  EXPECT_FALSE(check_record_tracker(request()).ok());
  options_->file = "";
  EXPECT_THAT(check_record_tracker(request()).error().message, HasSubstr("'file' must name a record"));
}

}  // namespace
}  // namespace tandem::mixed_reality
