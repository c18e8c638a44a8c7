#include "bridges/link/link.hpp"

#include <ctime>
#include <poll.h>

#include "hal/monotonic.hpp"

namespace tandem::bridges {

hal::TimeNs monotonic_ns() noexcept {
  return hal::monotonic_ns();
}

bool wait_for_input(int descriptor, hal::TimeNs timeout_ns) noexcept {
  pollfd p{descriptor, POLLIN, 0};
  const timespec t{static_cast<time_t>(timeout_ns / hal::kNsPerSecond),
                   static_cast<long>(timeout_ns % hal::kNsPerSecond)};
  return ::ppoll(&p, 1, &t, nullptr) > 0;
}

}  // namespace tandem::bridges
