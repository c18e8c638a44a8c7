#include "tests/bridges/link/memory_link.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <vector>

namespace tandem::bridges {

/// Both directions. Index: the side that reads.
class MemoryPipe {
 public:
  MemoryPipe(Clock clock, std::size_t capacity) : clock_(std::move(clock)), capacity_(capacity) {}

  struct Chunk {
    std::vector<std::uint8_t> bytes;
    std::size_t taken = 0;
    hal::TimeNs at_ns = 0;
  };
  struct Side {
    std::deque<Chunk> chunks;
    std::size_t waiting = 0;
    LinkStatistics statistics;
  };

  Clock clock_;
  std::size_t capacity_;
  mutable std::mutex mutex_;
  std::condition_variable arrived_;
  std::array<Side, 2> sides_;
  bool open_ = true;
};

std::pair<std::unique_ptr<MemoryLink>, std::unique_ptr<MemoryLink>> MemoryLink::make_pair(Clock clock,
                                                                                          std::size_t capacity) {
  auto pipe = std::make_shared<MemoryPipe>(std::move(clock), capacity);
  return {std::unique_ptr<MemoryLink>(new MemoryLink(pipe, 0)), std::unique_ptr<MemoryLink>(new MemoryLink(pipe, 1))};
}

MemoryLink::~MemoryLink() {
  hang_up();
}

std::size_t MemoryLink::write(std::span<const std::uint8_t> bytes, hal::TimeNs) noexcept {
  const hal::TimeNs now = pipe_->clock_();
  const std::lock_guard lock(pipe_->mutex_);
  MemoryPipe::Side& mine = pipe_->sides_[static_cast<std::size_t>(side_)];
  MemoryPipe::Side& other = pipe_->sides_[static_cast<std::size_t>(1 - side_)];
  const std::size_t room = pipe_->open_ ? pipe_->capacity_ - other.waiting : 0;
  const std::size_t n = std::min(bytes.size(), room);
  if (n > 0) other.chunks.push_back({{bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(n)}, 0, now});
  other.waiting += n;
  mine.statistics.bytes_out += n;
  mine.statistics.bytes_refused += bytes.size() - n;
  pipe_->arrived_.notify_all();
  return n;
}

Received MemoryLink::read(std::span<std::uint8_t> buffer) noexcept {
  const std::lock_guard lock(pipe_->mutex_);
  MemoryPipe::Side& mine = pipe_->sides_[static_cast<std::size_t>(side_)];
  if (mine.chunks.empty() || buffer.empty()) return {};
  MemoryPipe::Chunk& chunk = mine.chunks.front();
  const std::size_t n = std::min(buffer.size(), chunk.bytes.size() - chunk.taken);
  std::copy_n(chunk.bytes.begin() + static_cast<std::ptrdiff_t>(chunk.taken), n, buffer.begin());
  const Received received{n, chunk.at_ns};
  chunk.taken += n;
  if (chunk.taken == chunk.bytes.size()) mine.chunks.pop_front();
  mine.waiting -= n;
  mine.statistics.bytes_in += n;
  return received;
}

bool MemoryLink::wait(hal::TimeNs timeout_ns) noexcept {
  std::unique_lock lock(pipe_->mutex_);
  const MemoryPipe::Side& mine = pipe_->sides_[static_cast<std::size_t>(side_)];
  const bool hung_up_before = !pipe_->open_;
  pipe_->arrived_.wait_for(lock, std::chrono::nanoseconds(timeout_ns),
                           [&] { return !mine.chunks.empty() || (!hung_up_before && !pipe_->open_); });
  return !mine.chunks.empty();
}

LinkState MemoryLink::state() const noexcept {
  const std::lock_guard lock(pipe_->mutex_);
  return pipe_->open_ ? LinkState::Open : LinkState::HungUp;
}

LinkStatistics MemoryLink::statistics() const noexcept {
  const std::lock_guard lock(pipe_->mutex_);
  return pipe_->sides_[static_cast<std::size_t>(side_)].statistics;
}

void MemoryLink::hang_up() noexcept {
  const std::lock_guard lock(pipe_->mutex_);
  if (pipe_->open_) {
    for (MemoryPipe::Side& side : pipe_->sides_) ++side.statistics.errors;
  }
  pipe_->open_ = false;
  pipe_->arrived_.notify_all();
}

}  // namespace tandem::bridges
