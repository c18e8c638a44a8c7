#include "tests/bridges/can/faulty_can_link.hpp"

#include <gtest/gtest.h>
#include <vector>

#include "tests/bridges/can/memory_bus.hpp"

namespace tandem::bridges {
namespace {

constexpr hal::TimeNs kMs = hal::kNsPerMs;

CanFrame numbered(std::uint32_t n) {
  CanFrame frame;
  frame.extended = true;
  frame.id = n;
  return frame;
}

struct Rig {
  explicit Rig(const CanFaults& faults) : bus([this] { return now; }, 4096), far(bus.attach()) {
    near = std::make_unique<FaultyCanLink>(bus.attach(), faults, [this] { return now; });
  }
  static std::vector<std::uint32_t> read_all(CanLink& link) {
    std::vector<std::uint32_t> ids;
    CanFrame frame;
    while (link.receive(frame)) ids.push_back(frame.id);
    return ids;
  }
  hal::TimeNs now = 1000 * kMs;
  MemoryBus bus;
  std::unique_ptr<CanLink> far;
  std::unique_ptr<FaultyCanLink> near;
};

std::vector<std::uint32_t> sequence(std::uint32_t n) {
  std::vector<std::uint32_t> all(n);
  for (std::uint32_t i = 0; i < n; ++i) all[i] = i;
  return all;
}

TEST(FaultyCanLink, WithoutFaultsIsTheLinkItself) {
  Rig rig({});
  for (std::uint32_t i = 0; i < 100; ++i) rig.near->send(numbered(i));
  EXPECT_EQ(Rig::read_all(*rig.far), sequence(100));
  for (std::uint32_t i = 0; i < 100; ++i) rig.far->send(numbered(i));
  EXPECT_EQ(Rig::read_all(*rig.near), sequence(100));
}

TEST(FaultyCanLink, LosesAndDoublesTheSameFramesForTheSameSeed) {
  const CanFaults faults{.seed = 5, .loss = 0.1, .doubling = 0.1};
  Rig a(faults);
  Rig b(faults);
  Rig other({.seed = 6, .loss = 0.1, .doubling = 0.1});
  for (std::uint32_t i = 0; i < 1000; ++i) {
    a.near->send(numbered(i));
    other.near->send(numbered(i));
  }
  for (std::uint32_t i = 0; i < 1000; ++i) {
    b.near->send(numbered(i));
    b.now += kMs;
  }
  const auto through = Rig::read_all(*a.far);
  EXPECT_EQ(through, Rig::read_all(*b.far));
  EXPECT_NE(through, Rig::read_all(*other.far));
  EXPECT_NEAR(static_cast<double>(through.size()), 990.0, 40.0);
  EXPECT_TRUE(std::ranges::is_sorted(through));
  EXPECT_NE(std::ranges::adjacent_find(through), through.end());
}

TEST(FaultyCanLink, LetsFramesOvertake) {
  Rig rig({.seed = 2, .reordering = 0.2});
  for (std::uint32_t i = 0; i < 500; ++i) rig.far->send(numbered(i));
  auto through = Rig::read_all(*rig.near);
  rig.now += 100 * kMs;  // one that is still held back
  for (const std::uint32_t id : Rig::read_all(*rig.near)) through.push_back(id);
  EXPECT_FALSE(std::ranges::is_sorted(through));
  std::ranges::sort(through);
  EXPECT_EQ(through, sequence(500));
}

TEST(FaultyCanLink, HoldsLateFramesBackAndAllBehindThem) {
  Rig rig({.seed = 1, .lateness = 1.0, .late_ns = 20 * kMs});
  rig.far->send(numbered(1));
  EXPECT_TRUE(Rig::read_all(*rig.near).empty());
  rig.now += 19 * kMs;
  EXPECT_TRUE(Rig::read_all(*rig.near).empty());
  rig.now += kMs;
  EXPECT_EQ(Rig::read_all(*rig.near), std::vector<std::uint32_t>{1});
}

TEST(FaultyCanLink, GoesBusOffDuringWholeSlotsAndComesBack) {
  Rig rig({.seed = 3, .bus_off = 0.5, .bus_off_slot_ns = 10 * kMs});
  int off = 0;
  const hal::TimeNs start = rig.now;
  for (int slot = 0; slot < 200; ++slot) {
    rig.now = start + slot * 10 * kMs;
    const BusState at_start = rig.near->state();
    rig.now += 9 * kMs;
    EXPECT_EQ(rig.near->state(), at_start);
    rig.far->send(numbered(1));
    if (at_start == BusState::BusOff) {
      ++off;
      EXPECT_EQ(rig.near->send(numbered(2)), Sent::Refused);
      EXPECT_TRUE(Rig::read_all(*rig.near).empty());
    } else {
      EXPECT_EQ(rig.near->send(numbered(2)), Sent::Taken);
      EXPECT_EQ(Rig::read_all(*rig.near).size(), 1U);
    }
  }
  EXPECT_GT(off, 60);
  EXPECT_LT(off, 140);
  EXPECT_GT(rig.near->statistics().bus_offs, 20U);
  EXPECT_NEAR(static_cast<double>(rig.near->statistics().restarts),
              static_cast<double>(rig.near->statistics().bus_offs), 1.0);
}

}  // namespace
}  // namespace tandem::bridges
