#include "bridges/emulation/server.hpp"

namespace tandem::bridges {

hal::Status Server::serve(const std::atomic<bool>& stop) {
  if (const hal::Status begun = begin(); !begun.ok()) return begun;
  const hal::Status served = turn_until(
      stop, tell_, [this](hal::TimeNs now) { return turn(now); }, [this](hal::TimeNs now) { return next_wake(now); },
      [this](hal::TimeNs wake, hal::TimeNs now) {
        std::vector<pollfd> polls;
        add_polls(now, polls);
        wait_for(polls, wake, now);
        return polled(polls);
      });
  end(monotonic_ns(), served);
  return served;
}

}  // namespace tandem::bridges
