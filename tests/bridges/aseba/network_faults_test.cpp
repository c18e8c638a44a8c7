// The table of nodes on buses that lose, double, reorder and delay frames.
#include <gtest/gtest.h>

#include "tests/bridges/aseba/robot_on_bus.hpp"

namespace tandem::bridges::aseba {
namespace {

constexpr hal::TimeNs kMs = hal::kNsPerMs;
constexpr hal::TimeNs kSecond = hal::kNsPerSecond;

/// Faults that last: whatever happens, nothing wrong is believed, and much still works.
class FaultyBus : public testing::TestWithParam<CanFaults> {};

TEST_P(FaultyBus, NeverShowsAWrongAddressAndKeepsWorking) {
  for (std::uint64_t seed = 1; seed <= 15; ++seed) {
    CanFaults faults = GetParam();
    faults.seed = seed;
    RobotOnBus robot(faults);
    // Names short enough for single frames, so that whole messages vanish, double and overtake unseen.
    FakeNode& node = robot.add(2, "base", {{"a", 3}, {"b", 1}, {"c", 7}, {"d", 2}, {"e", 1}});
    int good = 0;
    for (int round = 0; round < 60; ++round) {
      node.memory[4] = static_cast<std::int16_t>(round);
      robot.network.want(2, 4, 1);
      robot.pass(50 * kMs);
      const Node& seen = robot.network.node(2);
      if (!seen.ready()) continue;
      ASSERT_EQ(seen.description.variables.size(), 5U) << "seed " << seed;
      ASSERT_EQ(seen.description.variable("b")->address, 3) << "seed " << seed;
      ASSERT_EQ(seen.description.variable("e")->address, 13) << "seed " << seed;
      if (seen.taken_ns(4) > robot.now - 50 * kMs && seen.value(4) == round) ++good;
    }
    EXPECT_GT(good, 10) << "seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Faults, FaultyBus,
                         testing::Values(CanFaults{.loss = 0.05}, CanFaults{.doubling = 0.1},
                                         CanFaults{.reordering = 0.03},
                                         CanFaults{.lateness = 0.05, .late_ns = 30 * kMs},
                                         CanFaults{.loss = 0.02, .doubling = 0.02, .reordering = 0.01},
                                         CanFaults{.bus_off = 0.1, .bus_off_slot_ns = 100 * kMs}));

TEST(FaultyBus, IsForgottenWithinASecondWhenTheFaultsEnd) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    // Off and on at random for a while, then the bus is as it should be: the decorator stays, its chances do not.
    RobotOnBus robot;
    FakeNode& motor = robot.add_motor();
    ASSERT_TRUE(robot.pass_until_ready(1));
    std::uint64_t chance = seed;
    for (int slot = 0; slot < 30; ++slot) {
      chance = chance * 6364136223846793005ULL + 1442695040888963407ULL;
      robot.bus.set_state((chance >> 60U) < 8 ? BusState::BusOff : BusState::Active);
      motor.on = (chance >> 50U & 3U) != 0;
      robot.bus.set_full((chance >> 40U & 3U) == 0);
      robot.pass(static_cast<hal::TimeNs>(chance >> 33U & 127U) * kMs);
    }
    robot.bus.set_state(BusState::Active);
    robot.bus.set_full(false);
    motor.on = true;
    motor.memory[34] = static_cast<std::int16_t>(seed);
    const hal::TimeNs healed = robot.now;
    ASSERT_TRUE(robot.pass_until(
        [&] {
          const Node& node = robot.network.node(1);
          if (node.ready()) robot.network.want(1, 34, 1);
          return node.ready() && node.taken_ns(34) > healed && node.value(34) == static_cast<std::int16_t>(seed);
        },
        kSecond))
        << "seed " << seed;
  }
}

}  // namespace
}  // namespace tandem::bridges::aseba
