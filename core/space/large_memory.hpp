// Memory for arrays that are streamed every tick. Where it is large it lies in huge pages: at a million robots address
// translation otherwise costs a seventh of the step.
#pragma once
#include <cstddef>
#include <memory>
#include <new>
#include <vector>

namespace tandem::core {

/// Memory of `size` bytes, aligned to `align` or better, in huge pages where it is large and the kernel gives them
/// [madvise(2), MADV_HUGEPAGE]. Not zeroed. Given back with `free_large` and the same numbers.
/// @throws std::bad_alloc
void* allocate_large(std::size_t size, std::size_t align);
void free_large(void* p, std::size_t size, std::size_t align) noexcept;

/// Allocator of standard containers over the same.
template <class T>
struct LargeAllocator {
  using value_type = T;
  LargeAllocator() = default;
  template <class U>
  LargeAllocator(const LargeAllocator<U>&) noexcept {}
  T* allocate(std::size_t n) { return static_cast<T*>(allocate_large(n * sizeof(T), alignof(T))); }
  void deallocate(T* p, std::size_t n) noexcept { free_large(p, n * sizeof(T), alignof(T)); }
  template <class U>
  bool operator==(const LargeAllocator<U>&) const noexcept {
    return true;
  }
};

template <class T>
using LargeVector = std::vector<T, LargeAllocator<T>>;

/// Many small arrays side by side in large pieces of memory. What it gave lives as long as the slab.
class Slab {
 public:
  /// Zeroed. `align` is a power of two.
  std::byte* take(std::size_t size, std::size_t align);
  /// That it holds, given out or not.
  std::size_t bytes() const noexcept;

 private:
  struct Free {
    std::size_t size;
    void operator()(std::byte* p) const noexcept;
  };
  std::vector<std::unique_ptr<std::byte, Free>> pieces_;
  std::byte* next_ = nullptr;
  std::size_t left_ = 0;
};

}  // namespace tandem::core
