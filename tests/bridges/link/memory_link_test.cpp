#include "tests/bridges/link/memory_link.hpp"

#include <array>
#include <gtest/gtest.h>
#include <thread>
#include <vector>

#include "bridges/link/pending_link.hpp"

namespace tandem::bridges {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes read_all(ByteLink& link) {
  Bytes all;
  std::array<std::uint8_t, 3> buffer;
  for (Received r = link.read(buffer); r.size > 0; r = link.read(buffer))
    all.insert(all.end(), buffer.begin(), buffer.begin() + r.size);
  return all;
}

TEST(MemoryLink, CarriesBytesInOrderAndStampsThemWhenWritten) {
  hal::TimeNs now = 5;
  auto [a, b] = MemoryLink::make_pair([&] { return now; });
  EXPECT_EQ(a->write(Bytes{1, 2, 3}, 0), 3U);
  now = 9;
  EXPECT_EQ(a->write(Bytes{4}, 0), 1U);
  now = 100;
  std::array<std::uint8_t, 8> buffer;
  Received first = b->read(buffer);
  EXPECT_EQ(first.size, 3U);
  EXPECT_EQ(first.at_ns, 5);
  Received second = b->read(buffer);
  EXPECT_EQ(second.size, 1U);
  EXPECT_EQ(second.at_ns, 9);
  EXPECT_EQ(b->read(buffer).size, 0U);
}

TEST(MemoryLink, TakesNoMoreThanItsCapacity) {
  auto [a, b] = MemoryLink::make_pair(monotonic_ns, 4);
  EXPECT_EQ(a->write(Bytes{1, 2, 3, 4, 5, 6}, hal::kNsPerSecond), 4U);
  EXPECT_EQ(a->statistics().bytes_refused, 2U);
  EXPECT_EQ(read_all(*b), (Bytes{1, 2, 3, 4}));
  EXPECT_EQ(a->write(Bytes{7}, 0), 1U);
}

TEST(MemoryLink, KeepsWhatWasWrittenBeforeAHangUp) {
  auto [a, b] = MemoryLink::make_pair();
  a->write(Bytes{1, 2}, 0);
  a.reset();
  EXPECT_EQ(b->state(), LinkState::HungUp);
  EXPECT_EQ(b->write(Bytes{3}, 0), 0U);
  EXPECT_EQ(read_all(*b), (Bytes{1, 2}));
  EXPECT_EQ(b->statistics().bytes_in, 2U);
  EXPECT_EQ(b->statistics().bytes_refused, 1U);
}

TEST(MemoryLink, WakesAReaderThatWaitsOnAnotherThread) {
  auto [a, b] = MemoryLink::make_pair();
  Bytes got;
  std::thread reader([&, link = b.get()] {
    while (got.size() < 1000) {
      link->wait(hal::kNsPerSecond);
      const Bytes more = read_all(*link);
      got.insert(got.end(), more.begin(), more.end());
    }
  });
  for (int i = 0; i < 1000; ++i) a->write(Bytes{static_cast<std::uint8_t>(i)}, 0);
  reader.join();
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(got[static_cast<std::size_t>(i)], static_cast<std::uint8_t>(i));
}

TEST(PendingLink, GivesTheOpenersResultOnce) {
  Pending<ByteLink> pending([]() -> hal::Result<std::unique_ptr<ByteLink>> { return hal::Error{"no such robot"}; });
  auto result = pending.take();
  while (!result) {
    std::this_thread::yield();
    result = pending.take();
  }
  EXPECT_EQ(result->error().message, "no such robot");
  EXPECT_FALSE(pending.take());
}

TEST(PendingLink, ClosesALinkThatNobodyWaitsForAnyMore) {
  auto [near, far] = MemoryLink::make_pair();
  auto given = std::make_shared<std::unique_ptr<ByteLink>>(std::move(near));
  {
    Pending<ByteLink> pending([given]() -> hal::Result<std::unique_ptr<ByteLink>> { return std::move(*given); });
  }
  while (far->state() == LinkState::Open) std::this_thread::yield();
  EXPECT_EQ(far->state(), LinkState::HungUp);
}

}  // namespace
}  // namespace tandem::bridges
