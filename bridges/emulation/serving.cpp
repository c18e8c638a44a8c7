#include "bridges/emulation/serving.hpp"

#include <algorithm>
#include <time.h>

namespace tandem::bridges {

void tell_late(hal::TimeNs due, hal::TimeNs now, const EventSink& tell) {
  if (now - due >= kLateNs) tell(now, "late", {{"by_ms", (now - due) / hal::kNsPerMs}});
}

void wait_for(std::vector<pollfd>& polls, hal::TimeNs at, hal::TimeNs now) {
  const hal::TimeNs left = std::max<hal::TimeNs>(0, at - now);
  const timespec t{static_cast<time_t>(left / hal::kNsPerSecond), static_cast<long>(left % hal::kNsPerSecond)};
  ::ppoll(polls.data(), polls.size(), &t, nullptr);  // a signal wakes it too
}

}  // namespace tandem::bridges
