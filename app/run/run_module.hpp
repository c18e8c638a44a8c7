// Additions of modules besides `real` to a run of the command line: pictures, held runs, the window.
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/outputs/report.hpp"
#include "core/run/run.hpp"
#include "hal/result.hpp"
#include "hal/surface.hpp"

namespace tandem::app {

struct RunOptions;
struct RunPlan;
struct ViewRequest;
struct ViewedSpace;

/// An entry of the catalog, by its module's name. Each function may be null. Codes are those of the program; what was
/// wrong was told.
struct RunModule {
  static constexpr std::string_view kCategory = "run_module";
  using Crosses = hal::Layouts<NamedFile, core::Run>;
  std::string_view name;
  /// Files that it is going to write. Error: they cannot be made here.
  hal::Result<std::vector<NamedFile>> (*outputs)(const RunOptions& options) = nullptr;
  /// The experiment is read, and there is no world yet.
  int (*begin)(RunPlan& plan) = nullptr;
  /// The world is made: opens what it writes.
  int (*prepare)(RunPlan& plan) = nullptr;
  /// Adds its parts; real robots take part by then.
  int (*add)(RunPlan& plan, core::Run& run) = nullptr;
  /// Opens a window on a space that no world steps. Error: it cannot be opened.
  hal::Result<std::unique_ptr<core::RunPart>> (*view)(const ViewRequest& request, const ViewedSpace& shown) = nullptr;
};

}  // namespace tandem::app
