#include "bridges/link/link.hpp"

#include <cerrno>
#include <ctime>
#include <poll.h>

#include "bridges/link/descriptor_link.hpp"
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

std::size_t DescriptorLink::write(std::span<const std::uint8_t> bytes, hal::TimeNs budget_ns) noexcept {
  const hal::TimeNs deadline = monotonic_ns() + budget_ns;
  std::size_t done = 0;
  while (done < bytes.size() && open_) {
    const ssize_t n = put(bytes.subspan(done));
    if (n > 0) {
      done += static_cast<std::size_t>(n);
    } else if (n < 0 && errno != EAGAIN && errno != EINTR) {
      hang_up();
    } else {
      const hal::TimeNs left = deadline - monotonic_ns();
      if (left <= 0) break;
      pollfd p{descriptor_, POLLOUT, 0};
      ::poll(&p, 1, static_cast<int>((left + hal::kNsPerMs - 1) / hal::kNsPerMs));
      if ((p.revents & (POLLHUP | POLLERR | POLLNVAL)) != 0) hang_up();
    }
  }
  bytes_out_ += done;
  bytes_refused_ += bytes.size() - done;
  return done;
}

}  // namespace tandem::bridges
