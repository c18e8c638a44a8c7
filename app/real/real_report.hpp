// Real robots and peers in the report and the table of a run.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "hal/json/json.hpp"
#include "mixed_reality/lockstep/lockstep.hpp"
#include "mixed_reality/session/report.hpp"

namespace tandem::app {

/// Of the table: a title and a text each.
using Rows = std::vector<std::pair<std::string, std::string>>;

/// Members: real robots, those that took another one's place, trackers, pace, clock.
hal::Json report_json(const mixed_reality::MixedReport& report);
Rows rows_of(const mixed_reality::MixedReport& report);
Rows rows_of(const mixed_reality::LockstepReport& report);

}  // namespace tandem::app
