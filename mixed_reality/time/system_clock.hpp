// Whether this machine's date is kept right: by NTP, PTP or whatever tells the kernel.
#pragma once
#include <string>

#include "hal/time.hpp"

namespace tandem::mixed_reality {

/// What the kernel knows of CLOCK_REALTIME [adjtimex(2)].
struct SystemClock {
  bool known = false;         ///< false: the kernel does not tell
  bool synchronised = false;  ///< a daemon (chronyd, systemd-timesyncd, ntpd; ptp4l with phc2sys) keeps it
  hal::TimeNs estimated_error_ns = 0;
  hal::TimeNs most_error_ns = 0;  ///< grows by 500 parts in a million since it was last corrected
  double frequency_ppm = 0.0;     ///< by which the kernel corrects its crystal

  /// For people: "synchronised, within 1.3 ms (estimated 0.2 ms)".
  std::string text() const;
};

SystemClock system_clock() noexcept;

/// CLOCK_REALTIME: nanoseconds since 1970, UTC.
hal::TimeNs unix_now_ns() noexcept;

}  // namespace tandem::mixed_reality
