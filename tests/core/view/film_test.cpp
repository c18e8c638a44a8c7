#include "core/view/film.hpp"

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>

#include "core/view/povray.hpp"

namespace tandem::core {
namespace {

namespace fs = std::filesystem;

/// A folder, and programs in it that are found before those of the system.
class Films : public testing::Test {
 protected:
  Films() {
    std::signal(SIGPIPE, SIG_IGN);
    std::string pattern = testing::TempDir() + "film_XXXXXX";
    folder_ = mkdtemp(pattern.data());
    setenv("PATH", (folder_ / "bin").string().append(":").append(path_).c_str(), 1);
    fs::create_directory(folder_ / "bin");
  }
  ~Films() override {
    setenv("PATH", path_.c_str(), 1);
    fs::remove_all(folder_);
  }
  void ffmpeg_is(const std::string& script) const {
    const fs::path file = folder_ / "bin" / "ffmpeg";
    std::ofstream(file) << "#!/bin/sh\n" << script;
    fs::permissions(file, fs::perms::owner_all);
  }
  std::string text_of(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(folder_ / name, std::ios::binary).rdbuf();
    return text.str();
  }
  std::unique_ptr<Film> open(const std::string& name) const {
    auto film = Film::open({(folder_ / name).string(), 25.0, {.size_px = 100}});
    EXPECT_TRUE(film.ok()) << (film.ok() ? "" : film.error().message);
    return film.ok() ? std::move(film).value() : nullptr;
  }

