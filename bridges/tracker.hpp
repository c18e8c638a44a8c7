// Interface of a tracker: sees real robots from outside (cameras, motion capture) and reports their places.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hal/result.hpp"
#include "hal/time.hpp"

namespace tandem::bridges {

/// One pose of one thing that a tracker saw, as it said it: in the tracker's frame, stamped by the tracker's clock.
struct Sighting {
  static constexpr std::size_t kLongestName = 31;
  std::array<char, kLongestName + 1> name{};  ///< or number of the tag; ends with a zero
  std::optional<std::int64_t> stamp_ns{};     ///< of the exposure; nothing: the tracker has no clock
  hal::TimeNs received_ns = 0;                ///< CLOCK_MONOTONIC
  std::array<double, 3> p_m{};
  std::optional<double> heading_rad{};  ///< counter-clockwise from the x axis; nothing: it sees points
  std::optional<double> sd_m{};         ///< of x and of y
  std::optional<double> sd_rad{};

  std::string_view who() const noexcept { return {name.data()}; }
  /// False: it is longer than there is room for, or empty.
  bool set_name(std::string_view text) noexcept {
    if (text.empty() || text.size() > kLongestName) return false;
    name.fill(0);
    std::copy(text.begin(), text.end(), name.begin());
    return true;
  }
};

/// Counted from the start.
struct TrackerReport {
  std::uint64_t messages = 0;                                      ///< that came
  std::uint64_t malformed = 0;                                     ///< of those, that were none, or only in part
  std::uint64_t sightings = 0;                                     ///< that were in them
  std::uint64_t dropped = 0;                                       ///< because they were not taken in time
  std::string trouble = {};                                        ///< what is wrong; empty: nothing is known to be
  std::vector<std::pair<std::string, std::uint64_t>> counts = {};  ///< that its kind alone has, by their names
};

/// Listens on a thread of its own, from `start` to its end.
class Tracker {
 public:
  virtual ~Tracker() = default;
  /// Begins to listen. Error: what it listens to cannot be opened.
  virtual hal::Status start() = 0;
  /// Moves what was seen since the last call into `into`, in the order in which it came; neither waits nor allocates.
  /// @returns how many; when that is all of `into`, there may be more.
  virtual std::size_t take(std::span<Sighting> into) noexcept = 0;
  virtual TrackerReport report() const = 0;
};

}  // namespace tandem::bridges
