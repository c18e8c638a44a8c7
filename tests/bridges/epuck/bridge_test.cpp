// The threaded bridge over links in memory; the scripted robot has a thread of its own. Waits end with events.
#include "bridges/epuck/bridge.hpp"

#include <gmock/gmock.h>

#include "bridges/epuck/conversions.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"
#include "hal/robot/epuck.hpp"
#include "tests/bridges/epuck/scripted_robot.hpp"
#include "tests/bridges/link/memory_link.hpp"

namespace tandem::bridges::epuck {
namespace {

const Conversions kUnits{hal::epuck::kind()};

using testing::HasSubstr;

constexpr hal::TimeNs kLong = 20 * hal::kNsPerSecond;

/// A robot that can be plugged in and out; each plugging makes a new link.
class LiveRobot {
 public:
  ~LiveRobot() { unplug(); }

  LinkOpener opener() {
    return [this]() -> hal::Result<std::unique_ptr<ByteLink>> {
      const std::lock_guard lock(mutex_);
      if (!present_) return hal::Error{"cannot open memory: there is no such device"};
      if (thread_.joinable()) thread_.join();
      auto [near, far] = MemoryLink::make_pair();
      far_ = std::move(far);
      thread_ = std::thread([this, link = far_.get()] { serve(*link); });
      return std::unique_ptr<ByteLink>(std::move(near));
    };
  }
  void plug_in() {
    const std::lock_guard lock(mutex_);
    present_ = true;
  }
  void unplug() {
    {
      const std::lock_guard lock(mutex_);
      present_ = false;
      if (far_) far_->hang_up();
    }
    if (thread_.joinable()) thread_.join();
  }
  template <class F>
  auto with(F&& f) {
    const std::lock_guard lock(robot_mutex_);
    return f(robot_);
  }

 private:
  void serve(MemoryLink& link) {
    std::array<std::uint8_t, 256> buffer;
    while (true) {
      link.wait(hal::kNsPerSecond);
      for (Received r = link.read(buffer); r.size > 0; r = link.read(buffer)) {
        const std::lock_guard lock(robot_mutex_);
        link.write(robot_.hear(std::span(buffer.data(), r.size)), 0);
      }
      if (link.state() == LinkState::HungUp) return;
    }
  }

  std::mutex mutex_, robot_mutex_;
  bool present_ = true;
  std::unique_ptr<MemoryLink> far_;
  std::thread thread_;
  ScriptedRobot robot_;
};

BridgeSettings quick() {
  BridgeSettings settings;
  settings.reopen_ns = 5 * hal::kNsPerMs;
  return settings;
}

/// Ticks until `done`, at most `kLong`.
template <class F>
bool tick_until(EpuckBridge& bridge, F&& done) {
  const hal::TimeNs end = monotonic_ns() + kLong;
  for (hal::Tick tick = 0; monotonic_ns() < end; ++tick) {
    bridge.latch(tick, monotonic_ns());
    bridge.commit(monotonic_ns());
    if (done()) return true;
    std::this_thread::yield();
  }
  return false;
}

TEST(EpuckBridge, BecomesActiveDrivesAndLeavesTheRobotStopped) {
  LiveRobot live;
  live.with([](ScriptedRobot& r) { r.proximity[0] = 4095; });
  {
    EpuckBridge bridge(quick(), live.opener());
    const auto& proximity = bridge.robot().sensor<hal::Proximity>();
    auto& wheels = bridge.robot().actuator<hal::WheelSpeeds>();
    bridge.start();
    const hal::Status ready = bridge.wait_active(kLong);
    ASSERT_TRUE(ready.ok()) << ready.error().message;
    wheels.set(0.05, 0.02);
    EXPECT_TRUE(tick_until(bridge, [&] { return live.with([](ScriptedRobot& r) { return r.left != 0; }); }));
    EXPECT_TRUE(tick_until(
        bridge, [&] { return proximity.validity == hal::Validity::Fresh && proximity.distance_m[0] == 0.0F; }));
    const BridgeStatus status = bridge.status();
    EXPECT_EQ(status.identity.firmware, Firmware::GCtronic);
    EXPECT_GT(status.bytes.bytes_in, 0U);
    EXPECT_EQ(status.links_opened, 1U);
  }
  EXPECT_EQ(live.with([](ScriptedRobot& r) { return r.left; }), 0);
  EXPECT_EQ(live.with([](ScriptedRobot& r) { return r.right; }), 0);
}

TEST(EpuckBridge, ComesBackByItselfWhenTheRobotIsPluggedInAgain) {
  LiveRobot live;
  EpuckBridge bridge(quick(), live.opener());
  auto& wheels = bridge.robot().actuator<hal::WheelSpeeds>();
  bridge.start();
  ASSERT_TRUE(bridge.wait_active(kLong).ok());
  wheels.set(0.05, 0.05);
  live.unplug();
  EXPECT_TRUE(tick_until(bridge, [&] { return bridge.state() == SessionState::Lost; }));
  live.plug_in();
  const int full = kUnits.to_steps_per_s(0.05).value;
  EXPECT_TRUE(tick_until(bridge, [&] { return live.with([&](ScriptedRobot& r) { return r.left == full; }); }));
  EXPECT_EQ(bridge.status().links_opened, 2U);
  EXPECT_EQ(bridge.status().driver.rearmed, 1U);
  bridge.shut_down();
  EXPECT_EQ(live.with([](ScriptedRobot& r) { return r.left; }), 0);
}

TEST(EpuckBridge, SaysWhyTheRobotIsNotThere) {
  LiveRobot live;
  live.unplug();
  EpuckBridge bridge(quick(), live.opener());
  bridge.start();
  while (bridge.status().trouble.empty()) std::this_thread::yield();
  const hal::Status ready = bridge.wait_active(0);
  ASSERT_FALSE(ready.ok());
  EXPECT_THAT(ready.error().message, HasSubstr("no such device"));
}

TEST(EpuckBridge, StopsTheRobotWhenTold) {
  LiveRobot live;
  EpuckBridge bridge(quick(), live.opener());
  auto& wheels = bridge.robot().actuator<hal::WheelSpeeds>();
  bridge.start();
  ASSERT_TRUE(bridge.wait_active(kLong).ok());
  wheels.set(0.05, 0.05);
  EXPECT_TRUE(tick_until(bridge, [&] { return live.with([](ScriptedRobot& r) { return r.left != 0; }); }));
  bridge.stop(monotonic_ns());
  EXPECT_TRUE(
      tick_until(bridge, [&] { return live.with([](ScriptedRobot& r) { return r.left == 0 && r.stops >= 2; }); }));
  EXPECT_TRUE(bridge.status().stopped);
}

TEST(EpuckBridge, EndsWhileALinkIsStillBeingOpened) {
  LiveRobot live;
  EpuckBridge bridge(quick(), []() { return hal::Result<std::unique_ptr<ByteLink>>(hal::Error{"busy"}); });
  bridge.start();
  bridge.shut_down();
  EXPECT_NE(bridge.state(), SessionState::Active);
}

TEST(EpuckTiming, WaitsLongerForBluetooth) {
  EXPECT_EQ(timing_for("serial:/dev/rfcomm0@115200").answer_ns, 500 * hal::kNsPerMs);
  EXPECT_EQ(timing_for("serial:/dev/ttyUSB0@115200").answer_ns, 100 * hal::kNsPerMs);
}

}  // namespace
}  // namespace tandem::bridges::epuck
