#include "tests/bridges/can/memory_bus.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <vector>

namespace tandem::bridges {
namespace {

/// What one end holds: frames in a ring that never grows.
struct End {
  explicit End(std::size_t capacity) : frames(capacity) {}
  void put(const CanFrame& frame) noexcept {
    if (count == frames.size()) {
      ++record.counts.overrun;
      return;
    }
    frames[(first + count++) % frames.size()] = frame;
  }
  bool take(CanFrame& frame) noexcept {
    if (count == 0) return false;
    frame = frames[first];
    first = (first + 1) % frames.size();
    --count;
    return true;
  }
  std::vector<CanFrame> frames;
  std::size_t first = 0;
  std::size_t count = 0;
  BusRecord record;
};

}  // namespace

struct MemoryBus::Shared {
  Shared(Clock c, std::size_t n) : clock(std::move(c)), capacity(n) {}
  Clock clock;
  std::size_t capacity;
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<End*> ends;
  BusState state = BusState::Active;
  bool full = false;
};

namespace {

class MemoryCanLink final : public CanLink {
 public:
  explicit MemoryCanLink(std::shared_ptr<MemoryBus::Shared> bus) : bus_(std::move(bus)), end_(bus_->capacity) {
    const std::lock_guard lock(bus_->mutex);
    end_.record.become(bus_->state);
    bus_->ends.push_back(&end_);
  }
  ~MemoryCanLink() override {
    const std::lock_guard lock(bus_->mutex);
    std::erase(bus_->ends, &end_);
  }

  Sent send(const CanFrame& frame) noexcept override {
    const hal::TimeNs now = bus_->clock();
    const std::lock_guard lock(bus_->mutex);
    if (!frame.valid() || !can_pass(end_.record.state())) {
      ++end_.record.counts.refused;
      return Sent::Refused;
    }
    if (bus_->full) {
      ++end_.record.counts.full;
      return Sent::Full;
    }
    CanFrame stamped = frame;
    stamped.at_ns = now;
    for (End* end : bus_->ends) {
      if (end != &end_) end->put(stamped);
    }
    ++end_.record.counts.frames_out;
    bus_->changed.notify_all();
    return Sent::Taken;
  }

  bool receive(CanFrame& frame) noexcept override {
    const std::lock_guard lock(bus_->mutex);
    if (!end_.take(frame)) return false;
    ++end_.record.counts.frames_in;
    return true;
  }

  bool wait(hal::TimeNs timeout_ns) noexcept override {
    std::unique_lock lock(bus_->mutex);
    const BusState before = end_.record.state();
    bus_->changed.wait_for(lock, std::chrono::nanoseconds(timeout_ns),
                           [&] { return end_.count > 0 || end_.record.state() != before; });
    return end_.count > 0;
  }

  BusState state() const noexcept override {
    const std::lock_guard lock(bus_->mutex);
    return end_.record.state();
  }
  CanStatistics statistics() const noexcept override {
    const std::lock_guard lock(bus_->mutex);
    return end_.record.counts;
  }
  std::string name() const override { return "memory bus"; }

 private:
  std::shared_ptr<MemoryBus::Shared> bus_;
  End end_;
};

}  // namespace

MemoryBus::MemoryBus(Clock clock, std::size_t capacity)
    : shared_(std::make_shared<Shared>(std::move(clock), std::max<std::size_t>(capacity, 1))) {}

std::unique_ptr<CanLink> MemoryBus::attach() {
  return std::make_unique<MemoryCanLink>(shared_);
}

void MemoryBus::set_state(BusState state) noexcept {
  const std::lock_guard lock(shared_->mutex);
  shared_->state = state;
  for (End* end : shared_->ends) end->record.become(state);
  shared_->changed.notify_all();
}

void MemoryBus::set_full(bool full) noexcept {
  const std::lock_guard lock(shared_->mutex);
  shared_->full = full;
}

}  // namespace tandem::bridges
