#include "bridges/can/permitted_can_link.hpp"

#include <gtest/gtest.h>

#include "tests/bridges/can/frames.hpp"
#include "tests/bridges/can/memory_bus.hpp"

namespace tandem::bridges {
namespace {

TEST(PermittedCanLink, IsGoneForGoodOnceTheTurnWasTakenFromUs) {
  MemoryBus bus;
  const auto far = bus.attach();
  std::atomic<std::uint32_t> turn{0};
  const auto open =
      permitted([&]() -> hal::Result<std::unique_ptr<CanLink>> { return bus.attach(); }, SendPermit(turn));
  const auto link = open().value();
  const CanFrame frame = make_frame(7, std::array<std::uint8_t, 1>{1});
  CanFrame heard;
  EXPECT_EQ(link->send(frame), Sent::Taken);
  EXPECT_TRUE(far->receive(heard));
  for (const std::uint32_t next : {1U, 2U}) {
    turn = next;
    EXPECT_EQ(link->state(), BusState::Gone);
    EXPECT_EQ(link->send(frame), Sent::Refused);
    EXPECT_FALSE(far->receive(heard));
    far->send(frame);
    EXPECT_FALSE(link->wait(0));
    EXPECT_FALSE(link->receive(heard));
    EXPECT_EQ(open().ok(), next == 2);
  }
}

}  // namespace
}  // namespace tandem::bridges
