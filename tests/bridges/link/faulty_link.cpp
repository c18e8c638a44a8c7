#include "tests/bridges/link/faulty_link.hpp"

#include <algorithm>
#include <array>
#include <deque>
#include <mutex>

namespace tandem::bridges {
namespace {

enum class Draw : std::uint64_t { Loss = 1, Corruption, Bit, Jitter, Cut };

/// 64 bits from (seed, what, direction, number): the finaliser of SplitMix64 [Steele et al. 2014], once a key word.
std::uint64_t draw(std::uint64_t seed, Draw what, std::uint64_t direction, std::uint64_t number) noexcept {
  std::uint64_t h = 0x9E3779B97F4A7C15ULL;
  for (const std::uint64_t key : {seed, static_cast<std::uint64_t>(what) * 2 + direction, number}) {
    h += key + 0x9E3779B97F4A7C15ULL;
    h = (h ^ (h >> 30)) * 0xBF58476D1CE4E5B9ULL;
    h = (h ^ (h >> 27)) * 0x94D049BB133111EBULL;
    h ^= h >> 31;
  }
  return h;
}

double to_unit(std::uint64_t bits) noexcept {
  return static_cast<double>(bits >> 11) * 0x1p-53;
}

}  // namespace

/// Bytes on their way, each with the time at which it is let through. Index 0: to the robot, 1: from it.
struct FaultyLink::Queues {
  struct Delayed {
    std::uint8_t byte;
    hal::TimeNs due_ns;
  };
  std::mutex mutex;
  std::array<std::deque<Delayed>, 2> queue;
  std::array<std::uint64_t, 2> count{};
  std::array<hal::TimeNs, 2> last_due_ns{};
  LinkStatistics statistics;

  void put(const Faults& faults, std::size_t direction, std::uint8_t byte, hal::TimeNs now) {
    const std::uint64_t n = count[direction]++;
    const auto chance = [&](Draw what) { return to_unit(draw(faults.seed, what, direction, n)); };
    if (chance(Draw::Loss) < faults.loss) return;
    if (chance(Draw::Corruption) < faults.corruption) {
      byte = static_cast<std::uint8_t>(byte ^ (1U << (draw(faults.seed, Draw::Bit, direction, n) % 8)));
    }
    const auto jitter = static_cast<hal::TimeNs>(chance(Draw::Jitter) * static_cast<double>(faults.jitter_ns));
    last_due_ns[direction] = std::max(last_due_ns[direction], now + faults.delay_ns + jitter);
    queue[direction].push_back({byte, last_due_ns[direction]});
  }
};

FaultyLink::FaultyLink(std::unique_ptr<ByteLink> inner, const Faults& faults, Clock clock)
    : inner_(std::move(inner)),
      faults_(faults),
      clock_(std::move(clock)),
      start_ns_(clock_()),
      queues_(std::make_unique<Queues>()) {}

FaultyLink::~FaultyLink() = default;

bool FaultyLink::cut_at(hal::TimeNs now) const noexcept {
  if (faults_.cut <= 0.0 || faults_.cut_slot_ns <= 0) return false;
  const auto slot = static_cast<std::uint64_t>((now - start_ns_) / faults_.cut_slot_ns);
  return to_unit(draw(faults_.seed, Draw::Cut, 0, slot)) < faults_.cut;
}

void FaultyLink::send_due(hal::TimeNs now) noexcept {
  auto& queue = queues_->queue[0];
  if (cut_at(now)) queue.clear();
  while (!queue.empty() && queue.front().due_ns <= now) {
    inner_->write({&queue.front().byte, 1}, 0);
    queue.pop_front();
  }
}

void FaultyLink::collect(hal::TimeNs now) noexcept {
  std::array<std::uint8_t, 256> buffer;
  const bool cut = cut_at(now);
  if (cut) queues_->queue[1].clear();
  for (Received r = inner_->read(buffer); r.size > 0; r = inner_->read(buffer)) {
    for (std::size_t i = 0; i < r.size && !cut; ++i) queues_->put(faults_, 1, buffer[i], r.at_ns);
  }
}

std::size_t FaultyLink::write(std::span<const std::uint8_t> bytes, hal::TimeNs) noexcept {
  const hal::TimeNs now = clock_();
  const std::lock_guard lock(queues_->mutex);
  if (state() == LinkState::HungUp) {
    queues_->statistics.bytes_refused += bytes.size();
    return 0;
  }
  for (const std::uint8_t byte : bytes) queues_->put(faults_, 0, byte, now);
  queues_->statistics.bytes_out += bytes.size();
  send_due(now);
  return bytes.size();
}

Received FaultyLink::read(std::span<std::uint8_t> buffer) noexcept {
  const hal::TimeNs now = clock_();
  const std::lock_guard lock(queues_->mutex);
  send_due(now);
  collect(now);
  auto& queue = queues_->queue[1];
  Received received;
  while (received.size < buffer.size() && !queue.empty() && queue.front().due_ns <= now) {
    // Bytes of one call share a stamp: stop where the next was let through at another time.
    if (received.size > 0 && queue.front().due_ns != received.at_ns) break;
    buffer[received.size++] = queue.front().byte;
    received.at_ns = queue.front().due_ns;
    queue.pop_front();
  }
  queues_->statistics.bytes_in += received.size;
  return received;
}

bool FaultyLink::wait(hal::TimeNs timeout_ns) noexcept {
  hal::TimeNs nearest = timeout_ns;
  {
    const hal::TimeNs now = clock_();
    const std::lock_guard lock(queues_->mutex);
    send_due(now);
    collect(now);
    auto& queues = queues_->queue;
    if (!queues[1].empty() && queues[1].front().due_ns <= now) return true;
    for (const auto& queue : queues) {
      if (!queue.empty()) nearest = std::min(nearest, queue.front().due_ns - now);
    }
  }
  inner_->wait(std::max<hal::TimeNs>(nearest, 0));
  const hal::TimeNs now = clock_();
  const std::lock_guard lock(queues_->mutex);
  send_due(now);
  collect(now);
  const auto& arrived = queues_->queue[1];
  return !arrived.empty() && arrived.front().due_ns <= now;
}

LinkState FaultyLink::state() const noexcept {
  return cut_at(clock_()) ? LinkState::HungUp : inner_->state();
}

LinkStatistics FaultyLink::statistics() const noexcept {
  const std::lock_guard lock(queues_->mutex);
  LinkStatistics statistics = queues_->statistics;
  statistics.errors = inner_->statistics().errors;
  return statistics;
}

}  // namespace tandem::bridges
