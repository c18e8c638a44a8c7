#include "core/record/trajectory.hpp"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <gtest/gtest.h>
#include <numbers>
#include <sstream>
#include <sys/resource.h>

#include "core/record/record_streams.hpp"
#include "hal/robot/epuck.hpp"
#include "tests/core/space_by_hand.hpp"

namespace tandem::core {
namespace {

class Trajectory : public testing::Test {
 protected:
  void SetUp() override {
    ep0_ = add_robot(space_, hal::epuck::kind(), "ep0", 1.0, -2.5, std::numbers::pi);
    ep1_ = add_robot(space_, hal::epuck::kind(), "ep1", 0.1234567, 1e-9, -0.5);
    add_robot(space_, hal::epuck::kind(), "scout", 0.0, 0.0, 0.0);
    path_ = testing::TempDir() + "trajectory_test_" + testing::UnitTest::GetInstance()->current_test_info()->name() +
            ".csv";
  }
  void TearDown() override { std::remove(path_.c_str()); }

  std::unique_ptr<TrajectoryRecorder> open(const std::vector<std::string>& entities, std::int64_t every = 1) {
    auto opened = TrajectoryRecorder::open({path_, entities, every}, space_, 10);
    EXPECT_TRUE(opened.ok()) << (opened.ok() ? "" : opened.error().message);
    return opened.ok() ? std::move(opened).value() : nullptr;
  }
  std::string open_error(const std::vector<std::string>& entities) {
    const auto opened = TrajectoryRecorder::open({path_, entities, 1}, space_, 10);
    return opened.ok() ? "" : opened.error().message;
  }
  std::string written() const {
    std::stringstream text;
    text << std::ifstream(path_).rdbuf();
    return text.str();
  }
  std::vector<std::string> lines() const {
    std::vector<std::string> all;
    std::istringstream text(written());
    for (std::string line; std::getline(text, line);) all.push_back(line);
    return all;
  }

