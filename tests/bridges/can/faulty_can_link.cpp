#include "tests/bridges/can/faulty_can_link.hpp"

#include <algorithm>
#include <array>

namespace tandem::bridges {
namespace {

constexpr hal::TimeNs kLongestHold = 20 * hal::kNsPerMs;  // of a frame that waits to be overtaken

enum class Draw : std::uint64_t { Loss = 1, Doubling, Reordering, Lateness, BusOff };

/// 0 to 1 from (seed, what, direction, number): the finaliser of SplitMix64 [Steele et al. 2014], once a key word.
double draw(std::uint64_t seed, Draw what, std::uint64_t direction, std::uint64_t number) noexcept {
  std::uint64_t h = 0x9E3779B97F4A7C15ULL;
  for (const std::uint64_t key : {seed, static_cast<std::uint64_t>(what) * 2 + direction, number}) {
    h += key + 0x9E3779B97F4A7C15ULL;
    h = (h ^ (h >> 30)) * 0xBF58476D1CE4E5B9ULL;
    h = (h ^ (h >> 27)) * 0x94D049BB133111EBULL;
    h ^= h >> 31;
  }
  return static_cast<double>(h >> 11) * 0x1p-53;
}

}  // namespace

/// Frames on their way through the faults of one direction.
class FaultyCanLink::Way {
 public:
  explicit Way(std::uint64_t direction) : direction_(direction) {}

  void put(const CanFaults& faults, const CanFrame& frame, hal::TimeNs now) noexcept {
    const std::uint64_t n = number_++;
    const auto hit = [&](Draw what, double chance) { return draw(faults.seed, what, direction_, n) < chance; };
    if (hit(Draw::Loss, faults.loss)) return;
    const hal::TimeNs due = std::max(last_due_ns_, hit(Draw::Lateness, faults.lateness) ? now + faults.late_ns : now);
    last_due_ns_ = due;
    if (!holding_ && hit(Draw::Reordering, faults.reordering)) {
      holding_ = true;
      held_ = {frame, now + kLongestHold};
      return;
    }
    push({frame, due});
    if (hit(Draw::Doubling, faults.doubling)) push({frame, due});
    if (holding_) push({held_.frame, due});
    holding_ = false;
  }

  /// The first frame that is due, or null.
  const CanFrame* due(hal::TimeNs now) noexcept {
    if (holding_ && held_.due_ns <= now) {
      push({held_.frame, now});
      holding_ = false;
    }
    return count_ > 0 && ring_[first_].due_ns <= now ? &ring_[first_].frame : nullptr;
  }
  void pop() noexcept {
    first_ = (first_ + 1) % kCapacity;
    --count_;
  }
  void clear() noexcept {
    count_ = 0;
    holding_ = false;
  }
  bool has_room() const noexcept { return count_ + 4 <= kCapacity; }

 private:
  static constexpr std::size_t kCapacity = 2048;
  struct Delayed {
    CanFrame frame;
    hal::TimeNs due_ns = 0;
  };
  void push(const Delayed& delayed) noexcept {
    ring_[(first_ + count_) % kCapacity] = delayed;
    ++count_;
  }

  std::uint64_t direction_;
  std::array<Delayed, kCapacity> ring_{};
  std::size_t first_ = 0;
  std::size_t count_ = 0;
  std::uint64_t number_ = 0;
  hal::TimeNs last_due_ns_ = 0;
  bool holding_ = false;
  Delayed held_;
};

FaultyCanLink::FaultyCanLink(std::unique_ptr<CanLink> inner, const CanFaults& faults, Clock clock)
    : inner_(std::move(inner)),
      faults_(faults),
      clock_(std::move(clock)),
      start_ns_(clock_()),
      out_(std::make_unique<Way>(0)),
      in_(std::make_unique<Way>(1)) {}

FaultyCanLink::~FaultyCanLink() = default;

bool FaultyCanLink::off_at(hal::TimeNs now) const noexcept {
  if (faults_.bus_off <= 0.0 || faults_.bus_off_slot_ns <= 0) return false;
  const auto slot = static_cast<std::uint64_t>((now - start_ns_) / faults_.bus_off_slot_ns);
  return draw(faults_.seed, Draw::BusOff, 0, slot) < faults_.bus_off;
}

void FaultyCanLink::move(hal::TimeNs now) noexcept {
  const bool off = off_at(now);
  if (record_.state() != BusState::Gone) record_.become(off ? BusState::BusOff : inner_->state());
  if (off) out_->clear();
  while (const CanFrame* frame = out_->due(now)) {
    if (inner_->send(*frame) == Sent::Full) break;
    out_->pop();
  }
  CanFrame frame;
  while (in_->has_room() && inner_->receive(frame)) {
    if (!off) in_->put(faults_, frame, frame.at_ns);
  }
  if (off) in_->clear();
}

Sent FaultyCanLink::send(const CanFrame& frame) noexcept {
  const hal::TimeNs now = clock_();
  move(now);
  if (!frame.valid() || !can_pass(record_.state())) {
    ++record_.counts.refused;
    return Sent::Refused;
  }
  if (!out_->has_room()) {
    ++record_.counts.full;
    return Sent::Full;
  }
  ++record_.counts.frames_out;
  out_->put(faults_, frame, now);
  move(now);
  return Sent::Taken;
}

bool FaultyCanLink::receive(CanFrame& frame) noexcept {
  const hal::TimeNs now = clock_();
  move(now);
  const CanFrame* due = in_->due(now);
  if (due == nullptr) return false;
  frame = *due;
  in_->pop();
  ++record_.counts.frames_in;
  return true;
}

bool FaultyCanLink::wait(hal::TimeNs timeout_ns) noexcept {
  move(clock_());
  if (in_->due(clock_()) != nullptr) return true;
  // Frames that are only late, or held back, wake nobody.
  const hal::TimeNs slice = std::min(timeout_ns, 2 * hal::kNsPerMs);
  for (hal::TimeNs waited = 0;; waited += std::max<hal::TimeNs>(slice, 1)) {
    inner_->wait(slice);
    move(clock_());
    if (in_->due(clock_()) != nullptr) return true;
    if (waited + slice >= timeout_ns) return false;
  }
}

BusState FaultyCanLink::state() const noexcept {
  if (record_.state() == BusState::Gone) return BusState::Gone;
  return off_at(clock_()) ? BusState::BusOff : inner_->state();
}

}  // namespace tandem::bridges
