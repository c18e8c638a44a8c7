// Ledger of one real robot's time: how old its readings are, how long it takes to answer, what came too late.
#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

#include "bridges/robot_bridge.hpp"
#include "hal/duration_histogram.hpp"
#include "hal/port.hpp"
#include "hal/time.hpp"
#include "hal/unit.hpp"

namespace tandem::mixed_reality {

/// Figures of a run so far. Quantiles are at most 1/16 too large.
struct RobotLedger {
  std::uint64_t ticks = 0;
  std::uint64_t late_readings = 0;           ///< ticks without a reading in time: none that its bridge calls fresh
  std::uint64_t late_commands = 0;           ///< ticks whose command left when the next tick should have begun
  std::optional<hal::TimeNs> newest_age_ns;  ///< of its newest reading at the last tick; nothing: none came yet
  hal::TimeNs age_median_ns = 0, age_p99_ns = 0, age_largest_ns = 0;  ///< of its newest reading, at each tick
  hal::TimeNs command_p99_ns = 0, command_largest_ns = 0;             ///< from the schedule of a tick to its command
  std::uint64_t answers = 0;
  hal::TimeNs round_trip_median_ns = 0, round_trip_p99_ns = 0, round_trip_largest_ns = 0;
  hal::TimeNs jitter_ns = 0;                 ///< mean change from one round trip to the next
  std::optional<bridges::ClockState> clock;  ///< of the robot; nothing: its messages carry no stamps
};

/// The same as a row of a record.
struct LedgerRow {
  static constexpr std::string_view kName = "ledger";
  static constexpr std::string_view kDoc =
      "Ages, round trips and what came too late, of the run so far, once a second.";

  float age_ms = 0.0F, age_median_ms = 0.0F, age_p99_ms = 0.0F;
  float round_trip_median_ms = 0.0F, round_trip_p99_ms = 0.0F, jitter_ms = 0.0F;
  std::uint32_t late_readings = 0, late_commands = 0, clock_jumps = 0;
  float clock_drift_ppm = 0.0F, clock_bound_ms = 0.0F;
  double clock_offset_s = 0.0;

  LedgerRow() = default;
  explicit LedgerRow(const RobotLedger& l) noexcept
      : age_ms(l.newest_age_ns ? ms(*l.newest_age_ns) : kUnknown),
        age_median_ms(ms(l.age_median_ns)),
        age_p99_ms(ms(l.age_p99_ns)),
        round_trip_median_ms(ms(l.round_trip_median_ns)),
        round_trip_p99_ms(ms(l.round_trip_p99_ns)),
        jitter_ms(ms(l.jitter_ns)),
        late_readings(static_cast<std::uint32_t>(l.late_readings)),
        late_commands(static_cast<std::uint32_t>(l.late_commands)),
        clock_jumps(l.clock ? static_cast<std::uint32_t>(l.clock->jumps) : 0),
        clock_drift_ppm(l.clock ? static_cast<float>(l.clock->drift_ppm) : kUnknown),
        clock_bound_ms(l.clock && l.clock->bound_ns ? ms(*l.clock->bound_ns) : kUnknown),
        clock_offset_s(l.clock ? hal::to_seconds(l.clock->offset_ns) : static_cast<double>(kUnknown)) {}

  void describe(hal::FieldList& f) const {
    const auto real = hal::Fusion::Real;
    const auto none = hal::Frame::None;
    const auto& unit = hal::unit::none;
    f.add("age_ms", age_ms, unit, none, real, "of its newest reading; NaN: none came yet");
    f.add("age_median_ms", age_median_ms, unit, none, real, "of its newest reading, at each tick");
    f.add("age_p99_ms", age_p99_ms, unit, none, real, "of its newest reading, at each tick");
    f.add("round_trip_median_ms", round_trip_median_ms, unit, none, real, "from question to answer");
    f.add("round_trip_p99_ms", round_trip_p99_ms, unit, none, real, "from question to answer");
    f.add("jitter_ms", jitter_ms, unit, none, real, "mean change from one round trip to the next");
    f.add("late_readings", late_readings, unit, none, real, "ticks without a reading in time");
    f.add("late_commands", late_commands, unit, none, real, "ticks whose command left too late");
    f.add("clock_jumps", clock_jumps, unit, none, real, "times its clock was set");
    f.add("clock_drift_ppm", clock_drift_ppm, unit, none, real, "of its clock; NaN: it stamps nothing");
    f.add("clock_bound_ms", clock_bound_ms, unit, none, real, "of the error of the offset; NaN: not known");
    f.add("clock_offset_s", clock_offset_s, unit, none, real, "this computer's clock less its; NaN: it stamps nothing");
  }

 private:
  static constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  static float ms(hal::TimeNs ns) noexcept { return static_cast<float>(static_cast<double>(ns) * 1e-6); }
};

/// Keeps it, tick by tick; allocates nothing.
class RobotTimes {
 public:
  /// The newest reading at a tick; null: it never measured.
  void note_reading(const hal::Reading* newest, hal::TimeNs run_ns) noexcept {
    ++ticks_;
    if (newest == nullptr || newest->validity != hal::Validity::Fresh) ++late_readings_;
    newest_age_ns_.reset();
    if (newest == nullptr || newest->validity == hal::Validity::Absent) return;
    newest_age_ns_ = run_ns > newest->taken_ns ? run_ns - newest->taken_ns : 0;
    ages_.add(*newest_age_ns_);
  }
  /// Its command left so long after the tick should have begun; a tick lasts `tick_ns`.
  void note_command(hal::TimeNs after_ns, hal::TimeNs tick_ns) noexcept {
    commands_.add(after_ns);
    if (after_ns > tick_ns) ++late_commands_;
  }

  RobotLedger ledger(const bridges::LinkReport& link) const noexcept {
    RobotLedger l;
    l.ticks = ticks_;
    l.late_readings = late_readings_;
    l.late_commands = late_commands_;
    l.newest_age_ns = newest_age_ns_;
    l.age_median_ns = ages_.quantile_ns(0.5);
    l.age_p99_ns = ages_.quantile_ns(0.99);
    l.age_largest_ns = ages_.largest_ns();
    l.command_p99_ns = commands_.quantile_ns(0.99);
    l.command_largest_ns = commands_.largest_ns();
    l.answers = link.answers;
    l.round_trip_median_ns = link.median_round_trip_ns;
    l.round_trip_p99_ns = link.p99_round_trip_ns;
    l.round_trip_largest_ns = link.max_round_trip_ns;
    l.jitter_ns = link.round_trip_jitter_ns;
    l.clock = link.clock;
    return l;
  }

  std::size_t row = 0;  ///< where its LedgerRow is

 private:
  std::uint64_t ticks_ = 0, late_readings_ = 0, late_commands_ = 0;
  std::optional<hal::TimeNs> newest_age_ns_;
  hal::DurationHistogram ages_, commands_;
};

}  // namespace tandem::mixed_reality
