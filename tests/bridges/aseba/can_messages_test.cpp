#include "bridges/aseba/can_messages.hpp"

#include <gtest/gtest.h>
#include <vector>

#include "tests/bridges/can/frames.hpp"
#include "tests/bridges/can/memory_bus.hpp"

namespace tandem::bridges::aseba {
namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr hal::TimeNs kMs = hal::kNsPerMs;

struct Rig {
  explicit Rig(const CanMessagesSettings& settings = {})
      : bus([this] { return now; }, 4096), far(bus.attach()), link(bus.attach(), settings, [this] { return now; }) {}

  std::vector<CanFrame> frames() {
    std::vector<CanFrame> all;
    CanFrame frame;
    while (far->receive(frame)) all.push_back(frame);
    return all;
  }
  /// Lets time pass, so that what waits for its turn leaves.
  void pass(hal::TimeNs time) {
    now += time;
    MessageView view;
    link.receive(view);
  }
  hal::TimeNs now = 1000 * kMs;
  MemoryBus bus;
  std::unique_ptr<CanLink> far;
  CanMessages link;
};

TEST(CanMessages, SendsWholeMessagesInOrder) {
  Rig rig;
  EXPECT_TRUE(rig.link.send(0xA011, Bytes{5, 0}));
  EXPECT_TRUE(rig.link.send(0xA00C, Bytes{1, 0, 0x23, 0, 0xD4, 0xFE, 0x4D, 0}));
  const auto frames = rig.frames();
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_EQ(frames[0].id, 0x300U);
  EXPECT_EQ(frames[1].id, 0x100U);
  EXPECT_EQ(frames[2].id, 0x200U);
  EXPECT_EQ(rig.link.statistics().sent, 2U);
}

TEST(CanMessages, ReceivesWhatOthersSay) {
  Rig rig;
  const Bytes payload = {0x22, 0, 2, 0, 0xD4, 0xFE};
  for (std::size_t i = 0; i < frames_for(payload.size()); ++i) rig.far->send(fragment(9, 0x9005, payload, i));
  MessageView view;
  ASSERT_TRUE(rig.link.receive(view));
  EXPECT_EQ(view.source, 9);
  EXPECT_EQ(view.type, 0x9005);
  EXPECT_TRUE(std::ranges::equal(view.payload, payload));
  EXPECT_FALSE(rig.link.receive(view));
}

TEST(CanMessages, LeavesTheBusToOthersMostOfTheTime) {
  Rig rig({.frames_per_s = 1000.0, .burst = 10});
  for (int i = 0; i < 40; ++i) EXPECT_TRUE(rig.link.send(0xA011, Bytes{5, 0}));
  EXPECT_EQ(rig.frames().size(), 10U);
  rig.pass(20 * kMs);  // the burst is never more than 10
  EXPECT_EQ(rig.frames().size(), 10U);
  for (int i = 0; i < 5; ++i) rig.pass(kMs);
  EXPECT_EQ(rig.frames().size(), 5U);
}

TEST(CanMessages, KeepsTheOrderWhileTheBusTakesNothing) {
  Rig rig;
  rig.bus.set_full(true);
  EXPECT_TRUE(rig.link.send(1, Bytes{1, 0}));
  EXPECT_TRUE(rig.link.send(2, Bytes{2, 0}));
  EXPECT_TRUE(rig.frames().empty());
  rig.bus.set_full(false);
  EXPECT_TRUE(rig.link.send(3, Bytes{3, 0}));
  const auto frames = rig.frames();
  ASSERT_EQ(frames.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(frames[i].data[0], i + 1);
}

TEST(CanMessages, TakesNoMessageThatItHasNoRoomFor) {
  Rig rig;
  rig.bus.set_full(true);
  EXPECT_TRUE(rig.link.send(1, Bytes(kMostPayload)));  // the longest fits where nothing waits
  EXPECT_FALSE(rig.link.send(1, Bytes{}));
  rig.link.clear();
  int taken = 0;
  while (taken < 100 && rig.link.send(1, Bytes(20))) ++taken;
  EXPECT_EQ(taken, 10);  // of 3 frames each in 32
  EXPECT_EQ(rig.link.statistics().no_room, 2U);
  EXPECT_FALSE(rig.link.send(1, Bytes(kMostPayload + 1)));
}

TEST(CanMessages, LetsNoOldCommandFireLate) {
  Rig rig;
  rig.bus.set_full(true);
  rig.link.send(0xA00C, Bytes{1, 0, 34, 0, 50, 0});
  rig.link.send(0xA00C, Bytes{2, 0, 34, 0, 50, 0});
  rig.pass(101 * kMs);
  rig.bus.set_full(false);
  rig.pass(kMs);
  EXPECT_TRUE(rig.frames().empty());
  EXPECT_EQ(rig.link.statistics().dropped, 2U);
  EXPECT_EQ(rig.link.statistics().times_stuck, 1U);
}

TEST(CanMessages, ForgetsItsQueueWhenCleared) {
  Rig rig;
  rig.bus.set_full(true);
  for (int i = 0; i < 5; ++i) rig.link.send(1, Bytes(20));
  rig.link.clear();
  rig.bus.set_full(false);
  rig.pass(kMs);
  EXPECT_TRUE(rig.frames().empty());
  EXPECT_EQ(rig.link.statistics().dropped, 5U);
}

TEST(CanMessages, FinishesTheMessageThatIsHalfOnItsWayWhenCleared) {
  Rig rig({.frames_per_s = 1000.0, .burst = 2});
  rig.link.send(1, Bytes(20));  // 3 frames, of which 2 leave
  rig.link.send(2, Bytes(20));
  EXPECT_EQ(rig.frames().size(), 2U);
  rig.link.clear();
  rig.link.send(3, Bytes{7, 0});
  for (int i = 0; i < 10; ++i) rig.pass(kMs);
  const auto frames = rig.frames();
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].id, 0x200U);
  EXPECT_EQ(frames[1].data[0], 3);
  EXPECT_EQ(rig.link.statistics().dropped, 1U);
}

TEST(CanMessages, EmptiesItselfAtABusOffAndClosesTheBrokenMessageAfterwards) {
  Rig rig({.frames_per_s = 1000.0, .burst = 2});
  rig.link.send(0xA00C, Bytes(30));  // 4 frames, of which 2 leave
  EXPECT_EQ(rig.frames().size(), 2U);
  rig.bus.set_state(BusState::BusOff);
  rig.pass(50 * kMs);
  EXPECT_EQ(rig.link.state(), Carrier::Down);
  EXPECT_FALSE(rig.link.send(1, Bytes{1, 0}));
  rig.bus.set_state(BusState::Active);
  rig.pass(50 * kMs);
  EXPECT_EQ(rig.link.state(), Carrier::Up);
  EXPECT_TRUE(rig.link.send(2, Bytes{2, 0}));
  const auto frames = rig.frames();
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_TRUE(same_on_wire(frames[0], closing_frame(0)));
  EXPECT_EQ(frames[1].data[0], 2);
  EXPECT_EQ(rig.link.statistics().times_down, 1U);
  EXPECT_EQ(rig.link.statistics().times_up, 1U);
}

TEST(CanMessages, IsGoneWhenItsAdapterIs) {
  Rig rig;
  rig.bus.set_state(BusState::Gone);
  rig.pass(kMs);
  EXPECT_EQ(rig.link.state(), Carrier::Gone);
  EXPECT_FALSE(rig.link.send(1, Bytes{1, 0}));
}

}  // namespace
}  // namespace tandem::bridges::aseba
