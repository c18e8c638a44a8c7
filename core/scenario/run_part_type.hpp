// A kind of part that files and the command line have join a run: an element of <run>.
#pragma once
#include <memory>
#include <string_view>

#include "core/scenario/element.hpp"
#include "hal/params.hpp"
#include "hal/result.hpp"
#include "hal/surface.hpp"

namespace tandem::core {

class Run;      // core/run/run.hpp
class RunPart;  // the same

struct RunPartType {
  static constexpr std::string_view kCategory = "run_part";
  using Crosses = hal::Layouts<Element, Problem, hal::Status, hal::ParamVisitor>;
  std::string_view name;  ///< of its element in <run>
  std::string_view summary;
  /// Has the visitor fill or show what its element says. An attribute `path` is that of the file that it writes.
  void (*describe)(hal::ParamVisitor& visitor) = nullptr;
  /// Before the first tick. Problems: what it cannot find, or not write.
  std::unique_ptr<RunPart> (*make)(const Element& element, Run& run, Problems& problems) = nullptr;
};

}  // namespace tandem::core
