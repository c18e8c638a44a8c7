// After the nodes are described, reading and writing them allocates nothing.
#include <array>
#include <atomic>
#include <cstdlib>
#include <gtest/gtest.h>
#include <new>

#include "tests/bridges/aseba/robot_on_bus.hpp"

namespace {

std::atomic<bool> counting{false};
std::atomic<std::uint64_t> allocations{0};

}  // namespace

// GCC cannot see that both sides are malloc and free.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"

void* operator new(std::size_t size) {
  if (counting) ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace tandem::bridges::aseba {
namespace {

constexpr std::array<std::uint8_t, 2> kEvent = {1, 0};

TEST(Network, AllocatesNothingInSteadyState) {
  RobotOnBus robot;
  robot.add_motor(1);
  robot.add_motor(2, "right motor");
  ASSERT_TRUE(robot.pass_until_ready(1));
  ASSERT_TRUE(robot.pass_until_ready(2));
  std::uint64_t in_bridge = 0;
  std::int16_t value = 0;
  for (int i = 0; i < 4000; ++i) {
    counting = true;
    const std::array<std::int16_t, 1> speed = {++value};
    for (const std::uint8_t id : {std::uint8_t{1}, std::uint8_t{2}}) {
      if (i % 5 != 0) break;
      robot.network.want(id, 34, 3);
      robot.network.write(id, 34, speed);
    }
    if (i % 5 == 0) robot.network.send(UserEvent{3, Words(kEvent)});
    robot.now += hal::kNsPerMs;
    robot.network.poll(robot.now);
    Event event;
    robot.network.take_event(event);
    if (i % 50 == 3) robot.network.forget_writes();
    counting = false;
    in_bridge = allocations;
    for (const auto& node : robot.nodes) node->work();
  }
  EXPECT_EQ(in_bridge, 0U);
  EXPECT_GT(robot.network.node(1).statistics.answers, 500U);
  EXPECT_GT(robot.network.node(2).statistics.writes, 500U);
}

}  // namespace
}  // namespace tandem::bridges::aseba
