// A space that no world steps, for those who show it to viewers: one real robot by itself.
#pragma once
#include <cstdint>
#include <functional>
#include <string>

#include "core/live/live_run.hpp"
#include "core/record/observer.hpp"
#include "hal/catalog.hpp"
#include "hal/json/json.hpp"

namespace tandem::app {

/// What it refers to outlives who shows it.
struct ViewedSpace {
  std::string experiment;
  std::int64_t ticks_per_second = 10;
  const hal::Catalog& catalog;
  core::Watched& watched;                   ///< gets what viewers command
  std::function<core::Observation()> look;  ///< as of the last tick
  std::function<hal::Json()> real;          ///< message "real" of the view protocol
};

}  // namespace tandem::app
