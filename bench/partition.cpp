#include "bench/partition.hpp"

#include "core/scenario/split.hpp"

namespace tandem::bench {

const std::vector<Partition>& partitions() {
  static const std::vector<Partition> all = {
      {"A1", "1x1"}, {"A2", "2x1"}, {"A4", "2x2"}, {"A8", "4x2"}, {"A16", "4x4"}};
  return all;
}

hal::Result<Partition> partition_named(const std::string& name) {
  std::string names;
  for (const Partition& p : partitions()) {
    if (p.name == name) return p;
    names += (names.empty() ? "" : ", ") + p.name;
  }
  return hal::Error{"there is no partition '" + name + "'; there are: " + names + "; any other split is --regions 5x3"};
}

hal::Result<Partition> partition_split(const std::string& regions) {
  for (const Partition& p : partitions()) {
    if (p.regions == regions) return p;
  }
  if (regions == "auto" || core::parse_split(regions)) return Partition{regions, regions};
  return hal::Error{"--regions takes columns x lines, e.g. 4x4, or auto; not '" + regions + "'"};
}

std::int64_t parts_of(const std::string& regions) {
  const auto split = core::parse_split(regions);
  return split ? static_cast<std::int64_t>(split->columns * split->lines) : 0;
}

}  // namespace tandem::bench
