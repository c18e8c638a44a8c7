// Memory of one interpreter: small blocks by size out of large ones, so that a step seldom asks the system for any.
#pragma once
#include <array>
#include <cstddef>
#include <memory>
#include <vector>

namespace tandem::controllers::lua {

/// Blocks of up to kSmall bytes come from lists of free ones, larger ones from the system. What is freed is kept for
/// the same interpreter. Not thread-safe.
class Memory {
 public:
  static constexpr std::size_t kMost = std::size_t{256} << 20;  ///< bytes in use; beyond, scripts run out of memory

  Memory() = default;
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;

  /// As lua_Alloc wants it: `self` is the Memory.
  static void* allocate(void* self, void* block, std::size_t old_size, std::size_t size) noexcept;
  std::size_t in_use() const noexcept { return in_use_; }

 private:
  static constexpr std::size_t kGrain = 16;
  static constexpr std::size_t kSmall = 1024;
  static constexpr std::size_t kChunk = std::size_t{64} << 10;
  struct Free {
    Free* next;
  };

  static constexpr bool is_small(std::size_t size) noexcept { return size <= kSmall; }
  static constexpr std::size_t list_of(std::size_t size) noexcept { return (size + kGrain - 1) / kGrain; }
  void* take(std::size_t size) noexcept;
  void give(void* block, std::size_t size) noexcept;

  std::array<Free*, kSmall / kGrain + 1> free_{};
  std::vector<std::unique_ptr<std::byte[]>> chunks_;
  std::byte* next_ = nullptr;  // of the newest chunk
  std::size_t left_ = 0;
  std::size_t in_use_ = 0;
};

}  // namespace tandem::controllers::lua
