// How long threads of some processes waited for a processor, by the kernel's own account.
#pragma once
#include <map>
#include <string>
#include <sys/types.h>

#include "hal/time.hpp"

namespace tandem::hal {

/// What a machine that is too busy keeps from programs that are to be in time. Knows nothing where the kernel keeps no
/// account (/proc/PID/task/TID/schedstat).
class ProcessorWaits {
 public:
  /// What threads of the process have waited until now does not count. For those that were there before.
  void begin(pid_t process);
  /// Notes what all threads of the process have waited by now. One that has ended has none.
  void look(pid_t process);
  /// The longest that a thread waited between two looks at it; of a new one, since it began.
  TimeNs longest_ns() const noexcept { return longest_ns_; }

 private:
  std::map<std::string, TimeNs> waited_ns_;  // by thread
  TimeNs longest_ns_ = 0;
};

}  // namespace tandem::hal
