#include "mixed_reality/settings/patience.hpp"

#include <algorithm>

namespace tandem::mixed_reality {

hal::TimeNs lost_after_ns(const core::RobotItem& item, std::int64_t ticks_per_second) noexcept {
  return std::max(static_cast<hal::TimeNs>(item.bridge->timeout_s * 1e9), hal::time_of_tick(2, ticks_per_second));
}

}  // namespace tandem::mixed_reality
