// For builds with a sanitizer, whose heap is not to be replaced.
#include "app/process/allocations.hpp"

namespace tandem::app {

AllocationCount::AllocationCount() noexcept = default;
AllocationCount::~AllocationCount() = default;

std::optional<std::uint64_t> AllocationCount::count() const noexcept {
  return std::nullopt;
}

}  // namespace tandem::app
