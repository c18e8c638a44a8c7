// Permission to speak to robots: whose turn it is, the hub's or its guardian's, and whether the hub itself was awake.
#pragma once
#include <atomic>
#include <cstdint>

#include "hal/boottime.hpp"

namespace tandem::bridges {

/// The last beat of a hub's heart, for its own threads: one that wakes up before the heart does finds it too old.
struct HeartStamp {
  const std::atomic<std::uint32_t>* beat_ms = nullptr;  ///< `hal::boottime_ms`; 0: no heart beats, or none has to
  std::uint32_t oldest_ms = 0;

  bool fresh() const noexcept {
    const std::uint32_t beat = beat_ms == nullptr ? 0 : beat_ms->load(std::memory_order_acquire);
    // Signed: the heart may have beaten between the two readings.
    return beat == 0 || static_cast<std::int32_t>(hal::boottime_ms() - beat) <= static_cast<std::int32_t>(oldest_ms);
  }
};

/// A hub that its guardian has declared dead may not write to any robot until its guardian has handed back. Nor may one
/// that was frozen together with its guardian: not before its heart has noticed, and then not to links that were open.
/// Every link asks before each write. Copies refer to the same numbers, which their owner must keep alive.
class SendPermit {
 public:
  /// Always granted: there is no guardian.
  constexpr SendPermit() noexcept = default;
  /// `turn` is even while it is the hub's turn, odd while it is the guardian's, and grows with each change.
  explicit SendPermit(const std::atomic<std::uint32_t>& turn, HeartStamp heart = {}) noexcept
      : turn_(&turn), heart_(heart) {}

  bool real() const noexcept { return turn_ != nullptr; }
  std::uint32_t turn() const noexcept { return turn_ == nullptr ? 0 : turn_->load(std::memory_order_acquire); }
  bool granted() const noexcept { return turn() % 2 == 0 && heart_.fresh(); }
  /// Whether it has been granted without a break since it was `turn`: a link that was opened then may still be used.
  bool granted_since(std::uint32_t turn) const noexcept {
    return turn % 2 == 0 && heart_.fresh() && this->turn() == turn;
  }

 private:
  const std::atomic<std::uint32_t>* turn_ = nullptr;
  HeartStamp heart_;
};

}  // namespace tandem::bridges
