// Actions of a recorded run, to be done again in another.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/live/live_run.hpp"
#include "hal/result.hpp"

namespace tandem::core {

/// What a record says about how to repeat its run.
struct Repeatable {
  std::optional<std::uint64_t> seed;  ///< at its start
  std::string experiment;             ///< its name
  std::vector<RepeatedAction> actions;
  hal::Json scripts = hal::Json::object();  ///< that its controllers ran at the start, as source_files gave them
  std::map<hal::Tick, std::uint64_t> fingerprints;  ///< by tick; none of a run that was reset
  bool real_robots = false;  ///< took part: what was done to them (arming, stops) is not among the actions
};

/// Reads the record's actions: those that went back and undid do not count. Errors: no record; an action that makes no
/// sense.
hal::Result<Repeatable> read_repeatable(const std::string& record);

}  // namespace tandem::core
