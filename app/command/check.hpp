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

  void describe(hal::CommandLine& line) {
    line.word("experiment", experiment, "The experiment file (.xml)").required().file();
    line.option("--set", overrides, "Change the experiment first: path=value").repeatable();
    describe_plugins(line, plugins);
  }
};

constexpr std::string_view kCheckSummary = "Validate an experiment and print every problem.";

}  // namespace tandem::app
