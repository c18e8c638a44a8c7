#include "bridges/aseba/reopening_messages.hpp"

#include <atomic>
#include <gtest/gtest.h>
#include <mutex>
#include <vector>

#include "bridges/aseba/stream_messages.hpp"
#include "tests/bridges/link/memory_link.hpp"

namespace tandem::bridges::aseba {
namespace {

/// Opens links in memory; the far ends are the test's.
struct Exchange {
  MessageLinkOpener opener() {
    return [this]() -> hal::Result<std::unique_ptr<MessageLink>> {
      ++tries;
      if (failing) return hal::Error{"no robot there"};
      auto [near, far] = MemoryLink::make_pair();
      const std::lock_guard lock(mutex);
      far_ends.push_back(std::move(far));
      return std::unique_ptr<MessageLink>(std::make_unique<StreamMessages>(std::move(near)));
    };
  }
  std::atomic<bool> failing{false};
  std::atomic<int> tries{0};
  std::mutex mutex;
  std::vector<std::unique_ptr<MemoryLink>> far_ends;
};

void wait_for(ReopeningMessages& link, Carrier carrier) {
  MessageView view;
  for (int i = 0; i < 2000 && link.state() != carrier; ++i) {
    link.wait(5 * hal::kNsPerMs);
    link.receive(view);
  }
  ASSERT_EQ(link.state(), carrier);
}

TEST(ReopeningMessages, OpensAgainWhenTheLinkIsGone) {
  Exchange exchange;
  ReopeningMessages link(exchange.opener(), hal::kNsPerMs, 2 * hal::kNsPerMs);
  wait_for(link, Carrier::Up);
  const std::array<std::uint8_t, 2> five = {5, 0};
  EXPECT_TRUE(link.send(0xA011, five));
  exchange.far_ends[0].reset();
  MessageView view;
  while (link.openings() < 2) {
    link.wait(5 * hal::kNsPerMs);
    link.receive(view);
  }
  EXPECT_TRUE(link.send(0xA011, five));
  std::array<std::uint8_t, 16> buffer;
  const std::lock_guard lock(exchange.mutex);
  ASSERT_EQ(exchange.far_ends.size(), 2U);
  EXPECT_EQ(exchange.far_ends[1]->read(buffer).size, 8U);
  const MessageLinkStatistics s = link.statistics();
  EXPECT_EQ(s.sent, 2U);
  EXPECT_EQ(s.times_down, 1U);
  EXPECT_EQ(s.times_up, 1U);
}

TEST(ReopeningMessages, KeepsTryingAndSaysWhy) {
  Exchange exchange;
  exchange.failing = true;
  ReopeningMessages link(exchange.opener(), hal::kNsPerMs, 2 * hal::kNsPerMs);
  MessageView view;
  while (link.failed_openings() < 3) {
    link.wait(5 * hal::kNsPerMs);
    EXPECT_FALSE(link.receive(view));
  }
  EXPECT_EQ(link.trouble(), "no robot there");
  EXPECT_EQ(link.state(), Carrier::Down);
  EXPECT_FALSE(link.send(1, {}));
  EXPECT_EQ(link.statistics().refused, 1U);
  exchange.failing = false;
  wait_for(link, Carrier::Up);
  EXPECT_EQ(link.trouble(), "");
}

}  // namespace
}  // namespace tandem::bridges::aseba
