#include "core/physics/world_memory.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <new>
#include <utility>

namespace tandem::core {
namespace {

constexpr std::size_t kHeader = 16;  // before every block: its class, or which large one it is
constexpr std::size_t kLargestShared = std::size_t{1} << 15;
constexpr std::size_t kFirstChunk = std::size_t{1} << 16;
constexpr std::size_t kLargestChunk = std::size_t{1} << 20;
constexpr std::size_t kPage = 4096;
constexpr std::uint64_t kLarge = std::uint64_t{1} << 63;

/// Sizes rise by 16 bytes up to 128, and then by an eighth of the power of two below.
constexpr std::size_t class_of(std::size_t bytes) noexcept {
  if (bytes <= 128) return (std::max<std::size_t>(bytes, 1) - 1) / 16;
  const auto power = static_cast<std::size_t>(std::bit_width(bytes - 1)) - 1;
  return 8 + 8 * (power - 7) + ((bytes - 1 - (std::size_t{1} << power)) >> (power - 3));
}

constexpr std::size_t size_of(std::size_t size_class) noexcept {
  if (size_class < 8) return 16 * (size_class + 1);
  const std::size_t power = 7 + (size_class - 8) / 8;
  return (std::size_t{1} << power) + ((size_class - 8) % 8 + 1) * (std::size_t{1} << (power - 3));
}

thread_local WorldMemory* in_use = nullptr;

void write(void* at, std::uint64_t value) noexcept {
  std::memcpy(at, &value, sizeof value);
}

std::byte* before(void* block) noexcept {
  return static_cast<std::byte*>(block) - kHeader;
}

}  // namespace

std::size_t WorldMemory::size_of_class(std::size_t size_class) noexcept {
  return size_of(size_class);
}

void* WorldMemory::carve(std::size_t bytes) {
  while (filling_ < shared_.size() && shared_[filling_].size - shared_[filling_].used < bytes) ++filling_;
  if (filling_ == shared_.size()) {
    const std::size_t size = std::min(kFirstChunk << std::min<std::size_t>(filling_, 8), kLargestChunk);
    shared_.push_back({room(size), size, 0});
  }
  Chunk& chunk = shared_[filling_];
  return chunk.bytes.get() + std::exchange(chunk.used, chunk.used + bytes);
}

WorldMemory::Room WorldMemory::room(std::size_t size) {
  auto* const bytes = static_cast<std::byte*>(std::calloc(size, 1));
  if (bytes == nullptr) throw std::bad_alloc();
  return Room(bytes);
}

void* WorldMemory::allocate(std::size_t bytes) {
  ++blocks_;
  if (bytes <= kLargestShared) {
    const std::size_t size_class = class_of(bytes);
    if (void* block = unused_[size_class]; block != nullptr) {
      std::memcpy(&unused_[size_class], block, sizeof block);
      return block;
    }
    void* header = carve(kHeader + size_of(size_class));
    write(header, size_class);
    return static_cast<std::byte*>(header) + kHeader;
  }
  const std::size_t wanted = kHeader + bytes;
  auto fit = std::find_if(large_.begin(), large_.end(), [wanted](const Chunk& chunk) {
    return chunk.used == 0 && chunk.size >= wanted && chunk.size <= 2 * wanted;
  });
  if (fit == large_.end()) {
    const std::size_t size = (wanted + kPage - 1) / kPage * kPage;
    auto made = room(size);
    fit = std::find_if(large_.begin(), large_.end(), [](const Chunk& chunk) { return chunk.bytes == nullptr; });
    if (fit == large_.end()) fit = large_.insert(fit, Chunk{});
    *fit = {std::move(made), size, 0};
  }
  fit->used = wanted;
  write(fit->bytes.get(), kLarge | static_cast<std::uint64_t>(fit - large_.begin()));
  return fit->bytes.get() + kHeader;
}

void WorldMemory::free(void* block) noexcept {
  if (block == nullptr) return;
  --blocks_;
  std::uint64_t what = 0;
  std::memcpy(&what, before(block), sizeof what);
  if ((what & kLarge) != 0) {
    Chunk& chunk = large_[what & ~kLarge];
    chunk = {};
    return;
  }
  std::memcpy(block, &unused_[what], sizeof block);
  unused_[what] = block;
}

void WorldMemory::clear() noexcept {
  for (auto* chunks : {&shared_, &large_}) {
    for (Chunk& chunk : *chunks) chunk.used = 0;
  }
  filling_ = 0;
  blocks_ = 0;
  unused_.fill(nullptr);
}

WorldMemory::Use::Use(WorldMemory* memory) noexcept : before_(std::exchange(in_use, memory)) {}

WorldMemory::Use::~Use() {
  in_use = before_;
}

void* WorldMemory::allocate_in_use(std::size_t bytes) {
  return in_use != nullptr ? in_use->allocate(bytes) : std::malloc(bytes);
}

void WorldMemory::free_in_use(void* block) noexcept {
  if (in_use != nullptr)
    in_use->free(block);
  else
    std::free(block);
}

}  // namespace tandem::core
