// Lists and manuals of one kind of entries, for `tandem list` and `tandem describe`; modules add theirs.
#pragma once
#include <fmt/format.h>
#include <string>
#include <string_view>
#include <vector>

#include "app/process/terminal.hpp"
#include "core/config/reader.hpp"
#include "hal/catalog.hpp"

namespace tandem::app {

struct Listing {
  static constexpr std::string_view kCategory = "listing";
  using Crosses = hal::Layouts<hal::Catalog>;
  std::string_view name;  ///< "bridges", as in `tandem list bridges`
  void (*list)(const hal::Catalog& catalog) = nullptr;
  /// Describes what has this name. False: nothing has; null: such entries have no manual.
  bool (*describe)(const hal::Catalog& catalog, const std::string& name) = nullptr;
};

/// " (libx.so)" behind what a plug-in brought, " (crab.xml:3)" behind a kind of robot from a file.
std::string from(const hal::Catalog& catalog, const void* entry);

/// Describes the elements of this name. False: none has it.
bool describe_elements(const std::vector<core::ElementManual>& manuals, const std::string& name);

/// A title, and a line for each entry of a type with a summary.
template <class T>
void list_entries(const hal::Catalog& catalog, std::string_view title) {
  fmt::print("{}:\n", title);
  for (const T* type : catalog.all<T>())
    fmt::print("  {:<22} {}{}\n", printable(type->name), printable(type->summary), from(catalog, type));
  if (catalog.all<T>().empty())
    fmt::print("  none in the plug-in folders; TANDEM_PLUGIN_PATH and --plugin name further ones\n");
}

}  // namespace tandem::app
