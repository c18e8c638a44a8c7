#include "bridges/link/link.hpp"

#include <time.h>

namespace tandem::bridges {

hal::TimeNs monotonic_ns() noexcept {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return hal::TimeNs{t.tv_sec} * hal::kNsPerSecond + hal::TimeNs{t.tv_nsec};
}

}  // namespace tandem::bridges