  fs::path folder_;
  std::string path_ = std::getenv("PATH");
};

Drawing of_robots(int number) {
  Drawing d;
  d.kinds.push_back({"e-puck", 0.035, {}});
  for (int i = 0; i < number; ++i) d.robots.push_back({0.1 * i, 0.0, 0.0, 0, 0, 0, false});
  return d;
}

// What the encoder is fed, and how it is called, is written where the film would be.
constexpr const char* kKeeps =
    "for last in \"$@\"; do :; done\necho \"$@\" > \"$(dirname \"$0\")/called\"\ncat > \"${last#file:}\"\n";

TEST_F(Films, FeedFramesOfOneSizeToTheEncoderAndPutTheFilmInItsPlace) {
  ffmpeg_is(kKeeps);
  const auto film = open("a.mp4");
  ASSERT_NE(film, nullptr);
  for (int robots = 0; robots < 5; ++robots) ASSERT_TRUE(film->add(of_robots(robots)).ok());
  EXPECT_FALSE(fs::exists(folder_ / "a.mp4"));
  const hal::Status closed = film->close();
  ASSERT_TRUE(closed.ok()) << closed.error().message;
  EXPECT_EQ(film->frames(), 5);
  EXPECT_FALSE(fs::exists(folder_ / "a.mp4.part"));
  const std::string called = text_of("bin/called");
  const std::size_t size = called.find("-s ");
  ASSERT_NE(size, std::string::npos) << called;
  int width = 0, height = 0;
  ASSERT_EQ(std::sscanf(called.c_str() + size, "-s %dx%d", &width, &height), 2) << called;
  EXPECT_EQ(text_of("a.mp4").size(), std::size_t{5} * static_cast<std::size_t>(width * height) * 3 / 2);
  EXPECT_NE(called.find("-r 25 "), std::string::npos) << called;
}

TEST_F(Films, ThatPagesShowAsPicturesAreWebP) {
  ffmpeg_is(kKeeps);
  const auto film = open("a.webp");
  ASSERT_NE(film, nullptr);
  ASSERT_TRUE(film->add(of_robots(1)).ok());
  ASSERT_TRUE(film->close().ok());
  EXPECT_NE(text_of("bin/called").find("-lossless 1 -loop 0 -f webp file:"), std::string::npos)
      << text_of("bin/called");
}

/// Pixels of `wide` x `high`, all of one colour.
std::string pixels_of(std::uint32_t wide, std::uint32_t high, const char (&bgr)[4]) {
  std::string pixels(8, '\0');
  std::memcpy(pixels.data(), &wide, 4);
  std::memcpy(pixels.data() + 4, &high, 4);
  for (std::uint32_t i = 0; i < wide * high; ++i) pixels.append(bgr, 3).append(1, '\0');
  return pixels;
}

TEST(VideoFrame, HasTheColorsOfItsPixelsAndEvenSides) {
  VideoFrame frame;
  const std::string white = pixels_of(3, 5, "\xff\xff\xff");
  ASSERT_TRUE(frame.show(white, {}));
  EXPECT_EQ((std::pair{frame.width(), frame.height()}), (std::pair{4U, 6U}));
  EXPECT_EQ(frame.planes(), std::string(24, '\xeb') + std::string(12, '\x80'));
  // BT.601: pure red is 81, 90, 240; the squares that stay are not touched.
  std::string red_corner = white;
  for (const std::size_t pixel : {0U, 1U, 3U, 4U}) red_corner.replace(8 + 4 * pixel, 3, std::string("\0\0\xff", 3));
  ASSERT_TRUE(frame.show(red_corner, white));
  std::string expected = std::string(24, '\xeb') + std::string(12, '\x80');
  for (const std::size_t pixel : {0U, 1U, 4U, 5U}) expected[pixel] = 81;
  expected[24] = 90;
  expected[30] = static_cast<char>(240);
  EXPECT_EQ(frame.planes(), expected);
  EXPECT_FALSE(frame.show(pixels_of(5, 3, "\xff\xff\xff"), red_corner));
}

TEST_F(Films, WhoseEncoderDiesSayWithWhichWordsAndLeaveNothing) {
  ffmpeg_is("head -c 100000 > /dev/null\necho 'hello' >&2\necho 'No space left on device' >&2\nexit 1\n");
  const auto film = open("a.mp4");
  ASSERT_NE(film, nullptr);
  hal::Status status;
  for (int i = 0; i < 1000 && status.ok(); ++i) status = film->add(of_robots(3));
  ASSERT_FALSE(status.ok());
  EXPECT_NE(status.error().message.find("a.mp4', frame "), std::string::npos) << status.error().message;
  EXPECT_NE(status.error().message.find("ffmpeg gave up: No space left on device"), std::string::npos)
      << status.error().message;
}

TEST_F(Films, WhoseEncoderFailsAtTheEndAreNotPutInTheirPlace) {
  ffmpeg_is("cat > /dev/null\necho 'no moov' >&2\nexit 3\n");
  {
    const auto film = open("a.mkv");
    ASSERT_TRUE(film->add(of_robots(3)).ok());
    const hal::Status closed = film->close();
    ASSERT_FALSE(closed.ok());
    EXPECT_NE(closed.error().message.find("ffmpeg gave up: no moov"), std::string::npos) << closed.error().message;
  }
  EXPECT_FALSE(fs::exists(folder_ / "a.mkv"));
  EXPECT_FALSE(fs::exists(folder_ / "a.mkv.part"));
}

TEST_F(Films, WhoseEncoderIsKilledSayBySignal) {
  ffmpeg_is("kill -KILL $$\n");
  const auto film = open("a.mp4");
  hal::Status status;
  for (int i = 0; i < 1000 && status.ok(); ++i) status = film->add(of_robots(3));
  ASSERT_FALSE(status.ok());
  EXPECT_NE(status.error().message.find("Killed"), std::string::npos) << status.error().message;
}

TEST_F(Films, AreNumberedPicturesToo) {
  const auto film = open("frames/");
  ASSERT_NE(film, nullptr);
  for (int robots = 0; robots < 3; ++robots) ASSERT_TRUE(film->add(of_robots(robots)).ok());
  EXPECT_EQ(film->remark(), "");
  ASSERT_TRUE(film->close().ok());
  EXPECT_EQ(text_of("frames/000002.png").substr(1, 3), "PNG");
  EXPECT_EQ(text_of("frames/000000.png").substr(16, 8), text_of("frames/000002.png").substr(16, 8)) << "sizes";
  EXPECT_FALSE(fs::exists(folder_ / "frames/000003.png"));
  const auto shorter = open("frames/%06d.png");
  ASSERT_TRUE(shorter->add(of_robots(1)).ok());
  EXPECT_NE(shorter->remark().find("000001.png' is of an older film"), std::string::npos) << shorter->remark();
}

TEST_F(Films, RefuseNamesThatTheyCannotMake) {
  ffmpeg_is(kKeeps);
  for (const char* name : {"a.avi", "a", "a.png", "a%s.png", "a%06d%06d.png", "a%d.png", "%6d.png"}) {
    const hal::Status can = Film::can_make(name);
    ASSERT_FALSE(can.ok()) << name;
    EXPECT_NE(can.error().message.find(".mp4"), std::string::npos) << can.error().message;
  }
  setenv("PATH", "/nowhere", 1);
  const hal::Status can = Film::can_make("a.mp4");
  ASSERT_FALSE(can.ok());
  EXPECT_NE(can.error().message.find("sudo apt-get install ffmpeg"), std::string::npos) << can.error().message;
  EXPECT_TRUE(Film::can_make("frames/").ok());
}

TEST_F(Films, AndScenesSayWhatTheirProgramsSaid) {
  const fs::path povray = folder_ / "bin" / "povray";
  std::ofstream(povray) << "#!/bin/sh\necho 'Parse Error: no camera' >&2\nexit 2\n";
  fs::permissions(povray, fs::perms::owner_all);
  const hal::Status rendered = render_povray("a.pov", "a.png", 100);
  ASSERT_FALSE(rendered.ok());
  EXPECT_NE(rendered.error().message.find("'a.pov': povray gave up: Parse Error: no camera"), std::string::npos)
      << rendered.error().message;
  setenv("PATH", "/nowhere", 1);
  const hal::Status can = can_render_povray();
  ASSERT_FALSE(can.ok());
  EXPECT_NE(can.error().message.find("sudo apt-get install povray"), std::string::npos) << can.error().message;
}

TEST(Povray, PutsBodiesThingsAndLampsInTheirPlacesWithHeightUpwards) {
  Drawing d = of_robots(0);
  d.title = "two\nlines";
  d.kinds[0].height_m = 0.05;
  d.kinds[0].look.lamps = {{{0.035, 0.0, 0.04}}};
  d.robots = {{0.25, -0.5, 1.5707963, 0, 0, 1, false}};
  d.robots[0].z_m = 0.75;
  d.lit = {{0, hal::kRed}};
  d.objects = {
      {.id = "box", .x_m = 0.5, .y_m = 0.25, .half_x_m = 0.2, .half_y_m = 0.1, .z_low_m = 0.1, .z_high_m = 0.4},
      {.kind = Object::Kind::Cylinder,
       .movable = true,
       .id = "post",
       .x_m = -0.5,
       .y_m = 0.25,
       .radius_m = 0.05,
       .z_high_m = 0.2}};
  d.lights = {{"lamp", 0.0, 0.9, 0.5}};
  const std::string scene = to_povray(d);
  for (const char* part :
       {"// two lines\n", "rotate -y*90 translate <0.25, 0.75, -0.5>", "box { <-0.2, 0, -0.1>, <0.2, 0.3, 0.1>",
        "translate <0.5, 0.1, 0.25>", "cylinder { <0, 0, 0>, <0, 0.2, 0>, 0.05", "translate <-0.5, 0, 0.25>",
        "light_source { <0, 0.5, 0.9>, srgb <1, 1, 0>", "translate <0.035, 0.04, 0>"})
    EXPECT_NE(scene.find(part), std::string::npos) << part << " in " << scene;
  EXPECT_EQ(std::count(scene.begin(), scene.end(), '{'), std::count(scene.begin(), scene.end(), '}'));
  const std::string part = to_povray(d, {.region = PictureLook::Area{0.0, 0.0, 1.0, 1.0}});
  EXPECT_EQ(part.find("rotate -y*90"), std::string::npos) << "the robot lies outside";
}

}  // namespace
}  // namespace tandem::core
