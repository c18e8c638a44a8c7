#include "core/space/columns.hpp"

#include <string>

namespace tandem::core {

hal::Result<ColumnArrays*> Columns::of(const hal::RowType& type) {
  for (const auto& column : all_) {
    if (column->type->name != type.name) continue;
    if (column->type->layout == type.layout) return column.get();
    return hal::Error{"two kinds of state are called '" + std::string(type.name) +
                      "' and differ in their fields; rename one of them, or rebuild the library that brings it"};
  }
  all_.push_back(std::make_unique<ColumnArrays>());
  all_.back()->type = &type;
  return all_.back().get();
}

}  // namespace tandem::core
