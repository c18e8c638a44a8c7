// Memory of one interpreter: small blocks by size out of large ones, so that a step seldom asks the system for any; and
// the account of the robot whose call it is.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "controllers/lua_controller/limits.hpp"

namespace tandem::controllers::lua {

/// What a robot has been charged. A charge is for what the robot's script makes, wherever and beside whom it runs: not
/// for short texts, which all share, nor for the stack of the interpreter.
struct Account {
  std::uint64_t charged = 0;     ///< bytes since it was measured what the robot keeps
  std::uint64_t measure_at = 0;  ///< when `charged` is that, it is measured again
};

/// Blocks of up to kSmall bytes come from lists of free ones, larger ones from the system. What is freed is kept for
/// the same interpreter. Not thread-safe.
class Memory {
 public:
  explicit Memory(Steps& steps) : steps_(steps) {}
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;

  /// As lua_Alloc wants it: `self` is the Memory.
  static void* allocate(void* self, void* block, std::size_t old_size, std::size_t size) noexcept;
  std::size_t in_use() const noexcept { return in_use_; }

  /// Number of a table among all that were made, in their order; 0: there is no room for it.
  static std::uint64_t number_of(const void* table) noexcept;

  /// Where the next small block comes from, unless one is free.
  const std::byte* next() const noexcept { return next_; }

  /// What was allocated until now, its stack and its table of texts, is the interpreter's own, also when it grows.
  void state_is_made() noexcept { making_state_ = false; }

  /// From here on `account` is charged, until null; a call may allocate `most` bytes.
  void charge_to(Account* account, std::uint64_t most) noexcept {
    account_ = account;
    call_left_ = most;
  }
  Account* suspend_account() noexcept { return std::exchange(account_, nullptr); }
  void resume_account(Account* account) noexcept { account_ = account; }
  /// Whether the interpreter's own stack is used, not a coroutine's.
  void set_on_main(bool on_main) noexcept { on_main_ = on_main; }
  /// Readings are charged by objects: the lists that they stand in are the interpreter's.
  void set_filling(bool filling) noexcept { filling_ = filling; }

  /// Whether garbage is to be collected; the steps are interrupted when that begins.
  bool collection_due() const noexcept { return in_use_ >= collect_at_; }
  void collected() noexcept;

 private:
  static constexpr std::size_t kGrain = 16;
  static constexpr std::size_t kSmall = 1024;
  // Of a table of Lua 5.4. On machines of 64 bits its block is larger: behind it is room for its number.
  static constexpr std::size_t kTableBytes = 8 + 6 * sizeof(void*);
  static constexpr bool kNumbered = kTableBytes % kGrain != 0 && kGrain - kTableBytes % kGrain >= sizeof(std::uint64_t);
  static constexpr std::size_t kChunk = std::size_t{64} << 10;
  struct Free {
    Free* next;
  };

  static constexpr bool is_small(std::size_t size) noexcept { return size <= kSmall; }
  static constexpr std::size_t list_of(std::size_t size) noexcept { return (size + kGrain - 1) / kGrain; }
  void* change(void* block, std::size_t old_size, std::size_t size) noexcept;
  void* take(std::size_t size) noexcept;
  void give(void* block, std::size_t size) noexcept;
  std::size_t price_of_new(std::size_t tag, std::size_t size) const noexcept;
  bool charge(std::size_t bytes) noexcept;

  Steps& steps_;
  std::array<Free*, kSmall / kGrain + 1> free_{};
  std::vector<std::unique_ptr<std::byte[]>> chunks_;
  std::byte* next_ = nullptr;  // of the newest chunk
  std::size_t left_ = 0;
  std::size_t in_use_ = 0;
  std::size_t collect_at_ = SIZE_MAX;
  std::uint64_t tables_ = 0;  // that were made

  Account* account_ = nullptr;
  std::uint64_t call_left_ = 0;
  bool on_main_ = true, filling_ = false, making_state_ = true;
  std::array<void*, 8> of_state_{};  // blocks of the interpreter's own
};

}  // namespace tandem::controllers::lua
