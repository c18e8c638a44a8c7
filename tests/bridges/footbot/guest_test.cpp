// The whole bridge on the kernel's own CAN: modules with sockets of their own on vcan0. Runs in the guest that
// tests/bridges/can/in_guest.sh makes.
#include <gmock/gmock.h>

#include "bridges/aseba/message_link_text.hpp"
#include "bridges/aseba/node_bridge.hpp"
#include "bridges/can/socketcan_link.hpp"
#include "bridges/footbot/driver.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"
#include "tests/bridges/can/guest_process.hpp"
#include "tests/bridges/footbot/fake_footbot.hpp"

namespace tandem::bridges::footbot {
namespace {

using BridgeSettings = aseba::NodeBridgeSettings<FootbotParts>;
using FootbotBridge = aseba::NodeBridge<FootbotParts>;

constexpr hal::TimeNs kLong = 60 * hal::kNsPerSecond;  // the guest shares a processor with whatever else runs

/// Modules, and a bridge that reaches them by `link`; both are served by the test.
struct OnTheKernelsBus {
  OnTheKernelsBus()
      : modules([] {
          auto link = SocketCanLink::open("vcan0");
          EXPECT_TRUE(link.ok()) << link.error().message;
          return std::move(link).value();
        }),
        bridge(BridgeSettings{Bench::default_settings()}, aseba::message_link_opener("can:vcan0").value()) {
    modules.add_all();
    wheels = static_cast<hal::WheelSpeeds*>(bridge.robot().require(hal::port_type<hal::WheelSpeeds>()));
    proximity = static_cast<hal::Proximity*>(bridge.robot().require(hal::port_type<hal::Proximity>()));
    bridge.start();
  }
  /// Ticks, while the modules work, until it holds.
  template <class F>
  bool tick_until(F&& holds) {
    hal::TimeNs next = 0;
    for (const hal::TimeNs end = monotonic_ns() + kLong; monotonic_ns() < end; ::usleep(500)) {
      modules.work();
      if (monotonic_ns() < next) continue;
      next = monotonic_ns() + 100 * kMs;
      bridge.latch(++tick, monotonic_ns());
      if (holds()) return true;
      bridge.commit(monotonic_ns());
    }
    return false;
  }

  FakeModules modules;
  FootbotBridge bridge;
  hal::WheelSpeeds* wheels;
  hal::Proximity* proximity;
  hal::Tick tick = 0;
};

TEST(FootbotOnSocketCan, DrivesReadsAndComesBackWhenTheInterfaceDoes) {
  OnTheKernelsBus robot;
  robot.modules.word("proximity sensors", "bumpers", 3) = 2048;
  ASSERT_TRUE(robot.tick_until([&] { return robot.bridge.state() == RobotState::Active; }))
      << robot.bridge.status().trouble;
  robot.wheels->set(0.1, 0.2);
  EXPECT_TRUE(robot.tick_until([&] { return robot.modules.word("right motor", "speed") == 48; }));
  EXPECT_TRUE(robot.tick_until([&] { return robot.proximity->validity == hal::Validity::Fresh; }));
  EXPECT_FLOAT_EQ(robot.proximity->distance_m[3], 0.05F);

  shell("ip link set vcan0 down");
  EXPECT_TRUE(robot.tick_until([&] { return robot.bridge.state() == RobotState::Lost; }));
  EXPECT_TRUE(robot.tick_until([&] { return robot.proximity->validity == hal::Validity::Stale; }));  // as its age grows
  shell("ip link set vcan0 up");
  bool rested = false;
  EXPECT_TRUE(robot.tick_until([&] {
    rested = rested || robot.modules.word("right motor", "speed") == 0;
    return robot.bridge.state() == RobotState::Active;
  })) << robot.bridge.status().trouble;
  EXPECT_TRUE(rested);
  EXPECT_TRUE(robot.tick_until([&] { return robot.modules.word("right motor", "speed") == 48; }));
  robot.bridge.stop(monotonic_ns());
  EXPECT_TRUE(robot.tick_until([&] { return robot.bridge.status().at_rest; }));
  EXPECT_EQ(robot.modules.word("right motor", "speed"), 0);
}

}  // namespace
}  // namespace tandem::bridges::footbot
