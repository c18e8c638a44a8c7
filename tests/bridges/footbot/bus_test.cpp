// The foot-bot's bridge on its bus: load, discovery, faults, other hosts, nodes that lie.
#include <gmock/gmock.h>

#include "hal/device/body_sensors.hpp"
#include "hal/device/distance_scanner.hpp"
#include "hal/device/gripper.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/turret.hpp"
#include "hal/device/wheels.hpp"
#include "tests/bridges/can/frame_bits.hpp"
#include "tests/bridges/can/frames.hpp"
#include "tests/bridges/footbot/fake_footbot.hpp"

namespace tandem::bridges::footbot {
namespace {

using hal::Validity;
using testing::HasSubstr;

/// Whether the readings of a port are fresh.
Validity validity(Bench& robot, const hal::PortType& type) {
  return static_cast<const hal::Reading*>(robot.driver.robot().require(type))->validity;
}

TEST(FootbotBus, TakesAtMostAQuarterWithEveryPortAtTenTicksASecond) {
  Bench robot;
  robot.modules.add_all();
  const auto present = robot.driver.robot().present();
  EXPECT_EQ(present.size(), port_types().size());
  for (const hal::PortType* type : present) (void)robot.driver.robot().require(*type);
  auto listener = robot.bus.attach();
  ASSERT_TRUE(robot.tick_until(RobotState::Active));
  CanFrame frame;
  while (listener->receive(frame)) {
  }
  std::size_t bits = 0, busiest = 0;
  FakeNode& radio = robot.modules["range and bearing"];
  for (int second = 0; second < 5; ++second) {
    std::size_t in_second = 0;
    for (int i = 0; i < 10; ++i) {
      robot.tick([&] {
        // Everything changes in every tick: nothing is saved by being what it was.
        const double x = 0.01 * (second * 10 + i);
        robot.actuator<hal::WheelSpeeds>().set(x / 3, -x / 3);
        robot.actuator<hal::TurretDrive>().go_to(x);
        robot.actuator<hal::GripperDrive>().aperture_rad = x;
        robot.actuator<hal::ScannerDrive>().go_to(x);
        robot.actuator<hal::RingLeds>().set_all({static_cast<std::uint8_t>(i), 0, static_cast<std::uint8_t>(second)});
        auto& send = robot.actuator<hal::RangeAndBearingSend>();
        send.sending = true;
        send.size = 10;
        send.payload.fill(static_cast<std::uint8_t>(i));
        for (int n = 0; n < 16; ++n) radio.say(0, FakeNode::Bytes(16, static_cast<std::uint8_t>(n)));
      });
    }
    while (listener->receive(frame)) in_second += frame_bits(frame);
    bits += in_second;
    busiest = std::max(busiest, in_second);
  }
  for (const hal::PortType* type : present) {
    if (type->role != hal::Role::Sensor) continue;
    EXPECT_EQ(validity(robot, *type), Validity::Fresh) << type->name;
  }
  RecordProperty("bits_a_second", static_cast<int>(bits / 5));
  EXPECT_GT(bits / 5, 20'000U);  // it does talk
  EXPECT_LE(busiest, 250'000U) << "of 1,000,000 bits a second";
}

TEST(FootbotBus, HasOneQuestionOpenANode) {
  Bench robot;
  robot.modules.add_all();
  robot.sensor<hal::Proximity>();
  robot.sensor<hal::Battery>();
  ASSERT_TRUE(robot.tick_until(RobotState::Active));
  FakeNode& node = robot.modules["proximity sensors"];
  node.answers_reads = false;
  node.reads = 0;
  robot.driver.commit(robot.now);
  node.work();
  for (int i = 0; i < 9; ++i) {
    robot.pass(10 * kMs);
    robot.driver.commit(robot.now);
  }
  EXPECT_EQ(node.reads, 1);  // nine more ticks, and the first question is still open
}

TEST(FootbotBus, FindsModulesThatComeLate) {
  Bench robot;
  robot.modules.add_all();
  robot.sensor<hal::Proximity>();
  robot.actuator<hal::WheelSpeeds>();
  for (const auto& node : robot.modules.nodes) node->on = false;
  for (int i = 0; i < 10; ++i) robot.tick();
  EXPECT_EQ(robot.driver.state(), RobotState::Searching);
  EXPECT_THAT(robot.driver.trouble(), HasSubstr("node 'left motor' (or 'wheel left') is not there"));
  robot.modules["left motor"].on = robot.modules["right motor"].on = true;
  for (int i = 0; i < 10; ++i) robot.tick();
  EXPECT_EQ(robot.driver.state(), RobotState::Searching);
  EXPECT_THAT(robot.driver.trouble(), HasSubstr("'proximity sensors'"));
  robot.modules["proximity sensors"].on = true;
  EXPECT_TRUE(robot.tick_until(RobotState::Active, 10)) << robot.driver.trouble();
}

TEST(FootbotBus, FindsOldModulesToo) {
  Bench robot;
  robot.modules.add_all();
  for (const auto& node : robot.modules.nodes) node->version = 4;
  robot.modules["right motor"].on = false;
  robot.actuator<hal::WheelSpeeds>();
  for (int i = 0; i < 10; ++i) robot.tick();
  EXPECT_EQ(robot.driver.state(), RobotState::Searching);
  robot.modules["right motor"].on = true;
  EXPECT_TRUE(robot.tick_until(RobotState::Active, 10)) << robot.driver.trouble();
}

TEST(FootbotBus, FindsOtherNumbersAndAddresses) {
  Bench robot;
  // Nothing is where it usually is.
  robot.modules.add("Wheel_Left", {{"pad", 7}, {"odometer", 2}, {"speed.target", 1}}, 200);
  robot.modules.add("WHEEL-RIGHT", {{"speed", 1}, {"pad", 100}, {"odo", 2}}, 1);
  robot.actuator<hal::WheelSpeeds>().set(0.1, 0.2);
  const auto& encoders = robot.sensor<hal::WheelEncoders>();
  ASSERT_TRUE(robot.tick_until(RobotState::Active)) << robot.driver.trouble();
  robot.tick();
  robot.modules.word("Wheel_Left", "odometer") = 480;
  robot.tick();
  robot.tick();
  EXPECT_EQ(robot.modules.word("Wheel_Left", "speed.target"), 24);
  EXPECT_EQ(robot.modules.word("WHEEL-RIGHT", "speed"), 48);
  EXPECT_NEAR(encoders.left_m, 480 / 48312.0, 1e-9);
  EXPECT_EQ(robot.driver.wiring().nodes()[0].id, 200);
}

TEST(FootbotBus, RunsARobotOfOtherNamesWithAnotherMap) {
  DriverSettings settings;
  settings.map = map_of(R"(<footbot_map><node names="drive" needed="always">
<variable names="v" words="2" verify="true">
<write port="differential_steering" field="left" word="1" count="1" scale="1 mm/s" rest="0"/>
<write port="differential_steering" field="right" word="0" count="1" scale="-1 mm/s"/></variable></node>
<node names="eyes"><variable names="ir" words="4">
<read port="proximity" field="distance" word="3" word_step="-1" count="4"><knot raw="0" value="10 cm"/><knot raw="100" value="0"/></read>
</variable></node></footbot_map>)");
  Bench robot(settings);
  robot.modules.add("drive", {{"v", 2}});
  robot.modules.add("eyes", {{"ir", 4}});
  robot.actuator<hal::WheelSpeeds>().set(0.123, 0.045);
  const auto& proximity = robot.sensor<hal::Proximity>();
  robot.modules.word("eyes", "ir", 3) = 50;
  ASSERT_TRUE(robot.tick_until(RobotState::Active)) << robot.driver.trouble();
  robot.tick();
  robot.tick();
  EXPECT_EQ(robot.modules.word("drive", "v", 1), 123);
  EXPECT_EQ(robot.modules.word("drive", "v", 0), -45);
  EXPECT_EQ(proximity.count, 4U);
  EXPECT_FLOAT_EQ(proximity.distance_m[0], 0.05F);
  EXPECT_FLOAT_EQ(proximity.distance_m[3], 0.1F);
  EXPECT_THROW(robot.sensor<hal::Light>(), hal::DeviceError);  // no variable is for it
}

TEST(FootbotBus, RefusesVariablesOfOtherSizes) {
  Bench robot;
  robot.modules.add_all();
  robot.modules["left motor"].variables.back().second = 4;  // odo
  robot.modules["left motor"].memory.resize(64);
  robot.actuator<hal::WheelSpeeds>().set(0.1, 0.1);
  for (int i = 0; i < 10; ++i) robot.tick();
  EXPECT_EQ(robot.driver.state(), RobotState::Searching);
  EXPECT_THAT(robot.driver.trouble(), HasSubstr("node 'left motor': variable 'odo' has 4 words, in the map (line"));
  EXPECT_EQ(robot.modules.word("right motor", "speed"), 0);
}

TEST(FootbotBus, NamesVariablesThatAreMissing) {
  Bench robot;
  robot.modules.add_all();
  robot.modules["gripper"].variables.pop_back();
  const auto& gripper = robot.sensor<hal::Gripper>();
  for (int i = 0; i < 10; ++i) robot.tick();
  EXPECT_EQ(robot.driver.state(), RobotState::Searching);
  EXPECT_EQ(robot.driver.trouble(), "node 'gripper': has no variable 'gripper.busy'");
  EXPECT_EQ(gripper.validity, Validity::Absent);
}

TEST(FootbotBus, FindsModulesAnewThatWereProgrammedOtherwise) {
  Bench robot;
  robot.modules.add_all();
  robot.actuator<hal::WheelSpeeds>().set(0.1, 0.1);
  ASSERT_TRUE(robot.tick_until(RobotState::Active));
  for (int i = 0; i < 8; ++i) robot.tick();
  FakeNode& motor = robot.modules["left motor"];
  motor.on = false;
  for (int i = 0; i < 15; ++i) robot.tick();
  motor.variables.insert(motor.variables.begin() + 3, {"new", 10});
  motor.memory.assign(static_cast<std::size_t>(motor.words()), 0);
  motor.on = true;
  ASSERT_TRUE(robot.tick_until(RobotState::Active, 10)) << robot.driver.trouble();
  for (int i = 0; i < 8; ++i) robot.tick();
  EXPECT_EQ(motor.memory[34], 0);
  EXPECT_EQ(motor.memory[44], 24);
  EXPECT_EQ(robot.driver.wiring().nodes()[0].times_wired, 2U);
}

TEST(FootbotBus, BelievesNoLies) {
  Bench robot;
  robot.modules.add_all();
  robot.actuator<hal::WheelSpeeds>().set(0.1, 0.1);
  robot.modules["left motor"].announced = 60000;                         // variables
  robot.modules.add("right motor", {{"speed", 1}, {"odo", 30000}}, 90);  // beyond its memory, under another's name
  robot.modules.nodes.back()->memory_words = 100;
  robot.modules.add(std::string(255, 'x'), {{std::string(255, 'y'), 1}}, 91);
  for (int i = 0; i < 20; ++i) robot.tick();
  EXPECT_EQ(robot.driver.state(), RobotState::Searching);
  EXPECT_EQ(robot.modules.word("right motor", "speed"), 0);
  robot.modules["left motor"].announced = -1;
  EXPECT_TRUE(robot.tick_until(RobotState::Active, 10)) << robot.driver.trouble();
}

TEST(FootbotBus, LivesWithASecondHost) {
  Bench robot;
  robot.modules.add_all();
  const auto& proximity = robot.sensor<hal::Proximity>();
  robot.actuator<hal::WheelSpeeds>().set(0.1, 0.1);
  ASSERT_TRUE(robot.tick_until(RobotState::Active));
  auto other = robot.bus.attach();
  for (int i = 0; i < 50; ++i) {
    // Reads the same node at the same time, and sets the wheels as it likes.
    const std::array<std::uint8_t, 8> question = {0x0B, 0xA0, 3, 0, 34, 0, 24, 0};
    const std::array<std::uint8_t, 8> command = {0x0C, 0xA0, 1, 0, 34, 0, 72, 0};
    other->send(make_frame(0x300, question));
    other->send(make_frame(0x300, command));
    robot.modules.word("proximity sensors", "bumpers", 0) = static_cast<std::int16_t>(i);
    robot.tick();
    EXPECT_EQ(robot.driver.state(), RobotState::Active);
  }
  robot.tick();
  EXPECT_EQ(proximity.validity, Validity::Fresh);
  EXPECT_EQ(robot.modules.word("left motor", "speed"), 24);  // written again as it was read back wrong
  EXPECT_GT(robot.driver.network().statistics().other_hosts, 50U);
  EXPECT_GT(robot.driver.wiring().statistics().not_obeyed, 20U);
}

class FootbotFaults : public testing::TestWithParam<CanFaults> {};

TEST_P(FootbotFaults, NeverShowWrongReadingsNorLeaveItDriving) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    CanFaults faults = GetParam();
    faults.seed = seed;
    Bench robot(Bench::default_settings(), faults);
    robot.modules.add_all();
    const auto& proximity = robot.sensor<hal::Proximity>();
    auto& wheels = robot.actuator<hal::WheelSpeeds>();
    for (int i = 0; i < 24; ++i)
      robot.modules.word("proximity sensors", "bumpers", static_cast<std::size_t>(i)) = 41 * 24;
    int fresh = 0, active = 0;
    for (int i = 0; i < 100; ++i) {
      robot.tick([&] { wheels.set(0.1, 0.1); });
      active += robot.driver.state() == RobotState::Active ? 1 : 0;
      fresh += proximity.validity == Validity::Fresh ? 1 : 0;
      if (proximity.validity == Validity::Absent) continue;
      for (std::size_t k = 0; k < 24; ++k) ASSERT_FLOAT_EQ(proximity.distance_m[k], 0.1F - 984.0F / 40960.0F);
      ASSERT_LE(robot.modules.word("left motor", "speed"), 24);
      ASSERT_GE(robot.modules.word("left motor", "speed"), 0);
    }
    EXPECT_GT(active, 20) << "seed " << seed;
    EXPECT_GT(fresh, 20) << "seed " << seed;
    robot.driver.stop(robot.now);
    for (int i = 0; i < 40 && !robot.driver.at_rest(); ++i) robot.pass(100 * kMs);
    EXPECT_TRUE(robot.driver.at_rest()) << "seed " << seed << "\n" << robot.driver.trouble() << "\n" << robot.said;
    EXPECT_EQ(robot.modules.word("left motor", "speed"), 0);
    EXPECT_EQ(robot.modules.word("right motor", "speed"), 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, FootbotFaults,
                         testing::Values(CanFaults{.loss = 0.02}, CanFaults{.doubling = 0.05},
                                         CanFaults{.reordering = 0.02},
                                         CanFaults{.lateness = 0.02, .late_ns = 30 * kMs},
                                         CanFaults{.bus_off = 0.05, .bus_off_slot_ns = 100 * kMs}));

}  // namespace
}  // namespace tandem::bridges::footbot
