#include "tests/mixed_reality/time/allocations.hpp"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {
std::atomic<std::size_t> allocations{0};
}

// In a file of their own, so that no caller can inline one of the pair and not the other.
void* operator new(std::size_t size) {
  ++allocations;
  if (void* p = std::malloc(size == 0 ? 1 : size)) return p;
  throw std::bad_alloc();
}
void operator delete(void* p) noexcept {
  std::free(p);
}
void operator delete(void* p, std::size_t) noexcept {
  std::free(p);
}

namespace tandem::mixed_reality {
std::size_t allocation_count() noexcept {
  return allocations;
}
}  // namespace tandem::mixed_reality
