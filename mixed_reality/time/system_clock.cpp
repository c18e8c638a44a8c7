#include "mixed_reality/time/system_clock.hpp"

#include <sys/timex.h>
#include <time.h>

#include "hal/unit.hpp"

namespace tandem::mixed_reality {

SystemClock system_clock() noexcept {
  SystemClock clock;
  timex t{};
  const int state = ::adjtimex(&t);
  if (state < 0) return clock;
  clock.known = true;
  clock.synchronised = state != TIME_ERROR && (t.status & STA_UNSYNC) == 0;
  clock.estimated_error_ns = static_cast<hal::TimeNs>(t.esterror) * 1000;
  clock.most_error_ns = static_cast<hal::TimeNs>(t.maxerror) * 1000;
  clock.frequency_ppm = static_cast<double>(t.freq) / 65536.0;
  return clock;
}

hal::TimeNs unix_now_ns() noexcept {
  timespec t{};
  ::clock_gettime(CLOCK_REALTIME, &t);
  return static_cast<hal::TimeNs>(t.tv_sec) * hal::kNsPerSecond + t.tv_nsec;
}

std::string SystemClock::text() const {
  if (!known) return "not known: the kernel does not tell";
  if (!synchronised)
    return "not synchronised: nothing keeps it right (chronyd, systemd-timesyncd, ntpd, or ptp4l with phc2sys); stamps "
           "by the date of other computers may be off by any time";
  const auto ms = [](hal::TimeNs ns) { return hal::format_number(static_cast<double>(ns / 1000) * 1e-3) + " ms"; };
  return "synchronised, within " + ms(most_error_ns) + " (estimated " + ms(estimated_error_ns) + ")";
}

}  // namespace tandem::mixed_reality
