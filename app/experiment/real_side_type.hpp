// The offer of the module `real` to runs: an entry of the catalog.
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/scenario/scenario.hpp"
#include "hal/catalog.hpp"
#include "hal/result.hpp"

namespace tandem::app {

class RealSide;  // app/run/real_side.hpp
struct RunPlan;  // app/run/run_plan.hpp

struct RealSideType {
  static constexpr std::string_view kCategory = "real_side";
  using Crosses = hal::Layouts<core::Scenario, core::Problems>;
  std::string_view name;
  /// Judges bridges, peers and trackers of a file.
  void (*check)(const core::Scenario& scenario, const hal::Catalog& catalog, core::Problems& problems) = nullptr;
  /// What trackers of a file can be expected to see, a sentence each.
  std::vector<std::string> (*outlooks)(const core::Scenario& scenario, const hal::Catalog& catalog) = nullptr;
  /// Files that bridges read: a robot's id, what it is, its path.
  struct Input {
    std::string robot, what, path;
  };
  std::vector<Input> (*inputs)(const core::Scenario& scenario, const hal::Catalog& catalog) = nullptr;
  /// `plan` outlives it. Error: an option of real robots makes no sense.
  hal::Result<std::unique_ptr<RealSide>> (*make)(RunPlan& plan) = nullptr;
};

}  // namespace tandem::app
