#include "bridges/aseba/network.hpp"

#include <gmock/gmock.h>

#include "tests/bridges/aseba/robot_on_bus.hpp"
#include "tests/bridges/can/frames.hpp"

namespace tandem::bridges::aseba {
namespace {

using testing::HasSubstr;
constexpr hal::TimeNs kMs = hal::kNsPerMs;
constexpr hal::TimeNs kSecond = hal::kNsPerSecond;

TEST(Network, FindsNodesOfBothVersionsAndTheirVariables) {
  for (const int version : {4, 5}) {
    RobotOnBus robot;
    for (std::uint8_t id = 1; id <= 5; ++id) robot.add_motor(id, "motor " + std::to_string(id)).version = version;
    for (std::uint8_t id = 1; id <= 5; ++id) {
      ASSERT_TRUE(robot.pass_until_ready(id, 2 * kSecond)) << version;
      const Node& node = robot.network.node(id);
      EXPECT_EQ(node.description.name, "motor " + std::to_string(id));
      EXPECT_EQ(node.description.variable("odo")->address, 35);
      EXPECT_EQ(node.description.local_events, std::vector<std::string>{"timer"});
      EXPECT_EQ(node.description.native_functions, std::vector<std::string>{"math.add"});
      EXPECT_EQ(node.version, version);
      EXPECT_EQ(node.generation, 1U);
    }
    EXPECT_EQ(robot.network.node(6).state, NodeState::Absent);
    EXPECT_EQ(robot.network.known().size(), 5U);
  }
}

TEST(Network, FindsNodesByAnyOfTheirNames) {
  RobotOnBus robot;
  robot.add_motor(3, "Left_Motor");
  ASSERT_TRUE(robot.pass_until_ready(3));
  const std::vector<std::string> names = {"wheel-left", "left motor"};
  ASSERT_NE(robot.network.find(names), nullptr);
  EXPECT_EQ(robot.network.find(names)->id, 3);
  EXPECT_EQ(robot.network.find(std::vector<std::string>{"right motor"}), nullptr);
}

TEST(Network, ReadsWhatIsWantedAndKnowsItsAge) {
  RobotOnBus robot;
  FakeNode& motor = robot.add_motor();
  ASSERT_TRUE(robot.pass_until_ready(1));
  motor.memory[34] = -72;
  motor.memory[35] = 1000;
  const Node& node = robot.network.node(1);
  EXPECT_EQ(node.taken_ns(34, 3), 0);
  EXPECT_TRUE(robot.network.want(1, 34, 3));
  robot.pass(3 * kMs);
  EXPECT_EQ(node.value(34), -72);
  EXPECT_EQ(node.value(35), 1000);
  EXPECT_GE(node.taken_ns(34, 3), robot.now - 3 * kMs);
  EXPECT_EQ(node.taken_ns(33, 2), 0);  // 33 was never read
  const hal::TimeNs taken = node.taken_ns(34, 3);
  robot.pass(50 * kMs);
  EXPECT_EQ(node.taken_ns(34, 3), taken);
  EXPECT_EQ(motor.reads, 1);
  EXPECT_EQ(node.taken_ns(34, 100), 0);
}

TEST(Network, ReadsNeighboursInOneQuestionAndDistantWordsInTwo) {
  RobotOnBus robot;
  FakeNode& node = robot.add(3, "proximity sensors", {{"a", 10}, {"b", 24}, {"c", 12}, {"d", 300}});
  ASSERT_TRUE(robot.pass_until_ready(3));
  robot.network.want(3, 10, 24);
  robot.network.want(3, 34, 12);
  robot.pass(5 * kMs);
  EXPECT_EQ(node.reads, 1);
  EXPECT_GT(robot.network.node(3).taken_ns(10, 36), 0);
  robot.network.want(3, 0, 1);
  robot.network.want(3, 40, 1);
  robot.pass(5 * kMs);
  EXPECT_EQ(node.reads, 3);
  robot.network.want(3, 46, 300);  // more than one answer can hold
  robot.pass(20 * kMs);
  EXPECT_EQ(node.reads, 5);
  EXPECT_GT(robot.network.node(3).taken_ns(46, 300), 0);
}

TEST(Network, WritesTheNewestValuesOnly) {
  RobotOnBus robot;
  FakeNode& motor = robot.add_motor();
  ASSERT_TRUE(robot.pass_until_ready(1));
  for (std::int16_t v = 0; v <= 30; ++v) {
    const std::array<std::int16_t, 1> value = {v};
    EXPECT_TRUE(robot.network.write(1, 34, value));
  }
  robot.pass(2 * kMs);
  EXPECT_EQ(motor.memory[34], 30);
  EXPECT_EQ(motor.writes, 1);
  const std::array<std::int16_t, 3> all = {-1, -2, -3};
  robot.network.write(1, 34, all);
  robot.pass(2 * kMs);
  EXPECT_EQ(motor.memory[36], -3);
  EXPECT_EQ(motor.writes, 2);
}

TEST(Network, RefusesWhatLiesOutsideOfANodesMemoryOrIsNotReady) {
  RobotOnBus robot;
  robot.add_motor();
  ASSERT_TRUE(robot.pass_until_ready(1));
  const std::array<std::int16_t, 2> values = {1, 2};
  EXPECT_FALSE(robot.network.write(1, 36, values));
  EXPECT_FALSE(robot.network.write(1, 70000, values));
  EXPECT_FALSE(robot.network.want(1, 0, 38));
  EXPECT_FALSE(robot.network.want(1, 1, static_cast<std::size_t>(-1)));
  EXPECT_TRUE(robot.network.want(1, 0, 37));
  EXPECT_FALSE(robot.network.write(2, 0, values));
  EXPECT_EQ(robot.network.node(1).statistics.refused, 4U);
  EXPECT_EQ(robot.network.node(2).statistics.refused, 1U);
}

TEST(Network, ForgetsWritesAtAStop) {
  RobotOnBus robot;
  FakeNode& motor = robot.add_motor();
  ASSERT_TRUE(robot.pass_until_ready(1));
  robot.bus.set_full(true);
  const std::array<std::int16_t, 1> fast = {72};
  const std::array<std::int16_t, 1> zero = {0};
  robot.network.write(1, 34, fast);
  robot.network.poll(robot.now);  // it waits in the link's queue now
  robot.network.write(1, 34, fast);
  robot.network.forget_writes();
  robot.network.write(1, 34, zero);
  robot.bus.set_full(false);
  robot.pass(500 * kMs);
  EXPECT_EQ(motor.writes, 1);
  EXPECT_EQ(motor.memory[34], 0);
}

TEST(Network, AsksUntilItIsAnsweredAndKeepsTheOldValueWithItsAge) {
  RobotOnBus robot;
  FakeNode& motor = robot.add_motor();
  ASSERT_TRUE(robot.pass_until_ready(1));
  motor.memory[34] = 5;
  robot.network.want(1, 34, 1);
  robot.pass(5 * kMs);
  const Node& node = robot.network.node(1);
  const hal::TimeNs taken = node.taken_ns(34);
  motor.answers_reads = false;
  motor.memory[34] = 6;
  const int before = motor.reads;
  robot.network.want(1, 34, 1);
  robot.pass(1050 * kMs);
  EXPECT_THAT(motor.reads - before, testing::AllOf(testing::Ge(9), testing::Le(11)));  // ten a second
  EXPECT_GE(node.statistics.unanswered, 4U);
  EXPECT_LE(node.statistics.answers, node.statistics.reads);
  EXPECT_EQ(node.value(34), 5);
  EXPECT_EQ(node.taken_ns(34), taken);
  EXPECT_TRUE(node.ready());  // it still presents itself
  EXPECT_TRUE(robot.network.reading());
  motor.answers_reads = true;
  robot.pass(150 * kMs);  // nobody asks for it anew
  EXPECT_EQ(node.value(34), 6);
  EXPECT_FALSE(robot.network.reading());
}

TEST(Network, WhatIsWantedOfANodeThatIsLostIsReadWhenItIsBack) {
  RobotOnBus robot;
  FakeNode& motor = robot.add_motor();
  ASSERT_TRUE(robot.pass_until_ready(1));
  motor.memory[34] = 6;
  motor.on = false;
  robot.network.want(1, 34, 1);
  robot.pass(2000 * kMs);
  ASSERT_EQ(robot.network.node(1).state, NodeState::Lost);
  EXPECT_FALSE(robot.network.reading());
  motor.on = true;
  ASSERT_TRUE(robot.pass_until_ready(1));
  robot.pass(50 * kMs);
  EXPECT_EQ(robot.network.node(1).value(34), 6);
}

TEST(Network, DoesNotCountWhatOurOwnThreadWasLate) {
  RobotOnBus robot;
  robot.add_motor();
  ASSERT_TRUE(robot.pass_until_ready(1));
  robot.now += 1500 * kMs;  // longer than a node may be silent, and nobody asked it anything
  robot.network.stalled(1500 * kMs);
  robot.network.poll(robot.now);
  EXPECT_TRUE(robot.network.node(1).ready());
  robot.pass(500 * kMs);
  EXPECT_EQ(robot.network.node(1).statistics.times_lost, 0U);
}

TEST(Network, StoresNoAnswerOfAWrongLengthAndNoneThatItDidNotAskFor) {
  RobotOnBus robot;
  FakeNode& motor = robot.add_motor();
  ASSERT_TRUE(robot.pass_until_ready(1));
  motor.answers_reads = false;
  robot.network.want(1, 34, 3);
  robot.pass(2 * kMs);
  motor.say(0x9005, {34, 0, 9, 0, 9, 0});
  motor.say(0x9005, {33, 0, 9, 0, 9, 0, 9, 0});
  robot.pass(2 * kMs);
  EXPECT_EQ(robot.network.node(1).statistics.wrong_length, 1U);
  EXPECT_EQ(robot.network.node(1).statistics.unasked, 1U);
  EXPECT_EQ(robot.network.node(1).taken_ns(34), 0);
}

TEST(Network, FindsANodeThatAppearsLater) {
  for (const int version : {4, 5}) {
    RobotOnBus robot;
    robot.add_motor(1).version = version;
    FakeNode& late = robot.add_motor(2, "right motor");
    late.version = version;
    late.on = false;
    robot.network.expect(2);
    ASSERT_TRUE(robot.pass_until_ready(1));
    robot.pass(3 * kSecond);
    EXPECT_EQ(robot.network.node(2).state, NodeState::Absent);
    late.on = true;
    EXPECT_TRUE(robot.pass_until_ready(2)) << version;
    EXPECT_EQ(robot.network.node(1).generation, 1U);
  }
}

TEST(Network, FindsARobotThatIsSwitchedOnLate) {
  for (const int version : {4, 5}) {
    RobotOnBus robot;
    robot.pass(5 * kSecond);
    robot.add_motor(7).version = version;
    EXPECT_TRUE(robot.pass_until_ready(7)) << version;
  }
}

TEST(Network, LosesASilentNodeAndHasItBackWithinASecond) {
  for (const int version : {4, 5}) {
    RobotOnBus robot;
    FakeNode& motor = robot.add_motor();
    motor.version = version;
    ASSERT_TRUE(robot.pass_until_ready(1));
    robot.pass(5 * kSecond);
    EXPECT_TRUE(robot.network.node(1).ready());
    motor.on = false;
    EXPECT_TRUE(robot.pass_until([&] { return robot.network.node(1).state == NodeState::Lost; }, 2 * kSecond));
    const std::array<std::int16_t, 1> value = {9};
    EXPECT_FALSE(robot.network.write(1, 34, value));
    robot.pass(10 * kSecond);
    motor.on = true;
    ASSERT_TRUE(robot.pass_until_ready(1)) << version;
    EXPECT_EQ(robot.network.node(1).generation, 2U);
    EXPECT_EQ(robot.network.node(1).taken_ns(34), 0);  // what was read before means nothing now
    EXPECT_EQ(robot.network.node(1).statistics.times_lost, 1U);
  }
}

TEST(Network, NoticesANewFirmware) {
  RobotOnBus robot;
  FakeNode& motor = robot.add_motor();
  ASSERT_TRUE(robot.pass_until_ready(1));
  motor.on = false;
  robot.pass(2 * kSecond);
  motor.variables = {{"id", 1}, {"speed", 1}};
  motor.on = true;
  ASSERT_TRUE(robot.pass_until_ready(1));
  EXPECT_EQ(robot.network.node(1).description.variable("speed")->address, 1);
  EXPECT_EQ(robot.network.node(1).image.size(), 2U);
  // Also when it was never away: it says so to somebody else.
  motor.variables = {{"id", 1}, {"x", 5}, {"speed", 1}};
  motor.describe();
  EXPECT_TRUE(robot.pass_until([&] { return robot.network.node(1).generation == 3; }));
  EXPECT_EQ(robot.network.node(1).statistics.changed, 1U);
  EXPECT_EQ(robot.network.node(1).description.variable("speed")->address, 6);
}

TEST(Network, LivesWithASecondHost) {
  RobotOnBus robot;
  FakeNode& motor = robot.add_motor();
  FakeNode host(robot.bus.attach(), 0, "host", {});
  ASSERT_TRUE(robot.pass_until_ready(1));
  const std::uint64_t generation = robot.network.node(1).generation;
  for (int i = 0; i < 20; ++i) {
    host.say(0xA000, {4, 0});               // everybody describes himself
    host.say(0xA00B, {1, 0, 0, 0, 5, 0});   // somebody answers
    host.say(0xA00C, {1, 0, 35, 0, 7, 0});  // somebody obeys
    host.say(0x0005, {1, 0});
    robot.network.want(1, 34, 3);
    robot.pass(50 * kMs);
  }
  EXPECT_TRUE(robot.network.node(1).ready());
  EXPECT_EQ(robot.network.node(1).generation, generation);
  EXPECT_GE(robot.network.statistics().other_hosts, 80U);
  EXPECT_GT(robot.network.node(1).statistics.unasked, 0U);
  EXPECT_EQ(robot.network.node(1).value(35), 7);
  EXPECT_EQ(motor.memory[35], 7);
  Event event;
  ASSERT_TRUE(robot.network.take_event(event));
  EXPECT_EQ(event.source, 0);
}

TEST(Network, RefusesADescriptionThatLiesUntilItTellsTheTruth) {
  RobotOnBus robot;
  FakeNode& liar = robot.add_motor();
  liar.memory_words = 10;
  EXPECT_FALSE(robot.pass_until_ready(1, 3 * kSecond));
  EXPECT_EQ(robot.network.node(1).state, NodeState::Refused);
  EXPECT_THAT(robot.network.node(1).trouble, HasSubstr("reaches beyond 10 words"));
  EXPECT_GT(robot.network.node(1).statistics.impossible, 3U);
  EXPECT_LT(robot.network.node(1).statistics.impossible, 20U);
  EXPECT_FALSE(robot.network.want(1, 0, 1));
  liar.memory_words = -1;
  EXPECT_TRUE(robot.pass_until_ready(1));
  EXPECT_EQ(robot.network.node(1).trouble, "");

  RobotOnBus other;
  other.add_motor().announced = 9;  // more than it then names
  EXPECT_FALSE(other.pass_until_ready(1, 2 * kSecond));
  EXPECT_EQ(other.network.node(1).state, NodeState::Refused);
}

TEST(Network, CountsTwoNodesWithOneId) {
  RobotOnBus robot;
  robot.add_motor(1, "left motor");
  robot.add_motor(1, "right motor");
  robot.pass(2 * kSecond);
  EXPECT_GT(robot.network.node(1).statistics.doubled, 0U);
}

TEST(Network, ComesBackWithinASecondAfterABusOff) {
  RobotOnBus robot;
  for (std::uint8_t id = 1; id <= 9; ++id) robot.add_motor(id, "module " + std::to_string(id));
  for (std::uint8_t id = 1; id <= 9; ++id) ASSERT_TRUE(robot.pass_until_ready(id, 2 * kSecond));
  robot.bus.set_state(BusState::BusOff);
  robot.pass(kMs);
  EXPECT_EQ(robot.network.carrier(), Carrier::Down);
  for (std::uint8_t id = 1; id <= 9; ++id) EXPECT_EQ(robot.network.node(id).state, NodeState::Lost);
  robot.pass(3 * kSecond);
  robot.bus.set_state(BusState::Active);
  const hal::TimeNs back = robot.now;
  for (std::uint8_t id = 1; id <= 9; ++id) EXPECT_TRUE(robot.pass_until_ready(id, back + kSecond - robot.now));
  EXPECT_EQ(robot.network.statistics().carrier_losses, 1U);
}

TEST(Network, WritesNothingOldAfterABusOff) {
  RobotOnBus robot;
  FakeNode& motor = robot.add_motor();
  ASSERT_TRUE(robot.pass_until_ready(1));
  robot.bus.set_full(true);
  const std::array<std::int16_t, 1> fast = {72};
  robot.network.write(1, 34, fast);
  robot.pass(2 * kMs);
  robot.bus.set_state(BusState::BusOff);
  robot.pass(2 * kMs);
  robot.bus.set_full(false);
  robot.bus.set_state(BusState::Active);
  EXPECT_TRUE(robot.pass_until_ready(1));
  robot.pass(kSecond);
  EXPECT_EQ(motor.writes, 0);
}

TEST(Network, ServesEveryNodeWhenAskedForMoreThanTheBusCarries) {
  RobotOnBus robot;
  for (std::uint8_t id = 1; id <= 4; ++id) robot.add_motor(id, "module " + std::to_string(id));
  for (std::uint8_t id = 1; id <= 4; ++id) ASSERT_TRUE(robot.pass_until_ready(id, 2 * kSecond));
  for (std::int16_t i = 0; i < 5000; ++i) {
    const std::array<std::int16_t, 1> value = {i};
    for (std::uint8_t id = 1; id <= 4; ++id) {
      robot.network.write(id, 34, value);
      robot.network.want(id, 35, 2);
    }
    robot.pass(kMs);
  }
  for (std::uint8_t id = 1; id <= 4; ++id) {
    const Node& node = robot.network.node(id);
    EXPECT_TRUE(node.ready());
    EXPECT_EQ(node.statistics.times_lost, 0U);
    EXPECT_GT(node.statistics.writes, 500U);
    EXPECT_GT(node.statistics.answers, 80U);
    EXPECT_GT(node.taken_ns(35), robot.now - 100 * kMs);
    EXPECT_GT(robot.nodes[id - 1U]->memory[34], 4950);
  }
  EXPECT_EQ(robot.link.statistics().times_stuck, 0U);
}

TEST(Network, KeepsTheNewestEvents) {
  RobotOnBus robot;
  FakeNode& rab = robot.add(8, "range and bearing", {{"id", 1}});
  ASSERT_TRUE(robot.pass_until_ready(8));
  for (std::uint8_t i = 0; i < 100; ++i) {
    rab.say(i, {i, 0, 0xFF, 0xFF});
    robot.pass(kMs);
  }
  EXPECT_EQ(robot.network.statistics().events, 100U);
  EXPECT_EQ(robot.network.statistics().events_dropped, 100U - Network::kMostEvents);
  Event event;
  for (int i = 100 - static_cast<int>(Network::kMostEvents); i < 100; ++i) {
    ASSERT_TRUE(robot.network.take_event(event));
    EXPECT_EQ(event.number, i);
    EXPECT_EQ(event.source, 8);
    ASSERT_EQ(event.count, 2U);
    EXPECT_EQ(event.arguments[0], i);
    EXPECT_EQ(event.arguments[1], -1);
  }
  EXPECT_FALSE(robot.network.take_event(event));
}

TEST(Network, SendsEventsAndCommands) {
  RobotOnBus robot;
  const auto listener = robot.bus.attach();
  constexpr std::array<std::uint8_t, 6> kArguments = {1, 0, 2, 0, 3, 0};
  const aseba::Words arguments(kArguments);
  EXPECT_TRUE(robot.network.send(aseba::UserEvent{5, arguments}));
  EXPECT_TRUE(robot.network.send(aseba::Run{1}));
  EXPECT_FALSE(robot.network.send(aseba::UserEvent{0x8000, arguments}));
  CanFrame frame;
  ASSERT_TRUE(listener->receive(frame));
  EXPECT_TRUE(same_on_wire(frame, make_frame(0x300, std::array<std::uint8_t, 8>{5, 0, 1, 0, 2, 0, 3, 0})));
  ASSERT_TRUE(listener->receive(frame));
  EXPECT_TRUE(same_on_wire(frame, make_frame(0x300, std::array<std::uint8_t, 4>{3, 0xA0, 1, 0})));
}

TEST(Network, TellsWhatStoppedANodesProgram) {
  RobotOnBus robot;
  FakeNode& motor = robot.add_motor();
  ASSERT_TRUE(robot.pass_until_ready(1));
  motor.say(0x9006, {10, 0, 24, 0, 30, 0});
  robot.pass(2 * kMs);
  EXPECT_THAT(robot.network.node(1).trouble, HasSubstr("index 30 of an array of 24 at 10"));
  motor.say(0x9007, {11, 0});
  motor.say(0x9008, {12, 0});
  motor.say(0x9009, {13, 0, 3, 'h', 'o', 't'});
  robot.pass(2 * kMs);
  EXPECT_THAT(robot.network.node(1).trouble, HasSubstr("hot at 13"));
  EXPECT_EQ(robot.network.node(1).statistics.program_errors, 4U);
  EXPECT_THAT(robot.said.back(), HasSubstr("node 1 'left motor'"));
}

TEST(Network, BelievesASwitchThatANodeHasLeft) {
  RobotOnBus robot;
  FakeNode& motor = robot.add_motor();
  ASSERT_TRUE(robot.pass_until_ready(1));
  motor.say(0x9004, {});
  motor.on = false;
  robot.pass(2 * kMs);
  EXPECT_EQ(robot.network.node(1).state, NodeState::Lost);
}

}  // namespace
}  // namespace tandem::bridges::aseba
