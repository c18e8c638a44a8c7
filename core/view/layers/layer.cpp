#include "core/view/layers/layer.hpp"

#include <cstdio>

namespace tandem::core {

void Panel::row(std::string_view label, double value_si, const hal::Unit& unit) {
  char digits[40];
  std::snprintf(digits, sizeof digits, "%.6g", value_si / unit.to_si);
  rows_.push_back({std::string(label), digits, std::string(unit.symbol)});
}

}  // namespace tandem::core
