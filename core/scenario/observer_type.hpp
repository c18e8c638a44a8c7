// A kind of observer: an element of <record>, and its object in a run.
#pragma once
#include <memory>
#include <string_view>

#include "core/scenario/element.hpp"
#include "hal/params.hpp"
#include "hal/result.hpp"
#include "hal/surface.hpp"

namespace tandem::core {

class Observer;      // core/record/observer.hpp
struct Observation;  // the same

struct ObserverType {
  static constexpr std::string_view kCategory = "observer";
  using Crosses = hal::Layouts<Element, Problem, hal::Status, hal::ParamVisitor>;
  std::string_view name;  ///< of its element in <record>
  std::string_view summary;
  /// Has the visitor fill or show what its element says. An attribute `path` is that of the file that it writes.
  void (*describe)(hal::ParamVisitor& visitor) = nullptr;
  /// Before the first tick. Problems: what it cannot find, or not write.
  std::unique_ptr<Observer> (*make)(const Element& element, const Observation& start, Problems& problems) = nullptr;
};

}  // namespace tandem::core
