#include "bridges/aseba/node_bridge.hpp"

#include <ctime>
#include <poll.h>

namespace tandem::bridges::aseba::detail {

// The link is not held meanwhile.
void wait_for_input(hal::TimeNs timeout_ns, int descriptor) {
  if (descriptor < 0) timeout_ns = std::min(timeout_ns, kBlindWait);
  pollfd p{descriptor, POLLIN, 0};
  const timespec t{0, static_cast<long>(timeout_ns)};
  const bool ready = ::ppoll(&p, descriptor < 0 ? 0 : 1, &t, nullptr) > 0;
  if (!ready || (p.revents & POLLIN) != 0) return;
  const timespec pause{0, kBlindWait};  // the line is dead: a loop of waits must not spin
  ::nanosleep(&pause, nullptr);
}

}  // namespace tandem::bridges::aseba::detail
