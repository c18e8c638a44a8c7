#include "controllers/lua_controller/memory.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <new>

namespace tandem::controllers::lua {

void* Memory::allocate(void* self, void* block, std::size_t old_size, std::size_t size) noexcept {
  Memory& memory = *static_cast<Memory*>(self);
  if (block == nullptr) old_size = 0;  // then it tells what the block is for
  if (size == 0) {
    if (block != nullptr) memory.give(block, old_size);
    return nullptr;
  }
  if (size > old_size && memory.in_use_ + (size - old_size) > kMost) return nullptr;
  if (block != nullptr && is_small(old_size) && is_small(size) && list_of(old_size) == list_of(size)) {
    memory.in_use_ += size - old_size;
    return block;
  }
  if (block != nullptr && !is_small(old_size) && !is_small(size)) {
    void* const moved = std::realloc(block, size);
    if (moved != nullptr) memory.in_use_ += size - old_size;
    return moved;
  }
  void* const made = memory.take(size);
  if (made == nullptr || block == nullptr) return made;
  std::memcpy(made, block, std::min(old_size, size));
  memory.give(block, old_size);
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
