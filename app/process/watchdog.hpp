// Watches that calls into plug-ins return.
#pragma once
#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace tandem::app {

/// Names a controller or hook that does not return within a time, and ends the process when it has not returned and a
/// stop was asked for, or within a longer time. Has a thread of its own; where none can be made, it says so and does
/// nothing.
class Watchdog {
 public:
  /// `limit_s` 0: names nothing, and a stop waits 5 s. `end_s` 0: it ends the process only after a stop. `stop` must
  /// outlive this.
  Watchdog(double limit_s, const std::atomic<bool>& stop, double end_s = 0.0);
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  /// See `SaveAtEnd`.
  std::mutex& lock() noexcept { return lock_; }

 private:
  void watch();

  friend class SaveAtEnd;
  void set_save(std::function<void()> save);

  const double limit_s_, end_s_;
  const std::atomic<bool>& stop_;
  std::mutex lock_;
  std::function<void()> save_;
  std::mutex ending_lock_;
  std::condition_variable ending_changed_;
  bool ending_ = false;
  std::thread thread_;
};

/// What prepares the outputs before the watchdog ends the process, for as long as it lives. Is called on the watchdog's
/// thread, while the thread that steps is in the call that does not return; so that it stays there, it takes
/// `Watchdog::lock` before it touches what `save` reads.
class SaveAtEnd {
 public:
  /// `watchdog` must outlive this.
  SaveAtEnd(Watchdog& watchdog, std::function<void()> save) : watchdog_(watchdog) {
    watchdog.set_save(std::move(save));
  }
  ~SaveAtEnd() { watchdog_.set_save({}); }
  SaveAtEnd(const SaveAtEnd&) = delete;
  SaveAtEnd& operator=(const SaveAtEnd&) = delete;

 private:
  Watchdog& watchdog_;
};

}  // namespace tandem::app
