// Messages of a tracker, by docs/trackers.md.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tandem::bridges::tracker_emulator {

/// One thing as the tracker sees it.
struct Seen {
  std::string name;
  double x_m = 0.0, y_m = 0.0;
  std::optional<double> heading_rad{};
};

/// All things of one exposure.
struct Exposure {
  std::int64_t stamp_ns = 0;
  double sd_m = 0.0, sd_rad = 0.0;  ///< 0: unknown
  std::vector<Seen> seen;
};

std::vector<std::byte> json_message(const Exposure& exposure);
std::vector<std::byte> compact_message(const Exposure& exposure);
std::vector<std::byte> lcm_message(const Exposure& exposure);

}  // namespace tandem::bridges::tracker_emulator
