// Attributes and children of an element of a file that belong to a part: its reader asks the catalog for them by name.
#pragma once
#include <memory>
#include <string>

#include "hal/params.hpp"
#include "hal/surface.hpp"

namespace tandem::hal {

/// Attributes and children that a part adds to an element which others describe, too.
struct ElementOptions {
  static constexpr std::string_view kCategory = "options";
  using Crosses = Layouts<ParamVisitor, ParamList>;
  std::string name;  ///< the element, and whose: "bridge of e-puck"
  /// Makes the part's options with their defaults, has the visitor fill or show them, and gives them back.
  std::shared_ptr<const void> (*read)(ParamVisitor& visitor) = nullptr;
};

/// The table of options `T`. One name a type.
template <Described T>
const ElementOptions& element_options(std::string name) {
  static const ElementOptions type{std::move(name), [](ParamVisitor& visitor) -> std::shared_ptr<const void> {
                                     auto options = std::make_shared<T>();
                                     options->describe(visitor);
                                     return options;
                                   }};
  return type;
}

}  // namespace tandem::hal
