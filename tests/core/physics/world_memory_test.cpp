// Memory that is written and read, block by block.
#include "core/physics/world_memory.hpp"

#include <array>
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

/// A block that knows another, a function of this program, and something on the stack.
struct Linked {
  Linked* next = nullptr;
  int (*call)() = nullptr;
  const int* elsewhere = nullptr;
  std::array<char, 300> bytes{};
};
int seven() {
  return 7;
}

TEST(WorldMemory, IsReadHereAndElsewhereWithItsAddresses) {
  WorldMemory memory;
  const int on_the_stack = 1;
  auto* first = new (memory.allocate(sizeof(Linked))) Linked;
  first->next = new (memory.allocate(200'000)) Linked;
  first->next->next = first;
  first->next->call = &seven;
  first->elsewhere = &on_the_stack;
  first->bytes.fill('a');
  memory.free(memory.allocate(100));
  hal::Archive writer;
  ASSERT_TRUE(memory.remember(writer, first));
  const auto apart = static_cast<std::byte*>(memory.allocate(100)) - reinterpret_cast<std::byte*>(first);

  WorldMemory other;
  (void)other.allocate(50'000);
  for (WorldMemory* into : {&memory, &other}) {
    for (int i = 0; i < 1000; ++i) std::memset(into->allocate(300), 2, 300);
    Linked* read = nullptr;
    hal::Archive reader(writer.bytes());
    ASSERT_TRUE(into->remember(reader, read));
    EXPECT_TRUE(reader.at_end());
    EXPECT_EQ(into->blocks(), 2U);
    EXPECT_EQ(read->next->next, read);
    EXPECT_EQ(read->next->call(), 7);
    EXPECT_EQ(read->elsewhere, &on_the_stack);  // in this process
    EXPECT_EQ(read->bytes.back(), 'a');
    // What is given out next lies as it did.
    EXPECT_EQ(static_cast<std::byte*>(into->allocate(100)) - reinterpret_cast<std::byte*>(read), apart);
  }
}

TEST(WorldMemory, BytesThatAreNoneOfItsAreRefused) {
  WorldMemory memory;
  void* block = memory.allocate(100);
  hal::Archive writer;
  ASSERT_TRUE(memory.remember(writer, block));
  for (std::size_t size = 0; size < writer.bytes().size(); size += 7) {
    WorldMemory other;
    hal::Archive reader(std::string_view(writer.bytes()).substr(0, size));
    EXPECT_FALSE(other.remember(reader, block)) << size;
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
