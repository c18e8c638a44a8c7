// Memory that goes back to an earlier moment, block by block and at the same addresses.
#include "core/physics/world_memory.hpp"

#include <cstring>
#include <gtest/gtest.h>
#include <map>
#include <random>

namespace tandem::core {
namespace {

TEST(WorldMemory, GivesEveryBlockItsOwnBytesWhateverTheSizes) {
  WorldMemory memory;
  std::mt19937 random(1);
  std::map<std::byte*, std::pair<std::size_t, std::byte>> held;
  for (int i = 0; i < 20000; ++i) {
    if (held.size() < 300 || random() % 2 == 0) {
      const std::size_t bytes = random() % 50 == 0 ? random() % 300000 : random() % 600;
      auto* block = static_cast<std::byte*>(memory.allocate(bytes));
      ASSERT_EQ(reinterpret_cast<std::uintptr_t>(block) % 16, 0U);
      const auto mark = static_cast<std::byte>(random() % 256);
      std::fill_n(block, bytes, mark);
      ASSERT_TRUE(held.emplace(block, std::pair{bytes, mark}).second);
    } else {
      const auto some = std::next(held.begin(), static_cast<std::ptrdiff_t>(random() % held.size()));
      for (std::size_t k = 0; k < some->second.first; ++k) ASSERT_EQ(some->first[k], some->second.second);
      memory.free(some->first);
      held.erase(some);
    }
  }
  EXPECT_EQ(memory.blocks(), held.size());
}

TEST(WorldMemory, GoesBackToWhatItWasAndOnFromThere) {
  WorldMemory memory;
  std::vector<void*> blocks;
  for (const std::size_t bytes : {16UL, 100UL, 5000UL, 40000UL, 200000UL}) {
    blocks.push_back(memory.allocate(bytes));
    std::memset(blocks.back(), 1, bytes);
  }
  memory.free(blocks[1]);
  const auto image = memory.copy();
  void* const next = memory.allocate(100);
  for (int time = 0; time < 3; ++time) {
    for (const std::size_t i : {0UL, 2UL, 3UL, 4UL}) memory.free(blocks[i]);
    for (int i = 0; i < 1000; ++i) std::memset(memory.allocate(300), 2, 300);
    std::memset(memory.allocate(190000), 2, 190000);
    memory.put_back(*image);
    EXPECT_EQ(memory.blocks(), 4U);
    EXPECT_EQ(*static_cast<char*>(blocks[0]), 1);
    EXPECT_EQ(static_cast<char*>(blocks[3])[39999], 1);
    EXPECT_EQ(static_cast<char*>(blocks[4])[199999], 1);
    EXPECT_EQ(memory.allocate(100), next);  // what is given out next is the same, too
  }
}

TEST(WorldMemory, IsUsedByTheThreadThatSaysSo) {
  WorldMemory memory;
  {
    const WorldMemory::Use use(&memory);
    void* const block = WorldMemory::allocate_in_use(10);
    EXPECT_EQ(memory.blocks(), 1U);
    {
      const WorldMemory::Use heap(nullptr);
      WorldMemory::free_in_use(WorldMemory::allocate_in_use(10));
      EXPECT_EQ(memory.blocks(), 1U);
    }
    WorldMemory::free_in_use(block);
    EXPECT_EQ(memory.blocks(), 0U);
  }
  WorldMemory::free_in_use(WorldMemory::allocate_in_use(10));
  EXPECT_EQ(memory.blocks(), 0U);
}

}  // namespace
}  // namespace tandem::core
