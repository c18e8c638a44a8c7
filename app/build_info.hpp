// Versions, compiler and commit of this program, for reports and --version: enough to repeat a result.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "hal/json/json.hpp"

namespace tandem::app {

struct BuildInfo {
  std::string version;
  std::string commit;  ///< in full; " with changes" behind it when the checkout had any; empty: built outside of git
  std::string compiler;
  std::string build;                                             ///< type and flags that decide about bits
  std::string processor;                                         ///< of this machine
  std::string system;                                            ///< kernel and C library of this machine
  std::vector<std::pair<std::string, std::string>> compiled_in;  ///< libraries of headers alone, with their versions
  std::vector<std::pair<std::string, std::string>> shared;       ///< libraries that are loaded now, with their files
};

/// Asks the machine when it is called for the first time.
const BuildInfo& build_info();

/// "0.1.0 (1ff4ba8d3c2e)"
std::string version_text();

/// As a report has it under "program".
hal::Json to_json(const BuildInfo& info);

}  // namespace tandem::app
