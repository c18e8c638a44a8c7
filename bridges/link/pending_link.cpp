#include "bridges/link/pending_link.hpp"

#include <mutex>
#include <thread>

namespace tandem::bridges {

struct PendingLink::Work {
  std::mutex mutex;
  std::optional<hal::Result<std::unique_ptr<ByteLink>>> result;
};

PendingLink::PendingLink(LinkOpener opener) : work_(std::make_shared<Work>()) {
  std::thread([work = work_, open = std::move(opener)] {
    auto result = open();
    const std::lock_guard lock(work->mutex);
    work->result.emplace(std::move(result));
  }).detach();
}

std::optional<hal::Result<std::unique_ptr<ByteLink>>> PendingLink::take() {
  const std::lock_guard lock(work_->mutex);
  auto result = std::move(work_->result);
  work_->result.reset();
  return result;
}

}  // namespace tandem::bridges
