// Opening a link without waiting for it.
#pragma once
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "hal/result.hpp"
#include "hal/time.hpp"

namespace tandem::bridges {

/// An opener at work on a thread of its own, because opening a Bluetooth device may take the kernel many seconds.
/// Giving up early is safe: the thread goes on alone, and closes what it still opens.
template <class Link>
class Pending {
 public:
  using Opened = hal::Result<std::unique_ptr<Link>>;

  explicit Pending(std::function<Opened()> opener) {
    std::thread([work = work_, open = std::move(opener)] {
      auto result = open();
      const std::lock_guard lock(work->mutex);
      work->result.emplace(std::move(result));
      work->done.notify_all();
    }).detach();
  }

  /// Empty while at work; the opener's result exactly once, after which it is empty again.
  std::optional<Opened> take() {
    const std::lock_guard lock(work_->mutex);
    return std::exchange(work_->result, std::nullopt);
  }
  /// Until there is a result, at most `timeout_ns`.
  void wait(hal::TimeNs timeout_ns) const {
    std::unique_lock lock(work_->mutex);
    work_->done.wait_for(lock, std::chrono::nanoseconds(timeout_ns), [this] { return work_->result.has_value(); });
  }

 private:
  struct Work {
    std::mutex mutex;
    std::condition_variable done;
    std::optional<Opened> result;
  };
  std::shared_ptr<Work> work_ = std::make_shared<Work>();  // shared with the thread, which outlives an impatient owner
};

}  // namespace tandem::bridges
