// Permission to speak to robots: whose turn it is, the hub's or its guardian's.
#pragma once
#include <atomic>
#include <cstdint>

namespace tandem::bridges {

/// A hub that its guardian has declared dead may not write to any robot until its guardian has handed back. Every link
/// asks before each write. Copies refer to the same number, which its owner must keep alive.
class SendPermit {
 public:
  /// Always granted: there is no guardian.
  constexpr SendPermit() noexcept = default;
  /// `turn` is even while it is the hub's turn, odd while it is the guardian's, and grows with each change.
  explicit SendPermit(const std::atomic<std::uint32_t>& turn) noexcept : turn_(&turn) {}

  bool real() const noexcept { return turn_ != nullptr; }
  std::uint32_t turn() const noexcept { return turn_ == nullptr ? 0 : turn_->load(std::memory_order_acquire); }
  bool granted() const noexcept { return turn() % 2 == 0; }
  /// Whether it has been granted without a break since it was `turn`: a link that was opened then may still be used.
  bool granted_since(std::uint32_t turn) const noexcept { return turn % 2 == 0 && this->turn() == turn; }

 private:
  const std::atomic<std::uint32_t>* turn_ = nullptr;
};

}  // namespace tandem::bridges
