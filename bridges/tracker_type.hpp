// Interface of a kind of trackers: makes one from its element in <trackers>.
//
//   void register_trackers(hal::Registrar& registrar) {
//     registrar.add(udp_type);                                              this table
//     registrar.add(hal::element_options<UdpOptions>("tracker of udp"));    its own attributes of its element
//   }
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/tracker.hpp"
#include "hal/log.hpp"
#include "hal/result.hpp"
#include "hal/surface.hpp"

namespace tandem::bridges {

/// What a tracker may see, as the experiment says.
struct TrackedThing {
  std::string name;       ///< or number of the tag
  double height_m = 0.0;  ///< of the tag, above the floor
};

/// One element of `<trackers>`.
struct TrackerRequest {
  std::string kind;                          ///< name of the element
  std::string id;                            ///< of this tracker
  std::string file = {};                     ///< the experiment; files that it names may lie beside it
  std::shared_ptr<const void> options = {};  ///< its own attributes, as read; null: all left out
  std::vector<TrackedThing> things = {};     ///< that the experiment knows
};

using MadeTracker = hal::Result<std::unique_ptr<Tracker>>;

struct TrackerType {
  static constexpr std::string_view kCategory = "tracker";
  using Crosses = hal::Layouts<Tracker, TrackerRequest, TrackedThing, MadeTracker, Sighting, TrackerReport, hal::Log>;
  std::string_view name;  ///< of its element
  std::string_view summary;
  /// Opens nothing yet. Errors: options that make no sense, files that it needs.
  MadeTracker (*make)(const TrackerRequest& request, const hal::Log& log) = nullptr;
  /// The errors of `make`, without making anything.
  hal::Status (*check)(const TrackerRequest& request) = nullptr;
  /// What it can see, in a few words for people, such as how many pixels its tags have; null: there is nothing to tell.
  /// Only where `check` finds no fault.
  std::string (*outlook)(const TrackerRequest& request) = nullptr;
};

/// The options of a request, or their defaults.
template <class Options>
Options options_of(const TrackerRequest& request) {
  return request.options == nullptr ? Options{} : *static_cast<const Options*>(request.options.get());
}

}  // namespace tandem::bridges
