// Options of `tandem check`, which the whole program and the one for boards do in their own ways.
#pragma once
#include <string>
#include <vector>

#include "app/command/command.hpp"
#include "app/command/shared_options.hpp"

namespace tandem::app {

struct CheckOptions {
  Libraries plugins;
  std::string experiment;
  std::vector<std::string> overrides;
  bool allow_io = false;
  bool strict = false;  ///< content of ARGoS files that nothing reads is an error, too

  void describe(hal::CommandLine& line) {
    line.word("experiment", experiment, "The experiment file (.xml)").required().file();
    line.option("--set", overrides, "Change the experiment first: path=value").repeatable();
    describe_allow_io(line, allow_io);
    line.flag("--strict", strict, "In an ARGoS file (<argos-configuration>), too, what nothing reads is an error");
    describe_plugins(line, plugins);
  }
  std::vector<std::string> all_overrides() const { return with_io(overrides, allow_io); }
};

/// A file that is no experiment, by the name of its root element. An entry of the catalog.
struct CheckedFile {
  static constexpr std::string_view kCategory = "checked_file";
  using Crosses = hal::Layouts<Libraries>;
  std::string_view name;
  /// @returns the exit code; errors, or the contents, were printed.
  int (*check)(const std::string& path, const Libraries& plugins) = nullptr;
};

constexpr std::string_view kCheckSummary = "Validate an experiment and print every problem.";

}  // namespace tandem::app
