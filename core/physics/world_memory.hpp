// Memory of the world that a physics library keeps for one solver: written and read as a whole, bit for bit.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <initializer_list>
#include <memory>
#include <vector>

#include "hal/archive.hpp"

namespace tandem::core {

/// Gives out memory that can be written and read, here or in another process. Solvers let their library take all that
/// lives between ticks from here: then a checkpoint holds the library's contacts, trees and lists without knowing what
/// they are. For one thread at a time.
class WorldMemory {
 public:
  WorldMemory() = default;
  WorldMemory(const WorldMemory&) = delete;
  WorldMemory& operator=(const WorldMemory&) = delete;

  /// Aligned for any type. Throws std::bad_alloc.
  void* allocate(std::size_t bytes);
  /// `block` is one that `allocate` gave; null is none.
  void free(void* block) noexcept;
  /// Takes everything back. What lives there ends without its destructors.
  void clear() noexcept;
  std::size_t blocks() const noexcept { return blocks_; }  ///< given out now

  /// Writes all that is given out, or reads it into this memory, which then lies elsewhere: addresses into it, and into
  /// the program and its libraries, are made anew; others are null in another process. `pointers` are those of who uses
  /// it; each is null or lies in it. False: what was read is not of this program and its libraries.
  template <class... T>
  bool remember(hal::Archive& archive, T*&... pointers) {
    return remember_all(archive, {reinterpret_cast<void**>(&pointers)...});
  }
  /// The same for more of those pointers, after that.
  template <class T>
  void remember_pointer(hal::Archive& archive, T*& pointer) const {
    remember_address(archive, *reinterpret_cast<void**>(&pointer));
  }

  /// While one lives, the libraries' allocations on this thread go to `memory`; null: to the heap.
  class Use {
   public:
    explicit Use(WorldMemory* memory) noexcept;
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;
    ~Use();

   private:
    WorldMemory* before_;
  };
  /// What a library's allocation calls on this thread: from the memory in use, or else from the heap.
  static void* allocate_in_use(std::size_t bytes);
  static void free_in_use(void* block) noexcept;

 private:
  static constexpr std::size_t kClasses = 72;  // of sizes up to kLargestShared

  /// Of the C library, not by `new`: what a library's solver takes is its own doing.
  struct Free {
    void operator()(std::byte* bytes) const noexcept { std::free(bytes); }
  };
  using Room = std::unique_ptr<std::byte[], Free>;
  static Room room(std::size_t size);
  struct Chunk {
    Room bytes;
    std::size_t size = 0;
    std::size_t used = 0;  ///< a prefix; of a chunk with one large block all of it, or nothing
  };
  /// An address in the memory that is given out: number of the chunk, first the shared ones, and offset.
  struct Place {
    std::uint32_t chunk = kNone;
    std::uint64_t offset = 0;
    static constexpr std::uint32_t kNone = 0xFFFF'FFFFU;
  };
  void* carve(std::size_t bytes);
  static std::size_t size_of_class(std::size_t size_class) noexcept;
  bool remember_all(hal::Archive& archive, std::initializer_list<void**> pointers);
  void remember_address(hal::Archive& archive, void*& address) const;
  void write_words(hal::Archive& archive) const;
  bool read_words(hal::Archive& archive);
  std::vector<std::vector<std::uint64_t>> live_words() const;
  std::size_t chunks() const noexcept { return shared_.size() + large_.size(); }
  const Chunk& chunk(std::size_t i) const noexcept {
    return i < shared_.size() ? shared_[i] : large_[i - shared_.size()];
  }
  Place place_of(std::uint64_t address) const noexcept;
  std::uint64_t address_of(const Place& place) const noexcept;

  std::vector<Chunk> shared_;  // cut into small blocks, one after the other
  std::vector<Chunk> large_;   // one block each; without bytes where the block was given back to the heap
  std::size_t filling_ = 0;    // index of the shared chunk that is cut at present
  std::size_t blocks_ = 0;
  std::array<void*, kClasses> unused_{};  // by class of size: blocks that were freed, linked by their first bytes
};

}  // namespace tandem::core
