// The commands that measure the reality gap: `tandem fit`, `tandem gap`.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/command/command.hpp"

namespace tandem::app {

struct FitOptions {
  Libraries plugins;
  std::vector<std::string> records;
  std::vector<std::string> robots;  ///< ids, or patterns with '*'; empty: all real ones, or all where none is real
  std::string output;               ///< file of fitted parameters; empty: none
  std::string report;               ///< JSON file, or "-"
};
int fit(const FitOptions& options);

struct GapOptions {
  Libraries plugins;
  std::string record, other;        ///< an empty other: the first, simulated
  std::vector<std::string> robots;  ///< as FitOptions
  std::string fitted;               ///< file of fitted parameters for the simulation; empty: as the record's settings
  std::vector<std::string> overrides;  ///< of the simulation's settings
  std::optional<std::uint64_t> seed;   ///< of the simulation; none: the record's
  std::string report;                  ///< JSON file, or "-"
};
int gap(const GapOptions& options);

}  // namespace tandem::app
