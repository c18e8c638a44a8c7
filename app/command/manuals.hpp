// All commands with their descriptions, for completion and manual pages.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "hal/catalog.hpp"
#include "hal/command.hpp"

namespace tandem::app {

/// A command as it describes itself. One that only holds others ("plugin") has no `command`.
struct CommandManual {
  std::string name, summary, heading;
  bool of_launcher = false;
  std::unique_ptr<hal::CommandCall> command;  ///< holds the values of `line`
  hal::CommandLine line;

  /// "plugin" of "plugin new"; else empty.
  std::string group() const;
  /// "new" of "plugin new"; "run" of "run".
  std::string last_word() const;
};

/// Those of the catalog, by heading, then those of the launcher.
std::vector<CommandManual> command_manuals(const hal::Catalog& catalog);

/// "-o" and "--output" of "-o,--output".
std::vector<std::string> names_of(const hal::Argument& argument);

/// Whether it takes any number of values.
bool takes_several(const hal::Argument& argument);

/// What shells offer for it: its choices, what it suggests, and names of its category.
std::vector<std::string> values_of(const hal::Argument& argument, const hal::Catalog& catalog);

}  // namespace tandem::app
