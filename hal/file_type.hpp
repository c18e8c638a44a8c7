// Files beside experiments that can be checked on their own: a robot's map.
#pragma once
#include <string>
#include <string_view>

#include "hal/element.hpp"
#include "hal/surface.hpp"

namespace tandem::hal {

struct FileType {
  static constexpr std::string_view kCategory = "file";
  using Crosses = Layouts<Problem, Problems>;
  std::string_view name;  ///< of the root element
  /// Appends what is wrong, with lines. @returns what is in it, for people; empty when it cannot be used.
  std::string (*check)(const std::string& path, Problems& problems) = nullptr;
};

}  // namespace tandem::hal
