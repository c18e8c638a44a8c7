#include "bridges/inspector_type.hpp"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <ctime>

#include "hal/monotonic.hpp"

namespace tandem::bridges {

std::string formatted(const char* format, ...) {
  va_list arguments;
  va_start(arguments, format);
  va_list again;
  va_copy(again, arguments);
  const int length = std::vsnprintf(nullptr, 0, format, arguments);
  va_end(arguments);
  std::string text(static_cast<std::size_t>(std::max(length, 0)), '\0');
  std::vsnprintf(text.data(), text.size() + 1, format, again);
  va_end(again);
  return text;
}

hal::TimeNs inspector_now_ns() noexcept {
  return hal::monotonic_ns();
}

bool wait_until(hal::TimeNs at, const std::atomic<bool>& stop) {
  constexpr hal::TimeNs kLook_ns = 20 * hal::kNsPerMs;
  for (hal::TimeNs now = inspector_now_ns(); now < at && !stop.load(); now = inspector_now_ns()) {
    const timespec t{0, static_cast<long>(std::min(kLook_ns, at - now))};
    nanosleep(&t, nullptr);
  }
  return !stop.load();
}

void print_readings(const InspectRequest& request, const std::vector<PortView>& views) {
  request.print("readings");
  for (const PortView& view : views) request.print("  " + hal::to_text(*view.type, view.data));
}

}  // namespace tandem::bridges
