// The tracker before frames that the emulated camera draws: two programs' worth of geometry that share nothing but the
// tags' patterns.
#include "bridges/tag_tracker/tag_tracker.hpp"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <numbers>
#include <thread>
#include <time.h>
#include <unistd.h>

#include "bridges/camera/camera_file.hpp"
#include "bridges/tag_tracker/locate.hpp"
#include "bridges/tracker_emulator/frame_sender.hpp"
#include "bridges/tracker_emulator/picture.hpp"

namespace tandem::bridges::tag_tracker {
namespace {

namespace fs = std::filesystem;
using tracker_emulator::Artist;
using tracker_emulator::PlacedTag;

/// 2 m up, 1280 x 960, with a lens that bends lines, leaning by a few degrees.
camera::Camera ceiling() {
  camera::Camera camera;
  camera.lens = {1280, 960, 900.0, 900.0, 650.0, 470.0, {-0.2, 0.05, 0.0005, -0.0004, 0.0}};
  camera.place = {hal::Quaternion(0.02, 0.999, 0.015, -0.01).normalized(), {0.0, 0.0, 2.0}};
  camera.residual_px = 0.05;
  return camera;
}

tracker_emulator::Lens lens_of(const camera::Camera& camera) {
  return {
      camera.lens.width,      camera.lens.height, {camera.lens.fx, camera.lens.fy},    {camera.lens.cx, camera.lens.cy},
      camera.lens.distortion, camera.place.p_WC,  camera.place.q_WC.toRotationMatrix()};
}

struct True {
  double x_m, y_m, heading_rad;
};

PlacedTag placed(std::size_t id, const True& at, double height_m, double size_m = 0.05) {
  PlacedTag tag{apriltag::pattern("tag36h11", id).value(), size_m, {at.x_m, at.y_m, height_m}, {}};
  const double c = std::cos(at.heading_rad), s = std::sin(at.heading_rad);
  tag.axes_W << s, c, 0.0, -c, s, 0.0, 0.0, 0.0, 1.0;
  return tag;
}

/// Of this process, so far: what others do on the machine does not count.
double processor_s() {
  timespec t{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// 20 robots on a grid, none where it was in another frame.
std::vector<True> twenty(int frame) {
  std::vector<True> all;
  for (int i = 0; i < 20; ++i) {
    const double k = i + 0.37 * frame;
    all.push_back({-0.96 + 0.48 * (i % 5) + 0.09 * std::sin(7.0 * k), -0.6 + 0.4 * (i / 5) + 0.07 * std::cos(11.0 * k),
                   std::remainder(2.4 * k, 2.0 * std::numbers::pi)});
  }
  return all;
}

TEST(TagTracker, FindsTwentyTagsOfFiveCentimetresWithinThreeMillimetres) {
  const camera::Camera camera = ceiling();
  Artist artist(lens_of(camera), {.blur_px = 0.7, .noise = 4.0}, 5);
  const auto asked = [](const char* name, double otherwise) {
    const char* const text = std::getenv(name);
    return text != nullptr ? std::atof(text) : otherwise;
  };
  const int frames = static_cast<int>(asked("TANDEM_TAG_FRAMES", 4.0));
  const double size_m = asked("TANDEM_TAG_SIZE_MM", 50.0) * 1e-3;
  auto detector = apriltag::Detector::make({.decimate = asked("TANDEM_TAG_DECIMATE", TagOptions{}.decimate),
                                            .contrast = static_cast<int>(asked("TANDEM_TAG_CONTRAST", 30.0))});
  ASSERT_TRUE(detector.ok());
  int found = 0;
  double worst_m = 0.0, squares_m2 = 0.0, worst_rad = 0.0, chi2 = 0.0, took_s = 0.0, drew_s = 0.0, least_px = 1e9;
  for (int frame = 0; frame < frames; ++frame) {
    const auto truth = twenty(frame);
    std::vector<PlacedTag> tags;
    for (std::size_t i = 0; i < truth.size(); ++i) tags.push_back(placed(i, truth[i], 0.1, size_m));
    const double before_s = processor_s();
    const auto grey = artist.draw(tags);
    const double began_s = processor_s();
    drew_s += began_s - before_s;
    const auto seen = (*detector)->detect(grey, camera.lens.width, camera.lens.height);
    took_s += processor_s() - began_s;
    for (const apriltag::Detection& tag : seen) {
      const auto where = locate(camera, tag, size_m, 0.1);
      ASSERT_TRUE(std::holds_alternative<Sighting>(where)) << tag.id;
      const auto& s = std::get<Sighting>(where);
      ASSERT_LT(tag.id, truth.size());
      const double error_m = std::hypot(s.p_m[0] - truth[tag.id].x_m, s.p_m[1] - truth[tag.id].y_m);
      worst_m = std::max(worst_m, error_m);
      squares_m2 += error_m * error_m;
      chi2 += error_m * error_m / (2.0 * *s.sd_m * *s.sd_m);
      worst_rad = std::max(
          worst_rad, std::fabs(std::remainder(*s.heading_rad - truth[tag.id].heading_rad, 2.0 * std::numbers::pi)));
      least_px = std::min(least_px, tag.side_px());
      ++found;
    }
  }
  std::printf(
      "%d of %d tags, from %.0f pixels on; %.2f mm RMS, %.2f mm at most; %.2f degrees at most; %.1f ms of a processor "
      "to find, %.1f "
      "ms of a processor to draw a frame; error by its deviation %.2f\n",
      found, 20 * frames, least_px, 1e3 * std::sqrt(squares_m2 / found), 1e3 * worst_m,
      worst_rad * 180.0 / std::numbers::pi, 1e3 * took_s / frames, 1e3 * drew_s / frames, std::sqrt(chi2 / found));
  EXPECT_EQ(found, 20 * frames);
  EXPECT_LE(worst_m, 0.003);
  EXPECT_LE(worst_rad, 0.03);
  EXPECT_LT(chi2 / found, 2.0) << "it is no surer than it may be";
}

TEST(TagTracker, SeesThatATagIsOfAnotherSizeOrHeight) {
  const camera::Camera camera = ceiling();
  Artist artist(lens_of(camera), {}, 5);
  auto detector = apriltag::Detector::make({});
  ASSERT_TRUE(detector.ok());
  const auto grey = artist.draw({placed(3, {0.4, 0.3, 1.0}, 0.0, 0.08)});
  const auto seen = (*detector)->detect(grey, 1280, 960);
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_TRUE(std::holds_alternative<Sighting>(locate(camera, seen[0], 0.08, 0.0)));
  EXPECT_EQ(std::get<NoPose>(locate(camera, seen[0], 0.05, 0.0)), NoPose::Misshapen);
  EXPECT_EQ(std::get<NoPose>(locate(camera, seen[0], 0.08, 0.9)), NoPose::Misshapen);
  EXPECT_EQ(std::get<NoPose>(locate(camera, seen[0], 0.08, 2.5)), NoPose::Outside);
}

class TagTrackerAtAPipe : public testing::Test {
 protected:
  TagTrackerAtAPipe() : folder_(fs::path(testing::TempDir()) / ("tandem_tags_" + std::to_string(::getpid()))) {
    std::signal(SIGPIPE, SIG_IGN);
    fs::create_directories(folder_);
    options_->frames = "pipe:" + (folder_ / "frames").string();
    options_->camera = (folder_ / "camera.json").string();
    camera_.lens.width = 320;
    camera_.lens.height = 240;
    camera_.lens.fx = camera_.lens.fy = 250.0;
    camera_.lens.cx = 160.0;
    camera_.lens.cy = 120.0;
    camera_.place = {hal::Quaternion(0.0, 1.0, 0.0, 0.0), {0.0, 0.0, 1.0}};
    EXPECT_TRUE(camera::write_camera_file(options_->camera, {camera_.lens, 0.1, 9, camera_.place, 0.1}).ok());
  }
  ~TagTrackerAtAPipe() override { fs::remove_all(folder_); }
  TrackerRequest request() const { return {"apriltag", "ceiling", "", options_, {{"7", 0.2}}}; }
  void start() {
    const hal::Status good = check_tag_tracker(request());
    ASSERT_TRUE(good.ok()) << good.error().message;
    auto made = make_tag_tracker(request(), {});
    ASSERT_TRUE(made.ok()) << made.error().message;
    tracker_ = std::move(made).value();
    const hal::Status started = tracker_->start();
    ASSERT_TRUE(started.ok()) << started.error().message;
    auto sender = tracker_emulator::open_frame_sender(options_->frames);
    ASSERT_TRUE(sender.ok());
    sender_ = std::move(sender).value();
  }
  /// Sends one, and waits until it was looked at.
  void send(std::int64_t stamp_ns, const std::vector<PlacedTag>& tags, bool mirrored = false, std::size_t width = 320) {
    tracker_emulator::Lens lens = lens_of(camera_);
    lens.width = width;
    Artist artist(lens, {.mirrored = mirrored}, static_cast<std::uint64_t>(stamp_ns));
    const std::uint64_t before = count("frames");
    sender_->send(tracker_emulator::frame_message(width, 240, stamp_ns, artist.draw(tags)));
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    const auto done = [&] {
      return count("frames") > before &&
             looked() + count("frames_of_wrong_size") + count("frames_out_of_order") + count("frames_skipped") ==
                 count("frames");
    };
    while (!done() && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    ASSERT_TRUE(done());
  }
  std::uint64_t looked() const { return count("frames_looked_at"); }
  std::uint64_t count(const std::string& name) const {
    for (const auto& [known, value] : tracker_->report().counts) {
      if (known == name) return value;
    }
    ADD_FAILURE() << name;
    return 0;
  }

  fs::path folder_;
  std::shared_ptr<TagOptions> options_ = std::make_shared<TagOptions>();
  camera::Camera camera_;
  std::unique_ptr<Tracker> tracker_;
  std::unique_ptr<tracker_emulator::Sender> sender_;
};

TEST_F(TagTrackerAtAPipe, TellsWhatItSeesAndCountsWhatItCannotUse) {
  start();
  const std::vector<PlacedTag> tags = {placed(7, {0.2, -0.1, 0.7}, 0.2)};
  send(1'000, tags);
  send(900, tags);  // out of order
  send(2'000, tags, true);
  send(3'000, tags, false, 300);
  send(4'000, {placed(7, {0.2, -0.1, 0.7}, 0.2), placed(7, {-0.2, 0.1, 0.7}, 0.2)});
  std::vector<Sighting> seen(10);
  seen.resize(tracker_->take(seen));
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_EQ(seen[0].who(), "7");
  EXPECT_EQ(seen[0].stamp_ns, 1'000);
  EXPECT_NEAR(seen[0].p_m[0], 0.2, 0.002);
  EXPECT_NEAR(seen[0].p_m[1], -0.1, 0.002);
  EXPECT_NEAR(*seen[0].heading_rad, 0.7, 0.02);
  EXPECT_EQ(count("frames_out_of_order"), 1U);
  EXPECT_EQ(count("frames_without_tags"), 2U) << "the mirrored one, and the one with a tag that is there twice";
  EXPECT_EQ(count("tags_doubled"), 1U);
  EXPECT_EQ(count("frames_of_wrong_size"), 1U);
  EXPECT_EQ(tracker_->report().malformed, 1U);
}

TEST_F(TagTrackerAtAPipe, SaysThatTheCameraIsOfAnotherSizeOrStalls) {
  start();
  send(1'000, {}, false, 300);
  EXPECT_NE(tracker_->report().trouble.find("frames are 300x240"), std::string::npos) << tracker_->report().trouble;
  send(2'000, {});
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (tracker_->report().trouble.find("no frame for") == std::string::npos && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_NE(tracker_->report().trouble.find("no frame for"), std::string::npos) << tracker_->report().trouble;
}

TEST_F(TagTrackerAtAPipe, SaysHowManyPixelsTagsHaveAndWhatIsWrong) {
  options_->size_m = 0.03;
  const std::string outlook = outlook_of_tags(request());
  EXPECT_NE(outlook.find("9 pixels along a side in the middle"), std::string::npos) << outlook;
  EXPECT_NE(outlook.find("many are missed"), std::string::npos) << outlook;
  TrackerRequest high = request();
  high.things.push_back({"8", 1.2});
  ASSERT_FALSE(check_tag_tracker(high).ok());
  EXPECT_NE(check_tag_tracker(high).error().message.find("'8' is 1.2 m"), std::string::npos);
  options_->decimate = 1.25;
  EXPECT_NE(check_tag_tracker(request()).error().message.find("'decimate' is"), std::string::npos);
  options_->decimate = 1.0;
  options_->camera = "";
  EXPECT_FALSE(check_tag_tracker(request()).ok());
  options_->camera = "/no/such/file";
  EXPECT_FALSE(check_tag_tracker(request()).ok());
}

}  // namespace
}  // namespace tandem::bridges::tag_tracker
