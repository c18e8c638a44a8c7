// Ledgers of real robots and states of clocks as JSON: the same in reports, records and messages to viewers.
#pragma once
#include "bridges/clock_estimator.hpp"
#include "hal/json/json.hpp"
#include "mixed_reality/session/robot_ledger.hpp"
#include "mixed_reality/time/system_clock.hpp"
#include "mixed_reality/tracking/pose_source.hpp"

namespace tandem::app {

inline double to_ms(hal::TimeNs ns) noexcept {
  return static_cast<double>(ns) * 1e-6;
}

/// The bound is null where messages come one way alone.
inline hal::Json clock_json(const bridges::ClockState& clock) {
  return {{"offset_s", hal::to_seconds(clock.offset_ns)},
          {"drift_ppm", clock.drift_ppm},
          {"drift_bound_ppm", clock.drift_bound_ppm},
          {"bound_ms", clock.bound_ns ? hal::Json(to_ms(*clock.bound_ns)) : hal::Json(nullptr)},
          {"messages", clock.messages},
          {"exchanges", clock.exchanges},
          {"jumps", clock.jumps},
          {"shifts", clock.shifts},
          {"implausible", clock.implausible}};
}

inline hal::Json ledger_json(const mixed_reality::RobotLedger& l) {
  hal::Json json = {{"ticks", l.ticks},
                    {"late_readings", l.late_readings},
                    {"late_commands", l.late_commands},
                    {"age_ms", l.newest_age_ns ? hal::Json(to_ms(*l.newest_age_ns)) : hal::Json(nullptr)},
                    {"age_median_ms", to_ms(l.age_median_ns)},
                    {"age_p99_ms", to_ms(l.age_p99_ns)},
                    {"age_largest_ms", to_ms(l.age_largest_ns)},
                    {"command_p99_ms", to_ms(l.command_p99_ns)},
                    {"command_largest_ms", to_ms(l.command_largest_ns)},
                    {"answers", l.answers},
                    {"round_trip_median_ms", to_ms(l.round_trip_median_ns)},
                    {"round_trip_p99_ms", to_ms(l.round_trip_p99_ns)},
                    {"round_trip_largest_ms", to_ms(l.round_trip_largest_ns)},
                    {"jitter_ms", to_ms(l.jitter_ns)}};
  if (l.clock) json["clock"] = clock_json(*l.clock);
  return json;
}

/// What trackers saw of a robot.
inline hal::Json sightings_json(const mixed_reality::PoseCounts& c) {
  return {{"used", c.used},
          {"gated", c.gated},
          {"late", c.late},
          {"doubled", c.doubled},
          {"impossible", c.impossible},
          {"disputed", c.disputed},
          {"jumps", c.jumps},
          {"slips", c.slips}};
}

inline hal::Json system_clock_json(const mixed_reality::SystemClock& clock) {
  return {{"synchronised", clock.synchronised},
          {"text", clock.text()},
          {"estimated_error_ms", to_ms(clock.estimated_error_ns)},
          {"most_error_ms", to_ms(clock.most_error_ns)},
          {"frequency_ppm", clock.frequency_ppm}};
}

}  // namespace tandem::app
