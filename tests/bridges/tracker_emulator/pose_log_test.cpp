// What a tracker reads from the log of a robot while that is written.
#include "bridges/tracker_emulator/pose_log.hpp"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

namespace tandem::bridges::tracker_emulator {
namespace {

class PoseLogTest : public testing::Test {
 protected:
  PoseLogTest() {
    std::string pattern = (std::filesystem::temp_directory_path() / "pose_log_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
    path_ = folder_ / "robot.jsonl";
  }
  ~PoseLogTest() override { std::filesystem::remove_all(folder_); }
  void write(const std::string& text) { std::ofstream(path_, std::ios::app) << text; }
  static std::string pose(int t_ns, double x_m) {
    return "{\"t_ns\":" + std::to_string(t_ns) + ",\"event\":\"pose\",\"x_m\":" + std::to_string(x_m) +
           ",\"y_m\":0.0,\"heading_rad\":0.0,\"taken_t_ns\":" + std::to_string(t_ns) + "}\n";
  }

  std::filesystem::path folder_, path_;
};

TEST_F(PoseLogTest, KnowsSinceWhenTheRobotMoves) {
  PoseLog log(path_);
  log.follow();
  EXPECT_FALSE(log.first_moved_ns()) << "there is no file yet";
  write(pose(100, 0.5) + "{\"t_ns\":150,\"event\":\"wheels\",\"left\":3,\"right\":3}\n" + pose(200, 0.5));
  log.follow();
  EXPECT_FALSE(log.first_moved_ns());
  const std::string next = pose(300, 0.51);
  write(next.substr(0, 20));
  log.follow();
  EXPECT_FALSE(log.first_moved_ns()) << "half a line";
  write(next.substr(20) + pose(400, 0.52));
  log.follow();
  EXPECT_EQ(log.first_moved_ns(), 300);
  write(pose(500, 0.5));
  log.follow();
  EXPECT_EQ(log.first_moved_ns(), 300) << "also when it is back";
  EXPECT_NEAR(log.at(350)->x_m, 0.515, 1e-9);
}

}  // namespace
}  // namespace tandem::bridges::tracker_emulator
