// Common part of byte links on a descriptor.
#pragma once
#include <atomic>
#include <sys/types.h>

#include "bridges/link/link.hpp"

namespace tandem::bridges {

/// A link whose descriptor does not block; derived classes close it.
class DescriptorLink : public ByteLink {
 public:
  std::size_t write(std::span<const std::uint8_t> bytes, hal::TimeNs budget_ns) noexcept final;
  bool wait(hal::TimeNs timeout_ns) noexcept final { return wait_for_input(open_ ? descriptor_ : -1, timeout_ns); }
  int descriptor() const noexcept final { return descriptor_; }
  LinkState state() const noexcept final { return open_ ? LinkState::Open : LinkState::HungUp; }
  LinkStatistics statistics() const noexcept final { return {bytes_in_, bytes_out_, bytes_refused_, errors_}; }

 protected:
  explicit DescriptorLink(int descriptor) : descriptor_(descriptor) {}
  /// As the system's call, with its errno.
  virtual ssize_t put(std::span<const std::uint8_t> bytes) noexcept = 0;
  /// What a call of the system that gave `size` bytes has read.
  Received received(ssize_t size) noexcept {
    bytes_in_ += static_cast<std::uint64_t>(size);
    return {static_cast<std::size_t>(size), monotonic_ns()};
  }
  void hang_up() noexcept {
    if (open_.exchange(false)) ++errors_;
  }

  int descriptor_;
  std::atomic<bool> open_{true};

 private:
  std::atomic<std::uint64_t> bytes_in_{0}, bytes_out_{0}, bytes_refused_{0}, errors_{0};
};

}  // namespace tandem::bridges
