// Delays between the hub and a real robot: their definitions, and their identification.
//
//   command given ----link in----> robot has it ----command----> motors turn ----body----> the floor
//    (stamp: sent)                                                   |
//    reading  <----link out---- robot answers  <----counters---------+         tracker: sees the floor, and stamps that
//    (stamp: the middle between question and answer)
//
// What stamps and measured places tell are three sums, wherever the delay is:
//
//   to way       link in + command + body        places by a tracker whose stamps are right, against commands
//   to counters  link / 2 + command + counters   encoders against commands; link is both ways together
//   lag          to way - to counters            places against encoders: by how much the body is later than these say
//
// and the link's round trip. The parts follow only as far as none is negative. [The filter (mixed_reality/tracking) and
// `tandem fit` (mixed_reality/gap) both use this page, so they blame the same.]
#pragma once
#include <algorithm>
#include <cmath>
#include <optional>

namespace tandem::mixed_reality {

/// A delay that was found, or not.
struct DelayEstimate {
  double value_s = 0.0;
  double bound_s = 0.0;  ///< half of the interval that holds the true one in 95 of 100 cases
  bool told = false;     ///< false: the data cannot tell it, and the others mean nothing
};

/// What a tracker that seems to see the robot `later_s` than the encoders say means: of trackers with right stamps it
/// is the robot's body that is late; of others it may be either, and is taken for the tracker's.
struct SeenLater {
  double lag_s = 0.0;      ///< of the body, behind the stamps of its encoders; may be negative
  double tracker_s = 0.0;  ///< of the tracker, behind its own stamps
};
constexpr SeenLater seen_later(double later_s, bool stamps_are_right) noexcept {
  return stamps_are_right ? SeenLater{later_s, 0.0} : SeenLater{0.0, later_s};
}

/// What the sums leave of the parts.
struct DelayParts {
  DelayEstimate link_in, command, body, counters;
};

inline constexpr double kPartTold_s = 0.003;  ///< a part whose interval is wider than twice this is not told

/// Each part lies between what remains when the others are as large and as small as can be, none being negative. Sums
/// that are not told leave theirs open.
inline DelayParts parts_of(const DelayEstimate& to_way, const DelayEstimate& to_counters,
                           const DelayEstimate& round_trip) noexcept {
  const auto between = [](double least_s, double most_s) {
    const double low_s = std::max(0.0, least_s), high_s = std::max(low_s, most_s);
    const DelayEstimate part{0.5 * (low_s + high_s), 0.5 * (high_s - low_s), true};
    return part.bound_s <= kPartTold_s ? part : DelayEstimate{};
  };
  DelayParts parts;
  const bool link = round_trip.told;
  const double link_most_s = round_trip.value_s + round_trip.bound_s;
  if (link) parts.link_in = between(0.0, link_most_s);
  if (!link || !to_counters.told) return parts;
  const double half_s = 0.5 * round_trip.value_s, error_s = std::hypot(to_counters.bound_s, 0.5 * round_trip.bound_s);
  const double both_most_s = to_counters.value_s - half_s + error_s;  // command and counters together
  parts.command = parts.counters = between(0.0, both_most_s);
  if (!to_way.told) return parts;
  parts.body = between(to_way.value_s - to_way.bound_s - link_most_s - std::max(0.0, both_most_s),
                       to_way.value_s + to_way.bound_s);
  return parts;
}

}  // namespace tandem::mixed_reality
