// All trackers of a run: brings what they see into one frame and onto one clock, and hands it to the robots concerned.
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bridges/clock_estimator.hpp"
#include "bridges/tracker.hpp"
#include "core/scenario/scenario.hpp"
#include "mixed_reality/time/moment.hpp"

namespace tandem::mixed_reality {

class FusedPose;

/// Of one tracker, counted from the start.
struct TrackerStatus {
  std::string id, kind;
  bridges::TrackerReport heard;
  std::uint64_t unknown = 0;         ///< sightings of what is no robot of the file
  std::uint64_t from_future = 0;     ///< stamped later than they came
  std::uint64_t old = 0;             ///< older than Trackers::kOldest_ns
  std::uint64_t outside = 0;         ///< beyond the arena by more than Trackers::kOutside_m
  std::uint64_t clock_jumps = 0;     ///< of its own clock, stamps that no clock shows among them
  std::uint64_t by_former_date = 0;  ///< sightings believed by this computer's date as it was before it was set
  std::optional<bridges::ClockState> clock = {};  ///< nothing: it stamps nothing
  /// By the date, or CLOCK_MONOTONIC: from the quickest message's stamp to its arrival. Negative: the clocks are apart.
  std::optional<double> shortest_way_s = {};
  double newest_age_s = -1.0;              ///< of its newest sighting of a robot; negative: none yet
  std::vector<std::string> unknown_names;  ///< the first few
};

class Trackers {
 public:
  static constexpr hal::TimeNs kOldest_ns = 2 * hal::kNsPerSecond;
  static constexpr hal::TimeNs kAhead_ns = 10 * hal::kNsPerMs;  ///< that clocks may be apart
  static constexpr double kOutside_m = 1.0;

  struct Arena {
    double min_x_m, min_y_m, max_x_m, max_y_m;
  };
  /// `unix_clock`: nanoseconds since 1970; null: the system's.
  explicit Trackers(const Arena& arena, hal::TimeNs (*unix_clock)() noexcept = nullptr);

  /// In this order: trackers, PoseFilter::kTrackers at most; robots; `start`.
  void add(const core::TrackerItem& item, std::unique_ptr<bridges::Tracker> tracker);
  /// Where what is seen of a robot is on it, and how it is turned against the robot's forward axis.
  struct Tag {
    double turn_rad = 0.0;
    double x_m = 0.0, y_m = 0.0;  ///< forward, to the left; not used where a tracker sees points only
  };
  /// `pose` must outlive this, or be removed.
  void add_robot(const std::vector<std::string>& names, const Tag& tag, FusedPose& pose);
  void remove_robot(const FusedPose& pose);
  /// Error: a tracker cannot listen, with its id.
  hal::Status start();

  /// Takes all that was seen since the last call; before the robots' poses are latched. Neither waits nor allocates.
  void latch(const Moment& now) noexcept;

  bool empty() const noexcept { return all_.empty(); }
  const std::string& id(std::size_t tracker) const { return all_[tracker].item.id; }
  std::size_t size() const noexcept { return all_.size(); }
  std::vector<TrackerStatus> status(hal::TimeNs monotonic_ns) const;

 private:
  static constexpr std::size_t kUnknownKept = 8;
  struct One {
    core::TrackerItem item;
    std::unique_ptr<bridges::Tracker> tracker;
    double cos_turn, sin_turn;
    bridges::ClockEstimator clock;
    std::uint64_t unknown = 0, from_future = 0, old = 0, outside = 0;
    hal::TimeNs newest_ns = 0;
    bool any = false;
    std::optional<hal::TimeNs> date_ns;  // minus CLOCK_MONOTONIC, as it was when a sighting was last believed by it
    std::uint64_t by_former_date = 0;
    std::array<bridges::Sighting, kUnknownKept> unknown_first;
    std::size_t unknown_kept = 0;
  };
  struct Robot {
    std::string name;
    Tag tag;
    FusedPose* pose;
  };
  void hand_over(One& one, std::uint8_t number, const bridges::Sighting& sighting, const Moment& now) noexcept;
  hal::TimeNs taken_ns(One& one, const bridges::Sighting& sighting, hal::TimeNs now_ns) const noexcept;
  hal::TimeNs by_date_ns(One& one, const bridges::Sighting& sighting, hal::TimeNs now_ns) const noexcept;
  const Robot* robot_called(std::string_view name) const noexcept;
  static void note_unknown(One& one, const bridges::Sighting& sighting) noexcept;

  Arena arena_;
  hal::TimeNs (*unix_clock_)() noexcept;
  std::vector<One> all_;
  std::vector<Robot> robots_;  // by name
  std::vector<bridges::Sighting> taken_;
  hal::TimeNs unix_minus_monotonic_ns_ = 0;
};

}  // namespace tandem::mixed_reality
