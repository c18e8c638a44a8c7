// Tracker `apriltag`: finds robots by the tags on them, in frames of a camera, a film, a folder or a pipe.
#pragma once
#include "bridges/apriltag/family.hpp"
#include "bridges/tracker_type.hpp"
#include "hal/params.hpp"

namespace tandem::bridges::tag_tracker {

struct TagOptions {
  std::string frames, camera, family = "tag36h11";
  double size_m = 0.05, height_m = 0.0, decimate = 1.0, rate_hz = 0.0;
  std::int64_t threads = 1, contrast = 30;
  void describe(hal::ParamVisitor& v) {
    v.text("frames", frames, "Where they come from: camera:/dev/video0, film:FILE, folder:FOLDER or pipe:FILE.");
    v.text("camera", camera, "File of the camera, as `tandem calibrate` makes it.");
    v.choice("family", family, apriltag::family_names(), "Of the tags.");
    v.number("size", size_m, hal::unit::m, {0.001, 10.0}, "Side of a tag's black square.");
    v.number("tag_height", height_m, hal::unit::m, {0.0, 10.0}, "Above the floor, of tags that no robot has.");
    v.number(
        "decimate", decimate, hal::unit::none, {1.0, 8.0},
        "Tags are looked for in frames so many times smaller: 1, 1.5 or a whole number; faster, and blinder to small "
        "tags.");
    v.integer("threads", threads, {1, 64}, "That look for tags, besides the one that reads frames.");
    v.integer("contrast", contrast, {1, 255},
              "Least difference between a tag's black and white, of 255. Smaller: tags in the dark are found, and the "
              "noise of a bare floor costs time.");
    v.number("rate", rate_hz, hal::unit::hz, {0.0, 1000.0},
             "Frames a second, of a folder (0: 15) and of a camera (0: its own).");
  }
};

MadeTracker make_tag_tracker(const TrackerRequest& request, const hal::Log& log);
hal::Status check_tag_tracker(const TrackerRequest& request);
/// How many pixels tags have, and what that means.
std::string outlook_of_tags(const TrackerRequest& request);

}  // namespace tandem::bridges::tag_tracker
