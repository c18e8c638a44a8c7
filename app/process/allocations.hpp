// Counts the whole process' allocations by `new`, plug-ins included.
#pragma once
#include <cstdint>
#include <optional>

namespace tandem::app {

/// Counts from its construction on, on all threads. One at a time.
class AllocationCount {
 public:
  AllocationCount() noexcept;
  ~AllocationCount();
  AllocationCount(const AllocationCount&) = delete;
  AllocationCount& operator=(const AllocationCount&) = delete;

  /// Nothing: this build cannot tell, because its sanitizer has a heap of its own.
  std::optional<std::uint64_t> count() const noexcept;
};

}  // namespace tandem::app
