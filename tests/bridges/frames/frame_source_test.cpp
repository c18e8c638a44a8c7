#include "bridges/frames/frame_source.hpp"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

namespace tandem::bridges::frames {
namespace {

namespace fs = std::filesystem;

class Sources : public testing::Test {
 protected:
  Sources() : folder_(fs::path(testing::TempDir()) / ("tandem_frames_" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
  }
  ~Sources() override { fs::remove_all(folder_); }
  std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return (folder_ / name).string();
  }
  fs::path folder_;
};

TEST_F(Sources, AFolderGivesItsPicturesInTheOrderOfTheirNamesAndCountsDamagedOnes) {
  write("2.pgm", "P5 2 1 255 cd");
  write("1.pgm", "P5 2 1 255 ab");
  write("3.png", "\x89PNG and no more");
  auto source = open_frames("folder:" + folder_.string(), {.live = false});
  ASSERT_TRUE(source.ok()) << source.error().message;
  Frame frame;
  ASSERT_EQ((*source)->next(frame, 0), FrameSource::Got::Frame);
  EXPECT_EQ(frame.grey, (std::vector<std::uint8_t>{'a', 'b'}));
  ASSERT_EQ((*source)->next(frame, 0), FrameSource::Got::Frame);
  EXPECT_EQ((*source)->next(frame, 0), FrameSource::Got::Nothing);
  EXPECT_EQ((*source)->malformed(), 1U);
  EXPECT_NE((*source)->trouble().find("3.png"), std::string::npos);
  EXPECT_EQ((*source)->next(frame, 0), FrameSource::Got::Over);
}

TEST_F(Sources, APipeOutlivesItsWriters) {
  const std::string path = (folder_ / "p").string();
  auto source = open_frames("pipe:" + path, {});
  ASSERT_TRUE(source.ok()) << source.error().message;
  Frame frame;
  EXPECT_EQ((*source)->next(frame, 1), FrameSource::Got::Nothing);
  for (const std::string pixels : {"ab", "cd"}) {
    std::ofstream(path, std::ios::binary) << "P5 2 1 255 " << pixels << "P5 2 1 255 x";  // the second is cut short
    FrameSource::Got got = FrameSource::Got::Nothing;
    for (int i = 0; i < 1000 && got == FrameSource::Got::Nothing; ++i) got = (*source)->next(frame, 10);
    ASSERT_EQ(got, FrameSource::Got::Frame);
    EXPECT_EQ(std::string(frame.grey.begin(), frame.grey.end()), pixels);
    EXPECT_GT(frame.received_ns, 0);
    EXPECT_EQ((*source)->next(frame, 10), FrameSource::Got::Nothing) << "its writer has gone";
  }
}

TEST_F(Sources, SayWhatIsWrongWithThem) {
  for (const auto& [what, words] : {std::pair<std::string, std::string>{"webcam", "camera:/dev/video0"},
                                    {"folder:" + folder_.string(), "has no pictures"},
                                    {"film:" + (folder_ / "none.mp4").string(), "film"},
                                    {"pipe:" + folder_.string(), "is a folder"}}) {
    const hal::Status status = check_frames(what);
    ASSERT_FALSE(status.ok()) << what;
    EXPECT_NE(status.error().message.find(words), std::string::npos) << status.error().message;
  }
}

}  // namespace
}  // namespace tandem::bridges::frames
