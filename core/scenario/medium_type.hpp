// A kind of medium: an element of <media>, and the carrier of its signals in a world.
#pragma once
#include <memory>
#include <string_view>

#include "hal/params.hpp"
#include "hal/surface.hpp"

namespace tandem::core {

class Medium;  // core/medium/medium.hpp

struct MediumType {
  static constexpr std::string_view kCategory = "medium";
  using Crosses = hal::Layouts<hal::ParamVisitor>;
  std::string_view name;  ///< the element's in experiment files
  std::string_view summary;
  /// Has the visitor fill or show what such an element says beside its id. What sensors have options of the same name
  /// for, holds for those that name it and leave the option out.
  void (*describe)(hal::ParamVisitor& visitor) = nullptr;
  /// One serves all elements of the kind. Null: files may name it, but nothing here uses it.
  std::unique_ptr<Medium> (*make)() = nullptr;
};

}  // namespace tandem::core
