#include "tests/bridges/can/memory_bus.hpp"

#include <gtest/gtest.h>
#include <thread>

#include "tests/bridges/can/frames.hpp"

namespace tandem::bridges {
namespace {

CanFrame numbered(std::uint32_t n) {
  return make_frame(n & 0x7FFU, std::array<std::uint8_t, 1>{static_cast<std::uint8_t>(n)});
}

TEST(MemoryBus, BringsFramesToAllOthersInOrderWithTheirTime) {
  hal::TimeNs now = 7;
  MemoryBus bus([&] { return now; });
  const auto a = bus.attach();
  const auto b = bus.attach();
  const auto c = bus.attach();
  EXPECT_EQ(a->send(numbered(1)), Sent::Taken);
  now = 9;
  EXPECT_EQ(a->send(numbered(2)), Sent::Taken);
  CanFrame frame;
  EXPECT_FALSE(a->receive(frame));
  for (CanLink* link : {b.get(), c.get()}) {
    ASSERT_TRUE(link->receive(frame));
    EXPECT_TRUE(same_on_wire(frame, numbered(1)));
    EXPECT_EQ(frame.at_ns, 7);
    ASSERT_TRUE(link->receive(frame));
    EXPECT_TRUE(same_on_wire(frame, numbered(2)));
    EXPECT_EQ(frame.at_ns, 9);
    EXPECT_FALSE(link->receive(frame));
  }
  EXPECT_EQ(a->statistics().frames_out, 2U);
  EXPECT_EQ(b->statistics().frames_in, 2U);
}

TEST(MemoryBus, LosesTheNewestFramesWhereNobodyReads) {
  MemoryBus bus(monotonic_ns, 2);
  const auto a = bus.attach();
  const auto b = bus.attach();
  for (std::uint32_t i = 0; i < 5; ++i) a->send(numbered(i));
  EXPECT_EQ(b->statistics().overrun, 3U);
  CanFrame frame;
  ASSERT_TRUE(b->receive(frame));
  EXPECT_TRUE(same_on_wire(frame, numbered(0)));
}

TEST(MemoryBus, PassesNothingWhileItIsOff) {
  MemoryBus bus;
  const auto a = bus.attach();
  const auto b = bus.attach();
  bus.set_state(BusState::BusOff);
  EXPECT_EQ(a->send(numbered(1)), Sent::Refused);
  EXPECT_EQ(a->state(), BusState::BusOff);
  bus.set_state(BusState::Active);
  EXPECT_EQ(a->send(numbered(2)), Sent::Taken);
  EXPECT_EQ(a->statistics().bus_offs, 1U);
  EXPECT_EQ(a->statistics().restarts, 1U);
  EXPECT_EQ(a->statistics().refused, 1U);
  bus.set_full(true);
  EXPECT_EQ(a->send(numbered(3)), Sent::Full);
  CanFrame frame;
  EXPECT_TRUE(b->receive(frame));
  EXPECT_FALSE(b->receive(frame));
}

TEST(MemoryBus, RefusesFramesThatAreNone) {
  MemoryBus bus;
  const auto a = bus.attach();
  CanFrame frame;
  frame.id = 0x800;
  EXPECT_EQ(a->send(frame), Sent::Refused);
  frame.extended = true;
  EXPECT_EQ(a->send(frame), Sent::Taken);
  frame.size = 9;
  EXPECT_EQ(a->send(frame), Sent::Refused);
}

TEST(MemoryBus, WakesAReaderThatWaitsOnAnotherThread) {
  MemoryBus bus;
  const auto a = bus.attach();
  const auto b = bus.attach();
  std::uint32_t got = 0;
  std::thread reader([&] {
    CanFrame frame;
    while (got < 500) {
      b->wait(hal::kNsPerSecond);
      while (b->receive(frame)) {
        if (!same_on_wire(frame, numbered(got++))) return;
      }
    }
  });
  for (std::uint32_t i = 0; i < 500; ++i) a->send(numbered(i));
  reader.join();
  EXPECT_EQ(got, 500U);
}

TEST(MemoryBus, OutlivesItsEndsAndIsOutlivedByThem) {
  auto bus = std::make_unique<MemoryBus>();
  auto a = bus->attach();
  const auto b = bus->attach();
  bus.reset();
  a->send(numbered(3));
  a.reset();
  CanFrame frame;
  EXPECT_TRUE(b->receive(frame));
  EXPECT_EQ(b->send(frame), Sent::Taken);
}

}  // namespace
}  // namespace tandem::bridges
