// Memory that hub and guardian share: the heartbeat of each, and whose turn it is to speak to robots.
#pragma once
#include <atomic>
#include <cstdint>

namespace tandem::bridges::guardian {

/// 32 bits each: those are atomic between processes on every processor that Tandem runs on.
struct SharedPage {
  std::atomic<std::uint32_t> beats{0};           ///< written by the hub
  std::atomic<std::uint32_t> guardian_beats{0};  ///< written by the guardian
  std::atomic<std::uint32_t> hub_beat_ms{0};     ///< when the hub's heart beat last (`hal::boottime_ms`); 0: never
  std::atomic<std::uint32_t> turn{0};            ///< see `SendPermit`; written by both

  /// The guardian's turn from now on; a new one, if it was the guardian's before.
  void take_turn() noexcept {
    std::uint32_t now = turn.load(std::memory_order_relaxed);
    while (!turn.compare_exchange_weak(now, now + 1 + now % 2, std::memory_order_acq_rel)) {
    }
  }
  /// The hub's turn again, if it is still the guardian's turn that was `seen`: one that the guardian took since stays.
  void give_turn(std::uint32_t seen) noexcept {
    if (seen % 2 == 1) turn.compare_exchange_strong(seen, seen + 1, std::memory_order_acq_rel);
  }
  /// It stays the hub's turn, but no link that was opened before may be written to.
  void withdraw_links() noexcept {
    std::uint32_t now = turn.load(std::memory_order_relaxed);
    while (now % 2 == 0 && !turn.compare_exchange_weak(now, now + 2, std::memory_order_acq_rel)) {
    }
  }
};

}  // namespace tandem::bridges::guardian
