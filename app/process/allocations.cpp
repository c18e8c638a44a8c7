#include "app/process/allocations.hpp"

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace {

std::atomic<bool> counting{false};
std::atomic<std::uint64_t> counted{0};

void* taken(std::size_t size, std::size_t align) {
  if (counting.load(std::memory_order_relaxed)) counted.fetch_add(1, std::memory_order_relaxed);
  for (;;) {
    void* const p = align > alignof(std::max_align_t) ? std::aligned_alloc(align, (size + align - 1) / align * align)
                                                      : std::malloc(size == 0 ? 1 : size);
    if (p != nullptr) return p;
    const std::new_handler handler = std::get_new_handler();
    if (handler == nullptr) throw std::bad_alloc();
    handler();
  }
}

}  // namespace

namespace tandem::app {

AllocationCount::AllocationCount() noexcept {
  counted = 0;
  counting = true;
}

AllocationCount::~AllocationCount() {
  counting = false;
}

std::optional<std::uint64_t> AllocationCount::count() const noexcept {
  return counted.load(std::memory_order_relaxed);
}

}  // namespace tandem::app

// GCC cannot see that both sides are malloc and free.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"

void* operator new(std::size_t size) {
  return taken(size, 1);
}
void* operator new(std::size_t size, std::align_val_t align) {
  return taken(size, static_cast<std::size_t>(align));
}
void operator delete(void* p) noexcept {
  std::free(p);
}
void operator delete(void* p, std::size_t) noexcept {
  std::free(p);
}
void operator delete(void* p, std::align_val_t) noexcept {
  std::free(p);
}
void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
  std::free(p);
}
