// A clock that goes only when it is told to.
#pragma once
#include <functional>

#include "mixed_reality/time/monotonic.hpp"

namespace tandem::mixed_reality {

/// Time passes by `pass` and by sleeping; each sleep overruns by `oversleep_ns`.
class FakeTime final : public TimeSource {
 public:
  explicit FakeTime(hal::TimeNs now_ns) : now_ns_(now_ns) {}

  hal::TimeNs now_ns() const noexcept override { return now_ns_; }
  void sleep_until(hal::TimeNs until_ns, const std::atomic<bool>& stop) noexcept override {
    ++sleeps;
    if (on_sleep) on_sleep(now_ns_);
    if (!stop && now_ns_ < until_ns) now_ns_ = until_ns + oversleep_ns;
  }
  void pass(hal::TimeNs duration_ns) { now_ns_ += duration_ns; }

  hal::TimeNs oversleep_ns = 0;
  int sleeps = 0;
  std::function<void(hal::TimeNs now_ns)> on_sleep;  ///< before each

 private:
  hal::TimeNs now_ns_;
};

}  // namespace tandem::mixed_reality
