// Real robots of a run as viewers see them.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "app/run/real_side.hpp"
#include "core/record/record.hpp"
#include "hal/json/json.hpp"
#include "mixed_reality/session/mixed_session.hpp"

namespace tandem::app {

/// Message "real" of the view protocol: every real robot's link, ages, places and why it does not drive. Called by the
/// thread that steps.
hal::Json real_message(const std::vector<mixed_reality::RealRobotStatus>& robots,
                       const std::vector<core::RollRow>& roll);

/// Lines of the table on a terminal.
std::vector<RealRobots::Line> lines_of(const std::vector<mixed_reality::RealRobotStatus>& robots);

/// The ledgers of real robots are written into the record, of set "time". The session must outlive it.
hal::Status record_ledgers(core::Recorder& recorder, const mixed_reality::MixedSession& session);

/// What a record says of slots of the schedule that were left out before this tick: {"kind": "skipped", "slots", and
/// the clocks of the tick that came then}. Nothing: none were since `told`, which becomes the number of the run so far.
std::optional<hal::Json> skipped_event(const mixed_reality::ClockRow& now, std::uint32_t& told);

}  // namespace tandem::app
