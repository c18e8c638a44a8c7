// The threaded bridge and the guardian. Waits end with events; limits are longer than any machine needs.
#include <atomic>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include "bridges/aseba/node_bridge.hpp"
#include "bridges/footbot/driver.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/turret.hpp"
#include "hal/device/wheels.hpp"
#include "tests/bridges/footbot/fake_footbot.hpp"

namespace tandem::bridges::footbot {
namespace {

using BridgeSettings = aseba::NodeBridgeSettings<FootbotParts>;
using FootbotBridge = aseba::NodeBridge<FootbotParts>;

using testing::HasSubstr;

constexpr hal::TimeNs kLong = 20 * hal::kNsPerSecond;

/// A way to the bus that can be cut for good.
class Cable final : public CanLink {
 public:
  Cable(std::unique_ptr<CanLink> bus, const std::atomic<int>& cuts) : bus_(std::move(bus)), cuts_(cuts), made_(cuts) {}
  Sent send(const CanFrame& frame) noexcept override { return whole() ? bus_->send(frame) : Sent::Refused; }
  bool receive(CanFrame& frame) noexcept override { return whole() && bus_->receive(frame); }
  bool wait(hal::TimeNs timeout_ns) noexcept override { return bus_->wait(timeout_ns); }
  BusState state() const noexcept override { return whole() ? bus_->state() : BusState::Gone; }
  CanStatistics statistics() const noexcept override { return bus_->statistics(); }
  std::string name() const override { return "cable"; }

 private:
  bool whole() const noexcept { return cuts_ == made_; }
  std::unique_ptr<CanLink> bus_;
  const std::atomic<int>& cuts_;
  int made_;
};

/// Modules with a thread of their own, on a bus of the real time.
class LiveModules {
 public:
  template <class F>
  auto with(F&& f) {
    const std::lock_guard lock(mutex_);
    return f(modules_);
  }

  LiveModules() : modules_(bus) {
    modules_.add_all();
    thread_ = std::thread([this] {
      while (!ending_) {
        with([](FakeModules& m) { m.work(); });
        ::usleep(200);
      }
    });
  }
  ~LiveModules() {
    ending_ = true;
    thread_.join();
  }
  aseba::MessageLinkOpener opener() {
    return [this]() -> hal::Result<std::unique_ptr<aseba::MessageLink>> {
      if (!present) return hal::Error{"cannot open memory: there is no such bus"};
      return std::unique_ptr<aseba::MessageLink>(
          std::make_unique<aseba::CanMessages>(std::make_unique<Cable>(bus.attach(), cuts)));
    };
  }
  int speed(const char* side) {
    return with([&](FakeModules& m) { return static_cast<int>(m.word(side, "speed")); });
  }

  MemoryBus bus{monotonic_ns, 8192};
  std::atomic<bool> present{true};
  std::atomic<int> cuts{0};

