#include "bridges/tag_tracker/register.hpp"

#include "bridges/tag_tracker/tag_tracker.hpp"
#include "hal/element_options.hpp"

namespace tandem::bridges::tag_tracker {
namespace {

const TrackerType kType{.name = "apriltag",
                        .summary = "AprilTags in frames of a camera, a film, a folder of pictures or a pipe.",
                        .make = &make_tag_tracker,
                        .check = &check_tag_tracker,
                        .outlook = &outlook_of_tags};

}  // namespace

void register_tracker(hal::Registrar& registrar) {
  registrar.add(kType);
  registrar.add(hal::element_options<TagOptions>("tracker of apriltag"));
}

}  // namespace tandem::bridges::tag_tracker
