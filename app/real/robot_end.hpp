// The end of `tandem robot`: its part of the report, and its exit code.
#pragma once
#include <optional>
#include <string>

#include "hal/json/json.hpp"
#include "hal/output_file.hpp"
#include "hal/result.hpp"

namespace tandem::app {

struct RobotEnd {
  std::string failure;         ///< what failed; empty: nothing
  bool interrupted = false;    ///< by a signal
  std::string how = "length";  ///< the end of one that neither failed nor was interrupted

  /// `how`, "interrupted" or "failed".
  std::string word() const;
};

/// None where `path` is empty. Error: it cannot be written.
hal::Result<std::optional<hal::OutputFile>> open_report(const std::string& path);

/// Adds the program and the end to `json`, writes it where a report was asked for, and says what failed. @returns the
/// exit code.
int end_robot(std::optional<hal::OutputFile>& report, hal::Json json, const RobotEnd& end);

}  // namespace tandem::app
