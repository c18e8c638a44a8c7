// A kind of field: an element of <arena>, and its object in a world.
#pragma once
#include <memory>
#include <string_view>

#include "core/scenario/element.hpp"
#include "hal/params.hpp"
#include "hal/surface.hpp"

namespace tandem::core {

class Field;  // core/space/field.hpp

/// The arena over which a field lies.
struct FieldArea {
  double min_x_m = -1.0, min_y_m = -1.0, size_x_m = 2.0, size_y_m = 2.0;
};

/// Every world has one field of each kind in the catalog.
struct FieldType {
  static constexpr std::string_view kCategory = "field";
  static constexpr std::uint32_t kNumber = 2;
  using Crosses = hal::Layouts<Element, Problem, FieldArea, hal::ParamVisitor>;
  std::string_view name;  ///< as sensors ask for it; of its element in experiment files, where it has one
  std::string_view summary;
  /// Has the visitor fill or show what its element says. Null: files say nothing of it. An attribute `path` is that of
  /// a file, and is written relative to the experiment's.
  void (*describe)(hal::ParamVisitor& visitor) = nullptr;
  /// `element` has no attributes where the file says nothing.
  std::unique_ptr<Field> (*make)(const Element& element, const FieldArea& area, Problems& problems) = nullptr;
};

/// The table of field class `T`, constructed from `(const T::Params&, const FieldArea&)`.
template <class T>
constexpr FieldType field_type(std::string_view name, std::string_view summary) {
  return {name, summary, [](hal::ParamVisitor& visitor) { typename T::Params{}.describe(visitor); },
          [](const Element& element, const FieldArea& area, Problems& problems) -> std::unique_ptr<Field> {
            return std::make_unique<T>(read_settings<typename T::Params>(element, problems), area);
          }};
}

}  // namespace tandem::core
