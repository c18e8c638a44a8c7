// Rows of a mixed run's record that say where real robots were measured to be, how well, and by which clock.
//
// They are of no effect in the space, and a replay passes over them: sets "time" and "seen" of a record.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "hal/port.hpp"
#include "hal/time.hpp"

namespace tandem::mixed_reality {

/// The clocks of one tick, at the moment when its inputs were taken: row "clock" of the run as a whole.
struct ClockRow {
  static constexpr std::string_view kName = "clock";
  static constexpr std::string_view kDoc = "Clocks when the inputs of the tick were taken.";

  std::int64_t monotonic_ns = 0;    ///< CLOCK_MONOTONIC of this computer
  std::int64_t unix_ns = 0;         ///< CLOCK_REALTIME: since 1970, UTC
  std::int64_t run_ns = 0;          ///< the run's clock, which all stamps of readings are on
  std::uint32_t skipped_slots = 0;  ///< whole ticks of the schedule that were left out so far

  void describe(hal::FieldList& f) const {
    const auto& unit = hal::unit::none;
    f.add("monotonic_ns", monotonic_ns, unit, "CLOCK_MONOTONIC of the hub's computer");
    f.add("unix_ns", unix_ns, unit, "CLOCK_REALTIME of the hub's computer: ns since 1970, UTC");
    f.add("run_ns", run_ns, unit, "the run's clock, which stamps of readings are on");
    f.add("skipped_slots", skipped_slots, unit, "slots of the schedule that were left out so far");
  }
};

/// Where one real robot was by its source of poses, before the twin is carried on and smoothed: row "track".
struct TrackRow {
  static constexpr std::string_view kName = "track";
  static constexpr std::string_view kDoc = "Where real robots were by trackers and wheels, and how well that is known.";
  static constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

  bool known = false;
  std::int64_t taken_ns = 0;  ///< on the run's clock
  double x_m = 0.0, y_m = 0.0, z_m = 0.0, heading_rad = 0.0;
  std::array<float, 4> q_WB = {1.0F, 0.0F, 0.0F, 0.0F};
  float sd_m = kUnknown, sd_rad = kUnknown;  ///< the larger of those of x and y; of the heading
  /// Of x, y (m) and heading (rad): xx, xy, yy, x heading, y heading, heading heading.
  std::array<float, 6> covariance = {kUnknown, kUnknown, kUnknown, kUnknown, kUnknown, kUnknown};
  std::int64_t sent_ns = -1;  ///< when the command of this tick was given to its link, on the run's clock

  /// What the filter has learnt of its wheels, and how well.
  float left = kUnknown, right = kUnknown, base = kUnknown, lag_s = kUnknown, command_s = kUnknown;
  float left_sd = kUnknown, right_sd = kUnknown, base_sd = kUnknown, lag_sd_s = kUnknown, command_sd_s = kUnknown;

  void describe(hal::FieldList& f) const {
    const auto& none = hal::unit::none;
    f.add("known", known, none, "0: nobody knew where it was, and the next ones are where the file puts it");
    f.add("taken_ns", taken_ns, none, "when it was there, on the run's clock");
    f.add("x", x_m, hal::unit::m, "in W");
    f.add("y", y_m, hal::unit::m, "in W");
    f.add("z", z_m, hal::unit::m, "in W");
    f.add("heading", heading_rad, hal::unit::rad, "counter-clockwise from x of W");
    f.add("q_WB", q_WB, none, "attitude: w, x, y, z; level where nothing measures it");
    f.add("sd", sd_m, hal::unit::m, "standard deviation, the larger of those of x and y; NaN: not known");
    f.add("sd_heading", sd_rad, hal::unit::rad, "standard deviation; NaN: not known");
    f.add("covariance", covariance, none, "in m and rad: xx, xy, yy, x heading, y heading, heading heading");
    f.add("sent_ns", sent_ns, none, "when this tick's command was given to its link, on the run's clock; -1: none");
    f.add("left", left, none, "learnt: way of the left wheel, of what its encoder says; NaN: not learnt");
    f.add("right", right, none, "learnt: of the right wheel");
    f.add("base", base, none, "learnt: of the wheel base");
    f.add("lag", lag_s, hal::unit::s, "learnt: by which its body is later than its encoders' stamps");
    f.add("command_delay", command_s, hal::unit::s, "learnt: from a command until its encoders show it");
    f.add("left_sd", left_sd, none, "standard deviation");
    f.add("right_sd", right_sd, none, "standard deviation");
    f.add("base_sd", base_sd, none, "standard deviation");
    f.add("lag_sd", lag_sd_s, hal::unit::s, "standard deviation");
    f.add("command_delay_sd", command_sd_s, hal::unit::s, "standard deviation");
  }
};

/// What trackers saw of one robot since the tick before, as it came, whether it was believed or not: row "sightings".
struct SightingsRow {
  static constexpr std::string_view kName = "sightings";
  static constexpr std::string_view kDoc = "What trackers saw of real robots since the tick before.";
  static constexpr std::size_t kCapacity = 16;

  std::uint8_t count = 0;
  std::uint32_t lost = 0;  ///< of the run so far: more came in one tick than there is room for
  std::array<std::int64_t, kCapacity> taken_ns{};
  std::array<double, kCapacity> x_m{}, y_m{};
  std::array<double, kCapacity> heading_rad{};
  std::array<float, kCapacity> sd_m{}, sd_rad{};
  std::array<std::uint8_t, kCapacity> tracker{};
  std::array<std::uint8_t, kCapacity> true_clock{};

  void describe(hal::FieldList& f) const {
    const auto& none = hal::unit::none;
    f.add("count", count, none, "sightings");
    f.add("lost", lost, none, "of the run so far: more came in one tick than there is room for");
    f.add("taken_ns", taken_ns, none, "when the tracker saw it, on the run's clock").used_by = "count";
    f.add("x", x_m, hal::unit::m, "in W, of the robot's axis").used_by = "count";
    f.add("y", y_m, hal::unit::m, "in W, of the robot's axis").used_by = "count";
    f.add("heading", heading_rad, hal::unit::rad, "counter-clockwise from x of W; NaN: it sees a point").used_by =
        "count";
    f.add("sd", sd_m, hal::unit::m, "standard deviation of x and of y, as the tracker says").used_by = "count";
    f.add("sd_heading", sd_rad, hal::unit::rad, "the same of the heading").used_by = "count";
    f.add("tracker", tracker, none, "number of the tracker, in the order of the file, from 0 on").used_by = "count";
    f.add("true_clock", true_clock, none, "1: its stamp is no estimate: the date, or the hub's clock").used_by =
        "count";
  }
};

}  // namespace tandem::mixed_reality
