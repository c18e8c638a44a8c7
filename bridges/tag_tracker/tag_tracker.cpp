#include "bridges/tag_tracker/tag_tracker.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <condition_variable>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

#include "bridges/camera/camera_file.hpp"
#include "bridges/frames/frame_source.hpp"
#include "bridges/sighting_box.hpp"
#include "bridges/tag_tracker/locate.hpp"
#include "hal/element.hpp"
#include "hal/monotonic.hpp"
#include "hal/rounded.hpp"
#include "hal/unit.hpp"

namespace tandem::bridges::tag_tracker {
namespace {

using frames::Frame;
using frames::FrameSource;

constexpr int kWait_ms = 50;                                  // until a thread looks whether it is to end
constexpr hal::TimeNs kStalled_ns = hal::kNsPerSecond;        // without a frame
constexpr hal::TimeNs kSmallStepBack_ns = hal::kNsPerSecond;  // of stamps; more, and the clock was set
constexpr std::uint64_t kBareFrames = 30;                     // in a row without any tag
constexpr double kEnough_px = 16.0, kFew_px = 13.0;           // along a tag's side, where frames are not made smaller

using hal::monotonic_ns;

class TagTracker final : public Tracker {
 public:
  TagTracker(TagOptions options, camera::Camera camera, std::unique_ptr<apriltag::Detector> detector,
             const std::vector<TrackedThing>& things)
      : options_(std::move(options)), camera_(camera), detector_(std::move(detector)) {
    for (const TrackedThing& thing : things) heights_m_[thing.name] = thing.height_m;
  }
  ~TagTracker() override {
    stop_ = true;
    changed_.notify_all();
    if (reader_.joinable()) reader_.join();
    if (looker_.joinable()) looker_.join();
  }

  hal::Status start() override {
    if (reader_.joinable()) return {};
    auto source =
        frames::open_frames(options_.frames, {true, options_.rate_hz, camera_.lens.width, camera_.lens.height});
    if (!source.ok()) return source.error();
    source_ = std::move(source).value();
    newest_ns_ = monotonic_ns();
    reader_ = std::thread([this] { read(); });
    looker_ = std::thread([this] { look(); });
    return {};
  }
  std::size_t take(std::span<Sighting> into) noexcept override { return box_.take(into); }
  TrackerReport report() const override;

 private:
  void read();
  void look();
  void look_at(const Frame& frame);
  bool in_order(const Frame& frame);
  std::string trouble() const;

  const TagOptions options_;
  const camera::Camera camera_;
  const std::unique_ptr<apriltag::Detector> detector_;  // of the thread that looks
  std::map<std::string, double, std::less<>> heights_m_;
  std::unique_ptr<FrameSource> source_;  // of the thread that reads
  SightingBox box_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Frame newest_;
  bool fresh_ = false;
  hal::TimeNs newest_ns_ = 0;  // when one came; at first when it began
  struct Counts {
    std::uint64_t frames = 0, skipped = 0, out_of_order = 0, wrong_size = 0, bare = 0, bare_in_a_row = 0;
    std::uint64_t misshapen = 0, doubled = 0, broken = 0, looked = 0, looked_us = 0, tags = 0;
    double smallest_px = 0.0;
    std::size_t other_width = 0, other_height = 0;
    bool over = false;
    std::string source_trouble;
  } counts_;