  Space space_;
  RobotId ep0_, ep1_;
  std::string path_;
};

TEST_F(Trajectory, WritesAHeaderAndALineForEachRobotAndTick) {
  auto recorder = open({"ep*"});
  ASSERT_TRUE(recorder->record(space_, 0).ok());
  space_.set_pose(ep1_, {0.5, 0.25, 0.0, 1.0, 0.0});
  ASSERT_TRUE(recorder->record(space_, 3).ok());
  ASSERT_TRUE(recorder->close().ok());
  EXPECT_EQ(written(),
            "tick,time_s,id,x_m,y_m,z_m,heading_rad\n"
            "0,0.1,ep0,1.000000,-2.500000,0.000000,3.141593\n"
            "0,0.1,ep1,0.123457,0.000000,0.000000,-0.500000\n"
            "3,0.4,ep0,1.000000,-2.500000,0.000000,3.141593\n"
            "3,0.4,ep1,0.500000,0.250000,0.000000,0.000000\n");
}

TEST_F(Trajectory, RecordsEveryNthTickAlone) {
  auto recorder = open({"scout"}, 5);
  for (hal::Tick tick = 0; tick < 11; ++tick) ASSERT_TRUE(recorder->record(space_, tick).ok());
  ASSERT_TRUE(recorder->close().ok());
  ASSERT_EQ(lines().size(), 4U);
  EXPECT_EQ(lines()[3].substr(0, 7), "10,1.1,");
}

TEST_F(Trajectory, RecordsEveryRobotOnceWhenNoneOrOverlappingPatternsAreGiven) {
  auto all = open({});
  ASSERT_TRUE(all->record(space_, 0).ok());
  ASSERT_TRUE(all->close().ok());
  EXPECT_EQ(lines().size(), 4U);
  auto twice = open({"ep0", "*p0", "ep*"});
  ASSERT_TRUE(twice->record(space_, 0).ok());
  ASSERT_TRUE(twice->close().ok());
  EXPECT_EQ(lines().size(), 3U);
}

TEST_F(Trajectory, ARemovedRobotHasNoLineAnyMore) {
  auto recorder = open({"ep*"});
  ASSERT_TRUE(recorder->record(space_, 0).ok());
  space_.remove_robot(ep0_);
  ASSERT_TRUE(recorder->record(space_, 1).ok());
  ASSERT_TRUE(recorder->close().ok());
  ASSERT_EQ(lines().size(), 4U);
  EXPECT_EQ(lines()[3].substr(0, 9), "1,0.2,ep1");
}

TEST_F(Trajectory, ARobotThatComesHasLinesFromThenOn) {
  EXPECT_NE(open_error({"ep0", "new*"}), "");  // fits nobody, and may be misspelt
  auto recorder = open({"ep*"});
  ASSERT_TRUE(recorder->record(space_, 0).ok());
  for (const char* id : {"epa", "scouter"}) {
    add_robot(space_, hal::epuck::kind(), id, 2.0, 0.5, 0.0);
    space_.stores().robots.back().generation = ++space_.stores().generations;
  }
  ASSERT_TRUE(recorder->record(space_, 1).ok());
  space_.remove_robot(space_.find_robot("ep0"));
  ASSERT_TRUE(recorder->record(space_, 2).ok());
  ASSERT_TRUE(recorder->close().ok());
  std::string ids;
  for (std::size_t i = 1; i < lines().size(); ++i) ids += lines()[i].substr(0, lines()[i].find(",", 6)) + " ";
  EXPECT_EQ(ids, "0,0.1,ep0 0,0.1,ep1 1,0.2,ep0 1,0.2,ep1 1,0.2,epa 2,0.3,ep1 2,0.3,epa ");
}

TEST_F(Trajectory, OfASpaceThatIsEmptyAtFirstHasThoseWhoCome) {
  for (const char* id : {"ep0", "ep1", "scout"}) space_.remove_robot(space_.find_robot(id));
  auto recorder = open({"late*"});
  ASSERT_NE(recorder, nullptr);
  ASSERT_TRUE(recorder->record(space_, 0).ok());
  add_robot(space_, hal::epuck::kind(), "late1", 2.0, 0.5, 0.0);
  space_.stores().robots.back().generation = ++space_.stores().generations;
  ASSERT_TRUE(recorder->record(space_, 1).ok());
  ASSERT_TRUE(recorder->close().ok());
  EXPECT_EQ(written(), "tick,time_s,id,x_m,y_m,z_m,heading_rad\n1,0.2,late1,2.000000,0.500000,0.000000,0.000000\n");
}

TEST_F(Trajectory, IsThereInFullWhenTheRecorderIsDestroyedUnclosed) {
  {
    auto recorder = open({"scout"});
    ASSERT_TRUE(recorder->record(space_, 0).ok());
  }
  EXPECT_EQ(lines().size(), 2U);
}

TEST_F(Trajectory, FlushHandsOverWhatThereIs) {
  auto recorder = open({"scout"});
  ASSERT_TRUE(recorder->record(space_, 0).ok());
  path_ += ".part";
  EXPECT_EQ(lines().size(), 0U);
  EXPECT_GT(recorder->unwritten().size.load(), 0U);
  ASSERT_TRUE(recorder->flush().ok());
  EXPECT_EQ(lines().size(), 2U);
  EXPECT_EQ(recorder->unwritten().size.load(), 0U);
}

TEST_F(Trajectory, WhatIsUnwrittenAreWholeLines) {
  auto recorder = open({"*"});
  ASSERT_TRUE(recorder->record(space_, 0).ok());
  ASSERT_TRUE(recorder->record(space_, 1).ok());
  const UnwrittenRecords& unwritten = recorder->unwritten();
  const std::string text(unwritten.data.load(), unwritten.size.load());
  ASSERT_TRUE(recorder->close().ok());
  EXPECT_EQ(written(), text);
}

TEST_F(Trajectory, TheOldFileStaysUntilTheRunIsOver) {
  { std::ofstream(path_) << "old"; }
  {
    auto recorder = open({"scout"});
    EXPECT_EQ(written(), "old");
  }
  EXPECT_EQ(written(), "old") << "nothing was recorded";
  auto recorder = open({"scout"});
  ASSERT_TRUE(recorder->record(space_, 0).ok());
  EXPECT_EQ(written(), "old");
  ASSERT_TRUE(recorder->close().ok());
  EXPECT_EQ(lines().size(), 2U);
}

TEST_F(Trajectory, ARunWithoutATickHasTheHeaderAlone) {
  auto recorder = open({"scout"});
  ASSERT_TRUE(recorder->close().ok());
  EXPECT_EQ(written(), "tick,time_s,id,x_m,y_m,z_m,heading_rad\n");
}

TEST_F(Trajectory, QuotesIdsThatWouldBreakTheTable) {
  add_robot(space_, hal::epuck::kind(), "a,\"b\"", 0.0, 0.0, 0.0);
  auto recorder = open({"a*"});
  ASSERT_TRUE(recorder->record(space_, 0).ok());
  ASSERT_TRUE(recorder->close().ok());
  EXPECT_NE(written().find("0,0.1,\"a,\"\"b\"\"\",0.000000"), std::string::npos) << written();
}

TEST_F(Trajectory, NamesWhatIsSpelledAlikeWhenNoRobotFits) {
  const std::string message = open_error({"skout"});
  EXPECT_NE(message.find("no robot fits 'skout'"), std::string::npos) << message;
  EXPECT_NE(message.find("did you mean 'scout'?"), std::string::npos) << message;
  EXPECT_NE(message.find("ep0, ep1, scout"), std::string::npos) << message;
}

TEST_F(Trajectory, SaysWhenTheFileCannotBeMade) {
  path_ = "/no/such/folder/t.csv";
  const std::string message = open_error({});
  EXPECT_NE(message.find("/no/such/folder/t.csv"), std::string::npos) << message;
  EXPECT_NE(message.find("No such file"), std::string::npos) << message;
}

TEST_F(Trajectory, AFullDiskIsToldAndEndsTheRecording) {
  path_ = "/dev/full";
  auto recorder = open({});
  ASSERT_TRUE(recorder->record(space_, 0).ok());
  const hal::Status flushed = recorder->flush();
  ASSERT_FALSE(flushed.ok());
  EXPECT_NE(flushed.error().message.find("No space left"), std::string::npos) << flushed.error().message;
  EXPECT_NE(flushed.error().message.find("lost from tick 0 on"), std::string::npos) << flushed.error().message;
  EXPECT_FALSE(recorder->record(space_, 1).ok());
  EXPECT_FALSE(recorder->close().ok());
  path_.clear();
}

TEST_F(Trajectory, ADiskThatFillsUpLosesTheTicksThatAreNotInItsPart) {
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  auto recorder = open({});
  for (hal::Tick tick = 0; tick < 40; ++tick) ASSERT_TRUE(recorder->record(space_, tick).ok());
  const rlimit small{3000, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const hal::Status flushed = recorder->flush();
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  ASSERT_FALSE(flushed.ok());
  std::ifstream part(path_ + ".part");
  std::string line, last;
  int lines_of_last = 0;
  for (std::getline(part, line); std::getline(part, line);) {
    const std::string tick = line.substr(0, line.find(','));
    lines_of_last = tick == last ? lines_of_last + 1 : 1;
    last = tick;
  }
  ASSERT_FALSE(last.empty());
  constexpr int kRobots = 3;
  const int lost = std::stoi(last) + (lines_of_last == kRobots ? 1 : 0);
  EXPECT_GT(lost, 0);
  EXPECT_NE(flushed.error().message.find("lost from tick " + std::to_string(lost) + " on"), std::string::npos)
      << flushed.error().message;
  (void)recorder->close();
}

TEST(FitsPattern, AStarStandsForAnyNumberOfCharacters) {
  EXPECT_TRUE(fits_pattern("ep12", "ep12"));
  EXPECT_TRUE(fits_pattern("ep12", "*"));
  EXPECT_TRUE(fits_pattern("ep12", "ep12*"));
  EXPECT_TRUE(fits_pattern("ep12", "e*1*"));
  EXPECT_TRUE(fits_pattern("abcabd", "*ab*d"));
  EXPECT_TRUE(fits_pattern("", "**"));
  EXPECT_FALSE(fits_pattern("ep12", "ep1"));
  EXPECT_FALSE(fits_pattern("ep12", "p*"));
  EXPECT_FALSE(fits_pattern("ep12", ""));
  EXPECT_FALSE(fits_pattern("abcabc", "*ab*d"));
}

}  // namespace
}  // namespace tandem::core
