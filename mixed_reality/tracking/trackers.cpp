#include "mixed_reality/tracking/trackers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hal/check.hpp"
#include "mixed_reality/time/system_clock.hpp"
#include "mixed_reality/tracking/fused_pose.hpp"

namespace tandem::mixed_reality {
namespace {

constexpr std::size_t kTakenAtOnce = 256;
constexpr hal::TimeNs kLongAgo_ns = std::numeric_limits<hal::TimeNs>::min() / 2;  // what has no time that is believed

hal::TimeNs to_ns(double seconds) noexcept {
  return static_cast<hal::TimeNs>(std::llround(seconds * 1e9));
}

}  // namespace

Trackers::Trackers(const Arena& arena, hal::TimeNs (*unix_clock)() noexcept)
    : arena_(arena), unix_clock_(unix_clock != nullptr ? unix_clock : &unix_now_ns), taken_(kTakenAtOnce) {}

void Trackers::add(const core::TrackerItem& item, std::unique_ptr<bridges::Tracker> tracker) {
  TANDEM_CHECK(all_.size() < PoseFilter::kTrackers, "more trackers than a filter knows");
  One& one = all_.emplace_back();
  one.item = item;
  one.tracker = std::move(tracker);
  one.cos_turn = std::cos(item.turn_rad);
  one.sin_turn = std::sin(item.turn_rad);
}

void Trackers::add_robot(const std::vector<std::string>& names, const Tag& tag, FusedPose& pose) {
  for (const std::string& name : names) robots_.push_back({name, tag, &pose});
  std::sort(robots_.begin(), robots_.end(), [](const Robot& a, const Robot& b) { return a.name < b.name; });
}

void Trackers::remove_robot(const FusedPose& pose) {
  std::erase_if(robots_, [&](const Robot& robot) { return robot.pose == &pose; });
}

hal::Status Trackers::start() {
  for (One& one : all_) {
    if (const hal::Status started = one.tracker->start(); !started.ok())
      return hal::Error{"tracker '" + one.item.id + "': " + started.error().message};
  }
  return {};
}

void Trackers::latch(const Moment& now) noexcept {
  if (all_.empty()) return;
  unix_minus_monotonic_ns_ = unix_clock_() - now.monotonic_ns;
  for (std::size_t i = 0; i < all_.size(); ++i) {
    std::size_t count = 0, rounds = 0;
    do {
      count = all_[i].tracker->take(taken_);
      for (std::size_t k = 0; k < count; ++k) hand_over(all_[i], static_cast<std::uint8_t>(i), taken_[k], now);
    } while (count == taken_.size() && ++rounds < 16);
  }
}

void Trackers::hand_over(One& one, std::uint8_t number, const bridges::Sighting& sighting, const Moment& now) noexcept {
  const hal::TimeNs at_ns = taken_ns(one, sighting, now.monotonic_ns);
  const Robot* const robot = robot_called(sighting.who());
  if (robot == nullptr) return note_unknown(one, sighting);
  if (at_ns > std::min(sighting.received_ns, now.monotonic_ns) + kAhead_ns) {
    ++one.from_future;
    return;
  }
  if (now.monotonic_ns - at_ns > kOldest_ns) {
    ++one.old;
    return;
  }
  PoseMeasurement pose;
  pose.tracker = number;
  pose.taken_ns = at_ns;
  pose.by_true_clock = sighting.stamp_ns && one.item.clock != "own";
  pose.x_m = one.item.p_WT[0] + one.cos_turn * sighting.p_m[0] - one.sin_turn * sighting.p_m[1];
  pose.y_m = one.item.p_WT[1] + one.sin_turn * sighting.p_m[0] + one.cos_turn * sighting.p_m[1];
  if (sighting.heading_rad) {
    const double heading_rad = *sighting.heading_rad + one.item.turn_rad - robot->tag.turn_rad;
    pose.heading_rad = heading_rad;
    pose.x_m -= std::cos(heading_rad) * robot->tag.x_m - std::sin(heading_rad) * robot->tag.y_m;
    pose.y_m -= std::sin(heading_rad) * robot->tag.x_m + std::cos(heading_rad) * robot->tag.y_m;
  }
  pose.sd_m = sighting.sd_m.value_or(one.item.sd_m);
  pose.sd_rad = sighting.sd_rad.value_or(one.item.sd_rad);
  const bool inside = pose.x_m >= arena_.min_x_m - kOutside_m && pose.x_m <= arena_.max_x_m + kOutside_m &&
                      pose.y_m >= arena_.min_y_m - kOutside_m && pose.y_m <= arena_.max_y_m + kOutside_m;
  if (!inside) {  // or no numbers
    ++one.outside;
    return robot->pose->note_impossible();
  }
  one.newest_ns = one.any ? std::max(one.newest_ns, at_ns) : at_ns;
  one.any = true;
  robot->pose->see(pose, sighting.stamp_ns);
}

/// On CLOCK_MONOTONIC.
hal::TimeNs Trackers::taken_ns(One& one, const bridges::Sighting& sighting, hal::TimeNs now_ns) const noexcept {
  const hal::TimeNs latency_ns = to_ns(one.item.latency_s);
  if (sighting.stamp_ns && !bridges::ClockEstimator::plausible(*sighting.stamp_ns)) {
    one.clock.note(*sighting.stamp_ns, sighting.received_ns);  // counts it
    return kLongAgo_ns;
  }
  if (!sighting.stamp_ns) return sighting.received_ns - latency_ns;
  one.clock.note(*sighting.stamp_ns, sighting.received_ns);
  if (one.item.clock == "monotonic") return *sighting.stamp_ns;
  if (one.item.clock == "unix") return by_date_ns(one, sighting, now_ns);
  if (!one.clock.known()) return sighting.received_ns - latency_ns;
  return *sighting.stamp_ns + one.clock.offset_ns(sighting.received_ns) - latency_ns;
}

/// When our date is set, a tracker's is not: its stamps are good by the date as it was.
hal::TimeNs Trackers::by_date_ns(One& one, const bridges::Sighting& sighting, hal::TimeNs now_ns) const noexcept {
  const auto sound = [&](hal::TimeNs at_ns) {
    return at_ns <= std::min(sighting.received_ns, now_ns) + kAhead_ns && now_ns - at_ns <= kOldest_ns;
  };
  const hal::TimeNs at_ns = *sighting.stamp_ns - unix_minus_monotonic_ns_;
  if (sound(at_ns)) {
    one.date_ns = unix_minus_monotonic_ns_;
    return at_ns;
  }
  if (!one.date_ns || !sound(*sighting.stamp_ns - *one.date_ns)) return at_ns;
  ++one.by_former_date;
  return *sighting.stamp_ns - *one.date_ns;
}

const Trackers::Robot* Trackers::robot_called(std::string_view name) const noexcept {
  const auto found = std::lower_bound(robots_.begin(), robots_.end(), name,
                                      [](const Robot& robot, std::string_view wanted) { return robot.name < wanted; });
  return found != robots_.end() && found->name == name ? &*found : nullptr;
}

void Trackers::note_unknown(One& one, const bridges::Sighting& sighting) noexcept {
  ++one.unknown;
  const auto end = one.unknown_first.begin() + static_cast<std::ptrdiff_t>(one.unknown_kept);
  const bool told =
      std::any_of(one.unknown_first.begin(), end, [&](const auto& other) { return other.who() == sighting.who(); });
  if (!told && one.unknown_kept < kUnknownKept) one.unknown_first[one.unknown_kept++] = sighting;
}

std::vector<TrackerStatus> Trackers::status(hal::TimeNs monotonic_ns) const {
  std::vector<TrackerStatus> all;
  for (const One& one : all_) {
    const bridges::ClockState clock = one.clock.state(monotonic_ns);
    TrackerStatus s;
    s.id = one.item.id;
    s.kind = one.item.kind;
    s.heard = one.tracker->report();
    s.unknown = one.unknown;
    s.from_future = one.from_future;
    s.old = one.old;
    s.outside = one.outside;
    s.clock_jumps = clock.jumps + clock.implausible;
    s.by_former_date = one.by_former_date;
    if (clock.messages + clock.implausible > 0) s.clock = clock;
    if (clock.messages > 0 && one.item.clock != "own") {
      const bool by_date = one.item.clock == "unix";
      s.shortest_way_s =
          hal::to_seconds(clock.offset_ns + (by_date ? one.date_ns.value_or(unix_minus_monotonic_ns_) : 0));
    }
    if (one.any) s.newest_age_s = hal::to_seconds(monotonic_ns - one.newest_ns);
    for (std::size_t i = 0; i < one.unknown_kept; ++i) s.unknown_names.emplace_back(one.unknown_first[i].who());
    all.push_back(std::move(s));
  }
  return all;
}

}  // namespace tandem::mixed_reality
