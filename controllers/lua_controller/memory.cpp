#include "controllers/lua_controller/memory.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <new>

#include "controllers/lua_controller/lua.hpp"

namespace tandem::controllers::lua {

namespace {

// Sizes in Lua 5.4: of a short text with its header, and of what it remembers of a call.
constexpr std::size_t kLongestShortText = 2 * sizeof(void*) + 8 + 40 + 1;
constexpr std::size_t kCallInfo = 7 * sizeof(void*) + 8;
constexpr std::size_t kAlways = 4096;  // granted to a call that has had its memory: it needs some to end
constexpr std::size_t kBytesAStep = 64;
constexpr std::size_t kLeastGarbage = std::size_t{256} << 10;

}  // namespace

void* Memory::allocate(void* self, void* block, std::size_t old_size, std::size_t size) noexcept {
  Memory& memory = *static_cast<Memory*>(self);
  const std::size_t tag = block == nullptr ? old_size : 0;  // then it tells what the block is for
  if (block == nullptr) old_size = 0;
  if (size == 0) {
    if (block != nullptr) memory.give(block, old_size);
    return nullptr;
  }
  void** of_state = nullptr;
  if (block != nullptr || memory.making_state_) {
    for (void*& own : memory.of_state_) {
      if (own != block || (own == nullptr && tag != 0)) continue;
      of_state = &own;
      break;
    }
  }
  if (memory.account_ != nullptr && of_state == nullptr && size > old_size) {
    const std::size_t price = block == nullptr ? memory.price_of_new(tag, size) : memory.filling_ ? 0 : size - old_size;
    if (price > 0 && !memory.charge(price)) return nullptr;
  }
  void* const made = memory.change(block, old_size, size);
  if constexpr (kNumbered) {
    if (tag == LUA_TTABLE && size == kTableBytes && made != nullptr) {
      ++memory.tables_;
      std::memcpy(static_cast<std::byte*>(made) + kTableBytes, &memory.tables_, sizeof memory.tables_);
    }
  }
  if (of_state != nullptr && made != nullptr) *of_state = made;
  if (memory.in_use_ >= memory.collect_at_) memory.steps_.interrupt();
  return made;
}

std::uint64_t Memory::number_of(const void* table) noexcept {
  std::uint64_t number = 0;
  if constexpr (kNumbered) std::memcpy(&number, static_cast<const std::byte*>(table) + kTableBytes, sizeof number);
  return number;
}

/// What a new block costs the robot. Short texts are shared by all robots of the interpreter, so who makes one first is
/// chance; and what is remembered of calls is kept for the next.
std::size_t Memory::price_of_new(std::size_t tag, std::size_t size) const noexcept {
  if (tag == LUA_TSTRING) return size > kLongestShortText ? size : 0;
  if (filling_) return tag != 0 ? 2 * size : 0;
  return tag == 0 && on_main_ && size == kCallInfo ? 0 : size;
}

/// False: the call has had all its memory.
bool Memory::charge(std::size_t bytes) noexcept {
  if (bytes > call_left_) {
    if (steps_.over == Steps::Over::No) steps_.over = Steps::Over::Memory;
    steps_.interrupt();
    return bytes <= kAlways;
  }
  call_left_ -= bytes;
  account_->charged += bytes;
  steps_.left -= static_cast<std::int64_t>(bytes / kBytesAStep);
  return true;
}

void Memory::collected() noexcept {
  collect_at_ = in_use_ + std::max(in_use_, kLeastGarbage);
}

void* Memory::change(void* block, std::size_t old_size, std::size_t size) noexcept {
  if (block != nullptr && is_small(old_size) && is_small(size) && list_of(old_size) == list_of(size)) {
    in_use_ += size - old_size;
    return block;
  }
  if (block != nullptr && !is_small(old_size) && !is_small(size)) {
    void* const moved = std::realloc(block, size);
    if (moved != nullptr) in_use_ += size - old_size;
    return moved;
  }
  void* const made = take(size);
  if (made == nullptr || block == nullptr) return made;
  std::memcpy(made, block, std::min(old_size, size));
  give(block, old_size);
  return made;
}

void* Memory::take(std::size_t size) noexcept {
  void* made = nullptr;
  if (!is_small(size)) {
    made = std::malloc(size);
  } else if (Free*& list = free_[list_of(size)]; list != nullptr) {
    made = list;
    list = list->next;
  } else {
    const std::size_t bytes = list_of(size) * kGrain;
    if (left_ < bytes) {
      std::unique_ptr<std::byte[]> chunk(new (std::nothrow) std::byte[kChunk]);
      if (chunk == nullptr) return nullptr;
      next_ = chunk.get();
      left_ = kChunk;
      try {
        chunks_.push_back(std::move(chunk));
      } catch (const std::bad_alloc&) {
        left_ = 0;
        return nullptr;
      }
    }
    made = next_;
    next_ += bytes;
    left_ -= bytes;
  }
  if (made != nullptr) in_use_ += size;
  return made;
}

void Memory::give(void* block, std::size_t size) noexcept {
  in_use_ -= size;
  if (!is_small(size)) return std::free(block);
  Free*& list = free_[list_of(size)];
  list = ::new (block) Free{list};
}

}  // namespace tandem::controllers::lua
