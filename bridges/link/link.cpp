#include "bridges/link/link.hpp"

#include "hal/monotonic.hpp"

namespace tandem::bridges {

hal::TimeNs monotonic_ns() noexcept {
  return hal::monotonic_ns();
}

}  // namespace tandem::bridges