 private:
  std::mutex mutex_;
  FakeModules modules_;
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

BridgeSettings settings() {
  BridgeSettings s;
  s.driver = Bench::default_settings();
  return s;
}

/// Ticks until `done`, at most `kLong`.
template <class F>
bool tick_until(FootbotBridge& bridge, F&& done) {
  const hal::TimeNs end = monotonic_ns() + kLong;
  for (hal::Tick tick = 0; monotonic_ns() < end; ++tick) {
    bridge.latch(tick, monotonic_ns());
    if (done()) return true;
    bridge.commit(monotonic_ns());
    ::usleep(10'000);
  }
  return false;
}

template <class F>
bool wait_until(F&& done) {
  for (const hal::TimeNs end = monotonic_ns() + kLong; monotonic_ns() < end; ::usleep(1000)) {
    if (done()) return true;
  }
  return false;
}

TEST(FootbotBridge, DrivesAndStopsAtItsEnd) {
  LiveModules live;
  {
    FootbotBridge bridge(settings(), live.opener());
    auto* wheels = static_cast<hal::WheelSpeeds*>(bridge.robot().require(hal::port_type<hal::WheelSpeeds>()));
    bridge.start();
    const hal::Status ready = bridge.wait_active(kLong);
    ASSERT_TRUE(ready.ok()) << ready.error().message;
    wheels->set(0.1, 0.2);
    EXPECT_TRUE(tick_until(bridge, [&] { return live.speed("left motor") == 24 && live.speed("right motor") == 48; }));
  }
  EXPECT_EQ(live.speed("left motor"), 0);
  EXPECT_EQ(live.speed("right motor"), 0);
}

TEST(FootbotBridge, IsNotActiveBeforeAllIsThereThatWasTaken) {
  LiveModules live;
  live.with([](FakeModules& m) { m["proximity sensors"].on = false; });
  FootbotBridge bridge(settings(), live.opener());
  (void)bridge.robot().require(hal::port_type<hal::Proximity>());
  bridge.start();
  EXPECT_TRUE(wait_until([&] {
    const auto nodes = bridge.status().nodes;
    return nodes[0].state == aseba::NodeState::Ready && nodes[1].state == aseba::NodeState::Ready;
  }));
  const hal::Status ready = bridge.wait_active(500 * hal::kNsPerMs);
  ASSERT_FALSE(ready.ok());
  EXPECT_THAT(ready.error().message, HasSubstr("node 'proximity sensors' (or 'prox') is not there"));
  live.with([](FakeModules& m) { m["proximity sensors"].on = true; });
  EXPECT_TRUE(bridge.wait_active(kLong).ok());
}

TEST(FootbotBridge, StopsTheRobotWhenTheLoopHangs) {
  LiveModules live;
  FootbotBridge bridge(settings(), live.opener());
  auto* wheels = static_cast<hal::WheelSpeeds*>(bridge.robot().require(hal::port_type<hal::WheelSpeeds>()));
  bridge.start();
  ASSERT_TRUE(bridge.wait_active(kLong).ok());
  wheels->set(0.1, 0.1);
  ASSERT_TRUE(tick_until(bridge, [&] { return live.speed("left motor") == 24; }));
  EXPECT_TRUE(wait_until([&] { return live.speed("left motor") == 0 && live.speed("right motor") == 0; }));
  EXPECT_TRUE(wait_until([&] { return bridge.status().at_rest; }));
}

TEST(FootbotBridge, StopsAtOnceWhenAskedTo) {
  LiveModules live;
  FootbotBridge bridge(settings(), live.opener());
  auto* wheels = static_cast<hal::WheelSpeeds*>(bridge.robot().require(hal::port_type<hal::WheelSpeeds>()));
  bridge.start();
  ASSERT_TRUE(bridge.wait_active(kLong).ok());
  wheels->set(0.1, 0.1);
  ASSERT_TRUE(tick_until(bridge, [&] { return live.speed("left motor") == 24; }));
  bridge.stop(monotonic_ns());
  EXPECT_TRUE(wait_until([&] { return live.speed("left motor") == 0; }));
  EXPECT_TRUE(bridge.status().stopped);
}

TEST(FootbotBridge, TellsARestartAsAStopOfTheRobotsOwnAndRenewsTheStopMessages) {
  LiveModules live;
  live.with([](FakeModules& m) { m["turret"].on = false; });
  FootbotBridge bridge(settings(), live.opener());
  auto* wheels = static_cast<hal::WheelSpeeds*>(bridge.robot().require(hal::port_type<hal::WheelSpeeds>()));
  (void)bridge.robot().require(hal::port_type<hal::TurretDrive>());
  bridge.start();
  ASSERT_TRUE(wait_until([&] { return !bridge.stop_messages().body.empty(); }));
  const StopMessages early = bridge.stop_messages();
  live.with([](FakeModules& m) { m["turret"].on = true; });
  ASSERT_TRUE(bridge.wait_active(kLong).ok());
  wheels->set(0.1, 0.1);
  ASSERT_TRUE(tick_until(bridge, [&] { return live.speed("left motor") == 24; }));
  const StopMessages late = bridge.stop_messages();
  EXPECT_GT(late.version, early.version);
  EXPECT_EQ(bridge.stop_version(), late.version);
  EXPECT_GT(std::ranges::count(late.body, '\n'), std::ranges::count(early.body, '\n')) << late.body;
  live.with([](FakeModules& m) { m.word("left motor", "odo") = 5000; });
  const hal::TimeNs later = monotonic_ns() + hal::kNsPerSecond;
  ASSERT_TRUE(tick_until(bridge, [&] { return monotonic_ns() > later; }));  // the counter was read
  EXPECT_FALSE(bridge.stopped_itself());
  live.with([](FakeModules& m) { m["left motor"].memory.assign(m["left motor"].memory.size(), 0); });
  EXPECT_TRUE(tick_until(bridge, [&] { return bridge.stopped_itself(); }));
  bridge.commit(monotonic_ns());
  bridge.latch(1, monotonic_ns());
  EXPECT_FALSE(bridge.stopped_itself());  // told once
  EXPECT_EQ(bridge.statistics().restarts, 1U);
  // One that was away for long describes itself anew: the guardian is told, whether it has the same to say or not.
  const std::uint64_t before = bridge.stop_version();
  live.with([](FakeModules& m) { m["left motor"].on = false; });
  ASSERT_TRUE(tick_until(bridge, [&] { return bridge.state() == RobotState::Lost; }));
  live.with([](FakeModules& m) { m["left motor"].on = true; });
  ASSERT_TRUE(tick_until(bridge, [&] { return bridge.state() == RobotState::Active; }));
  EXPECT_GT(bridge.stop_version(), before);
}

TEST(FootbotBridge, ComesBackWhenTheCableIsInAgain) {
  LiveModules live;
  FootbotBridge bridge(settings(), live.opener());
  auto* wheels = static_cast<hal::WheelSpeeds*>(bridge.robot().require(hal::port_type<hal::WheelSpeeds>()));
  bridge.start();
  ASSERT_TRUE(bridge.wait_active(kLong).ok());
  wheels->set(0.1, 0.1);
  ASSERT_TRUE(tick_until(bridge, [&] { return live.speed("left motor") == 24; }));
  live.present = false;
  ++live.cuts;
  EXPECT_TRUE(tick_until(bridge, [&] { return bridge.state() == RobotState::Lost; }));
  EXPECT_TRUE(tick_until(bridge, [&] { return bridge.status().trouble.find("no such bus") != std::string::npos; }));
  live.present = true;
  EXPECT_TRUE(tick_until(bridge, [&] { return bridge.state() == RobotState::Active; }));
  EXPECT_TRUE(tick_until(bridge, [&] { return live.speed("left motor") == 24; }));
  EXPECT_GE(bridge.status().links_opened, 2U);
}

TEST(FootbotBridge, SaysWhyItDoesNotStart) {
  LiveModules live;
  live.present = false;
  FootbotBridge bridge(settings(), live.opener());
  bridge.start();
  ASSERT_TRUE(wait_until([&] { return !bridge.status().link_trouble.empty(); }));
  const hal::Status ready = bridge.wait_active(hal::kNsPerMs);
  ASSERT_FALSE(ready.ok());
  EXPECT_EQ(ready.error().message, "foot-bot 'fb' is not there: cannot open memory: there is no such bus");
}

}  // namespace
}  // namespace tandem::bridges::footbot
