// Division of the benchmark's arena into regions: the names from the literature, and any other split.
#pragma once
#include <string>
#include <vector>

#include "hal/result.hpp"

namespace tandem::bench {

struct Partition {
  std::string name;
  std::string regions;  ///< columns x lines, as experiment files spell it
};

/// A1 to A16 of Pinciroli et al. (2012), section 4.2: equal parts of the square arena.
const std::vector<Partition>& partitions();

/// By name ("A4"); an error lists the names.
hal::Result<Partition> partition_named(const std::string& name);

/// By split ("4x2" or "auto"), with its name where it has one; an error says what a split looks like.
hal::Result<Partition> partition_split(const std::string& regions);

/// In how many parts a split divides; 0 for "auto".
std::int64_t parts_of(const std::string& regions);

}  // namespace tandem::bench