  std::optional<std::int64_t> last_stamp_ns_;  // of the thread that reads
  std::atomic<bool> stop_{false};
  std::thread reader_, looker_;
};

void TagTracker::read() {
  Frame frame;
  while (!stop_) {
    const FrameSource::Got got = source_->next(frame, kWait_ms);
    const std::lock_guard lock(mutex_);
    counts_.broken = source_->malformed();
    counts_.source_trouble = source_->trouble();
    counts_.over = got == FrameSource::Got::Over;
    if (counts_.over) return;
    if (got == FrameSource::Got::Nothing) continue;
    newest_ns_ = frame.received_ns;
    ++counts_.frames;
    if (frame.width != camera_.lens.width || frame.height != camera_.lens.height) {
      ++counts_.wrong_size;
      counts_.other_width = frame.width;
      counts_.other_height = frame.height;
      continue;
    }
    if (!in_order(frame)) {
      ++counts_.out_of_order;
      continue;
    }
    if (fresh_) ++counts_.skipped;
    std::swap(newest_, frame);
    fresh_ = true;
    changed_.notify_all();
  }
}

bool TagTracker::in_order(const Frame& frame) {
  if (!frame.stamp_ns) return true;
  const bool back =
      last_stamp_ns_ && *frame.stamp_ns <= *last_stamp_ns_ && *last_stamp_ns_ - *frame.stamp_ns < kSmallStepBack_ns;
  if (!back) last_stamp_ns_ = frame.stamp_ns;
  return !back;
}

void TagTracker::look() {
  Frame frame;
  while (!stop_) {
    {
      std::unique_lock lock(mutex_);
      changed_.wait_for(lock, std::chrono::milliseconds(kWait_ms), [this] { return fresh_ || stop_.load(); });
      if (!fresh_) continue;
      std::swap(newest_, frame);
      fresh_ = false;
    }
    look_at(frame);
  }
}

void TagTracker::look_at(const Frame& frame) {
  const hal::TimeNs began_ns = monotonic_ns();
  const auto tags = detector_->detect(frame.grey, frame.width, frame.height);
  std::vector<Sighting> seen;
  std::uint64_t misshapen = 0;
  double smallest_px = 0.0;
  for (const apriltag::Detection& tag : tags) {
    const auto height = heights_m_.find(std::to_string(tag.id));
    const auto found =
        locate(camera_, tag, options_.size_m, height != heights_m_.end() ? height->second : options_.height_m);
    smallest_px = smallest_px == 0.0 ? tag.side_px() : std::min(smallest_px, tag.side_px());
    const auto* const sighting = std::get_if<Sighting>(&found);
    if (sighting == nullptr) {
      ++misshapen;
      continue;
    }
    seen.push_back(*sighting);
    seen.back().stamp_ns = frame.stamp_ns;
    seen.back().received_ns = frame.received_ns;
  }
  box_.put(seen, false);
  const std::lock_guard lock(mutex_);
  ++counts_.looked;
  counts_.looked_us += static_cast<std::uint64_t>((monotonic_ns() - began_ns) / 1000);
  counts_.tags += tags.size();
  counts_.misshapen += misshapen;
  counts_.doubled = detector_->doubled();
  counts_.bare += tags.empty() ? 1 : 0;
  counts_.bare_in_a_row = tags.empty() ? counts_.bare_in_a_row + 1 : 0;
  if (smallest_px > 0.0)
    counts_.smallest_px = counts_.smallest_px == 0.0 ? smallest_px : std::min(counts_.smallest_px, smallest_px);
}

TrackerReport TagTracker::report() const {
  TrackerReport report = box_.report();
  const std::lock_guard lock(mutex_);
  report.messages = counts_.frames + counts_.broken;
  report.malformed = counts_.broken + counts_.wrong_size;
  report.trouble = trouble();
  report.counts = {{"frames", counts_.frames},
                   {"frames_looked_at", counts_.looked},
                   {"frames_skipped", counts_.skipped},
                   {"frames_out_of_order", counts_.out_of_order},
                   {"frames_of_wrong_size", counts_.wrong_size},
                   {"frames_without_tags", counts_.bare},
                   {"tags", counts_.tags},
                   {"tags_misshapen", counts_.misshapen},
                   {"tags_doubled", counts_.doubled},
                   {"smallest_tag_px", static_cast<std::uint64_t>(counts_.smallest_px)},
                   {"mean_us_a_frame", counts_.looked > 0 ? counts_.looked_us / counts_.looked : 0}};
  return report;
}

/// With the mutex held.
std::string TagTracker::trouble() const {
  const auto size = [](std::size_t width, std::size_t height) {
    return std::to_string(width) + "x" + std::to_string(height);
  };
  if (counts_.frames > 0 && counts_.wrong_size == counts_.frames)
    return "frames are " + size(counts_.other_width, counts_.other_height) + ", and the camera's file is of " +
           size(camera_.lens.width, camera_.lens.height) + ": set the camera to that size, or calibrate it at this one";
  if (counts_.over) return counts_.source_trouble.empty() ? "there are no more frames" : counts_.source_trouble;
  const hal::TimeNs age_ns = monotonic_ns() - newest_ns_;
  if (age_ns > kStalled_ns)
    return "no frame for " + std::to_string(age_ns / hal::kNsPerSecond) + " s" +
           (counts_.source_trouble.empty() ? "" : ": " + counts_.source_trouble);
  if (counts_.bare_in_a_row >= kBareFrames)
    return "no tag in the last " + std::to_string(counts_.bare_in_a_row) +
           " frames: is the picture mirrored, dark or out of focus, or are the tags of another family, or too small?";
  if (counts_.tags > kBareFrames && 2 * counts_.misshapen > counts_.tags)
    return "most tags are not of the size or at the height that they should be";
  return {};
}

hal::Result<camera::Camera> camera_of(const TrackerRequest& request) {
  const auto options = options_of<TagOptions>(request);
  if (options.camera.empty()) return hal::Error{"'camera' must name the camera's file, as `tandem calibrate` makes it"};
  return camera::read_camera(hal::path_beside(options.camera, request.file));
}

hal::Result<std::unique_ptr<apriltag::Detector>> detector_of(const TagOptions& options) {
  return apriltag::Detector::make(
      {options.family, options.decimate, static_cast<int>(options.threads), static_cast<int>(options.contrast)});
}

/// Where frames come from, with a path beside the experiment.
std::string frames_of(const TagOptions& options, const std::string& file) {
  const std::size_t colon = options.frames.find(':');
  if (colon == std::string::npos) return options.frames;
  return options.frames.substr(0, colon + 1) + hal::path_beside(options.frames.substr(colon + 1), file);
}

}  // namespace

MadeTracker make_tag_tracker(const TrackerRequest& request, const hal::Log& log) {
  const auto camera = camera_of(request);
  if (!camera.ok()) return camera.error();
  auto options = options_of<TagOptions>(request);
  options.frames = frames_of(options, request.file);
  auto detector = detector_of(options);
  if (!detector.ok()) return detector.error();
  if (const std::string outlook = outlook_of_tags(request); !outlook.empty())
    log.info("tracker '" + request.id + "': " + outlook);
  return std::unique_ptr<Tracker>(
      std::make_unique<TagTracker>(options, camera.value(), std::move(detector).value(), request.things));
}

hal::Status check_tag_tracker(const TrackerRequest& request) {
  const auto options = options_of<TagOptions>(request);
  if (const hal::Status good = frames::check_frames(frames_of(options, request.file)); !good.ok()) return good;
  const auto camera = camera_of(request);
  if (!camera.ok()) return camera.error();
  if (const auto made = detector_of(options); !made.ok()) return made.error();
  for (const TrackedThing& thing : request.things) {
    if (thing.height_m >= camera.value().place.p_WC.z())
      return hal::Error{"the tag '" + thing.name + "' is " + hal::rounded(thing.height_m) +
                        " m above the floor, and the camera only " + hal::rounded(camera.value().place.p_WC.z())};
  }
  return {};
}

std::string outlook_of_tags(const TrackerRequest& request) {
  const auto camera = camera_of(request);
  if (!camera.ok()) return {};
  const auto options = options_of<TagOptions>(request);
  double height_m = options.height_m;
  for (std::size_t i = 0; i < request.things.size(); ++i)
    height_m = i == 0 ? request.things[i].height_m : std::min(height_m, request.things[i].height_m);
  const auto width = static_cast<double>(camera.value().lens.width),
             height = static_cast<double>(camera.value().lens.height);
  const auto side_px = [&](double x, double y) {
    const auto pixel_m = camera::metres_a_pixel(camera.value(), {x, y}, height_m);
    return pixel_m ? options.size_m / *pixel_m : 0.0;
  };
  double least_px = side_px(0.5 * width, 0.5 * height);
  const double middle_px = least_px;
  for (const double x : {0.02, 0.98}) {
    for (const double y : {0.02, 0.98}) least_px = std::min(least_px, side_px(x * width, y * height));
  }
  const auto text = [](double px) { return std::to_string(std::lround(px)); };
  std::string all = "tags have " + text(middle_px) + " pixels along a side in the middle of the picture, " +
                    text(least_px) + " in its farthest corner";
  if (least_px < kFew_px * options.decimate)
    all += "; below " + text(kFew_px * options.decimate) +
           ", many are missed: larger tags, a nearer camera or one of more pixels help";
  else if (least_px < kEnough_px * options.decimate)
    all += "; " + text(kEnough_px * options.decimate) + " are enough in any light";
  return all;
}

}  // namespace tandem::bridges::tag_tracker
