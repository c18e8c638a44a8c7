// The whole bridge with its thread, over LCM: in memory against a scripted robot, and on a network of its own against a
// robot in Python that knows nothing of our code.
#include "bridges/eyebot/bridge.hpp"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <gmock/gmock.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include "bridges/eyebot/stopper.hpp"
#include "bridges/eyebot_messages/codec.hpp"
#include "hal/device/flight.hpp"
#include "tests/bridges/eyebot/scripted_robot.hpp"
#include "tests/bridges/lcm/witness.hpp"
#include "tests/checkout.hpp"

namespace tandem::bridges::eyebot {
namespace {

using lcm_bus::LcmLink;
using lcm_bus::LcmMessage;
using testing::HasSubstr;

/// The scripted robot with a thread of its own, on a link.
class LivingRobot {
 public:
  explicit LivingRobot(std::shared_ptr<LcmLink> link, std::string name = "eb0")
      : link_(std::move(link)), name_(std::move(name)) {
    const auto obey = [state = state_, link = std::weak_ptr(link_), name = name_](const LcmMessage& m) {
      messages::CmdMode order{};
      if (messages::decode(m.data, order) != messages::Flaw::None) return;
      const std::lock_guard lock(state->mutex);
      state->obey(order);
      if (const auto l = link.lock()) state->acknowledge(*l, name, order);
    };
    const auto fly = [state = state_](const LcmMessage& m) {
      const std::lock_guard lock(state->mutex);
      messages::CmdVelocity velocity{};
      if (messages::decode(m.data, velocity) == messages::Flaw::None) state->velocity_x = velocity.vel[0];
    };
    EXPECT_TRUE(link_->subscribe("eyebot/" + name_ + "/cmd/mode", obey).ok());
    EXPECT_TRUE(link_->subscribe("eyebot/" + name_ + "/cmd/velocity", fly).ok());
    EXPECT_TRUE(link_->start().ok());
    thread_ = std::thread([this] { live(); });
  }
  ~LivingRobot() {
    ending_ = true;
    thread_.join();
  }

  struct State {
    std::mutex mutex;
    std::vector<int> obeyed;
    double velocity_x = 0.0;
    messages::Status status{};
    std::int32_t acks = 0;

    messages::Header last_order{};

    void obey(const messages::CmdMode& m) {
      obeyed.push_back(m.action);
      last_order = m.hdr;
      using S = messages::Status;
      using C = messages::CmdMode;
      if (m.action == C::ACT_ARM) status.armed = 1;
      if (m.action == C::ACT_DISARM) status.armed = 0;
      if (m.action == C::ACT_TAKEOFF || m.action == C::ACT_HOVER) status.mode = S::MODE_HOVER;
      if (m.action == C::ACT_LAND) status.mode = S::MODE_IDLE;
    }
    void acknowledge(LcmLink& link, const std::string& name, const messages::CmdMode& m) {
      messages::Ack ack{};
      ack.hdr.session = 55;
      ack.hdr.seq = acks++;
      ack.hdr.utime = unix_ns() / 1000;
      ack.channel = "eyebot/" + name + "/cmd/mode";
      ack.cmd_session = m.hdr.session;
      ack.cmd_seq = m.hdr.seq;
      std::array<std::byte, 256> buffer{};
      (void)link.publish("eyebot/" + name + "/ack", messages::encode(ack, buffer));
    }
  };
  struct Seen {
    std::vector<int> obeyed;
    messages::Status status;
    double velocity_x = 0.0;
    messages::Header last_order;
  };
  Seen seen() {
    const std::lock_guard lock(state_->mutex);
    return {state_->obeyed, state_->status, state_->velocity_x, state_->last_order};
  }

 private:
  template <class Message>
  void say(const char* topic, Message& m) {
    m.hdr.session = 55;
    m.hdr.utime = unix_ns() / 1000;
    std::array<std::byte, 512> buffer{};
    (void)link_->publish("eyebot/" + name_ + "/" + topic, messages::encode(m, buffer));
    ++m.hdr.seq;
  }
  void live() {
    messages::Heartbeat heartbeat{};
    heartbeat.name = name_;
    heartbeat.proto_major = 1;
    heartbeat.period_ms = 200;
    messages::State place{};
    place.quat[0] = 1.0;
    place.pos_valid = 1;
    place.pos[2] = 1.25;
    {
      const std::lock_guard lock(state_->mutex);
      state_->status.mode = messages::Status::MODE_IDLE;
    }
    for (int i = 0; !ending_; ++i) {
      if (i % 10 == 0) say("heartbeat", heartbeat);
      if (i % 5 == 0) {
        const std::lock_guard lock(state_->mutex);
        say("status", state_->status);
      }
      say("state", place);
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }

  std::shared_ptr<LcmLink> link_;
  std::string name_;
  std::shared_ptr<State> state_ = std::make_shared<State>();
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

BridgeSettings settings_for(const std::string& name) {
  BridgeSettings settings;
  settings.driver.robot.id = name;
  settings.driver.session = 0;
  return settings;
}

/// Ten ticks a second until the condition holds; false after half a minute.
template <class Condition>
bool loop_until(EyebotBridge& bridge, Condition condition) {
  static hal::Tick tick = 0;
  for (int i = 0; i < 300; ++i) {
    bridge.latch(tick++, lcm_bus::monotonic_ns());
    if (condition()) return true;
    bridge.commit(lcm_bus::monotonic_ns());
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return false;
}

TEST(EyebotBridge, FliesARobotInMemoryAndLandsItAtTheEnd) {
  const auto link = LcmLink::open("memq://");
  ASSERT_TRUE(link.ok());
  LivingRobot robot(link.value());
  {
    EyebotBridge bridge(settings_for("eb0"), [&] { return link; });
    auto& task = bridge.robot().actuator<hal::FlightTask>();
    auto& speed = bridge.robot().actuator<hal::QuadrotorSpeed>();
    const auto& place = bridge.robot().sensor<hal::Positioning>();
    bridge.start();
    const hal::Status ready = bridge.wait_active(30 * hal::kNsPerSecond);
    ASSERT_TRUE(ready.ok()) << ready.error().message;
    task.order = hal::FlightOrder::TakeOff;
    ASSERT_TRUE(loop_until(bridge, [&] { return bridge.status().flight.mode == Mode::Hover; }));
    task.order = hal::FlightOrder::Fly;
    speed.set(0.75, 0.0, 0.0, 0.0);
    ASSERT_TRUE(loop_until(bridge, [&] { return robot.seen().velocity_x > 0.0; }));
    EXPECT_EQ(place.validity, hal::Validity::Fresh);
    EXPECT_EQ(place.p_WB[2], 1.25);
    EXPECT_NE(bridge.stop_details().session, 0);
  }
  const auto end = robot.seen();
  EXPECT_EQ(end.status.mode, messages::Status::MODE_IDLE);
  EXPECT_EQ(end.status.armed, 0);
  ASSERT_GE(end.obeyed.size(), 4U);
  EXPECT_EQ(end.obeyed[0], messages::CmdMode::ACT_ARM);
  EXPECT_EQ(end.obeyed[1], messages::CmdMode::ACT_TAKEOFF);
  EXPECT_EQ(end.obeyed[end.obeyed.size() - 2], messages::CmdMode::ACT_LAND);
  EXPECT_EQ(end.obeyed.back(), messages::CmdMode::ACT_DISARM);
}

TEST(EyebotBridge, LeavesTheRobotHoveringWhereThatIsWanted) {
  const auto link = LcmLink::open("memq://");
  ASSERT_TRUE(link.ok());
  LivingRobot robot(link.value());
  {
    BridgeSettings settings = settings_for("eb0");
    settings.shutdown.land = false;
    EyebotBridge bridge(settings, [&] { return link; });
    bridge.robot().actuator<hal::FlightTask>().order = hal::FlightOrder::TakeOff;
    bridge.start();
    ASSERT_TRUE(bridge.wait_active(30 * hal::kNsPerSecond).ok());
    ASSERT_TRUE(loop_until(bridge, [&] { return bridge.status().flight.mode == Mode::Hover; }));
  }
  EXPECT_EQ(robot.seen().status.mode, messages::Status::MODE_HOVER);
  EXPECT_EQ(robot.seen().status.armed, 1);
}

TEST(EyebotBridge, SaysWhyThereIsNoRobot) {
  const auto link = LcmLink::open("memq://");
  ASSERT_TRUE(link.ok());
  EyebotBridge nobody(settings_for("eb7"), [&] { return link; });
  nobody.start();
  EXPECT_THAT(nobody.wait_active(50 * kMs).error().message, HasSubstr("no heartbeat is heard on eyebot/eb7/heartbeat"));
  EyebotBridge nowhere(settings_for("eb7"), [] { return LcmLink::open("udpm://127.0.0.1:7667"); });
  nowhere.start();
  for (int i = 0; i < 3000 && nowhere.status().link_trouble.empty(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_THAT(nowhere.wait_active(0).error().message, HasSubstr("no multicast group"));
  EXPECT_EQ(nowhere.status().links_opened, 0U);
}

TEST(EyebotBridge, OpensTheLinkAnewWhenItsOwnWordsDoNotComeBack) {
  std::atomic<bool> block{true};  // outlives the link, whose thread reads it
  const auto deaf = LcmLink::open("memq://");
  ASSERT_TRUE(deaf.ok());
  int opened = 0;
  EyebotBridge bridge(settings_for("eb0"), [&]() -> hal::Result<std::shared_ptr<LcmLink>> {
    ++opened;
    if (opened > 1) return hal::Error{"the network is still gone"};
    return deaf;
  });
  // Nobody takes messages out of a link whose thread is kept busy.
  ASSERT_TRUE(deaf.value()
                  ->subscribe("hub/.*",
                              [&block](const LcmMessage&) {
                                while (block) std::this_thread::sleep_for(std::chrono::milliseconds(1));
                              })
                  .ok());
  bridge.start();
  for (int i = 0; i < 3000 && bridge.status().link_trouble != "the network is still gone"; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_EQ(bridge.status().link_trouble, "the network is still gone");
  block = false;
}

// --- on a network, with strangers ---

class OnLoopback : public testing::Test {
 protected:
  void SetUp() override {
    if (std::getenv("TANDEM_LOOPBACK") == nullptr) GTEST_SKIP() << "run by on_loopback.sh";
    if (std::system("python3 -c ''") != 0) GTEST_SKIP() << "needs python3";
  }
};

/// Steps a stopper until it is confirmed; false: it never is.
bool stopped(guardian::Stopper& stopper) {
  for (int i = 0; i < 3000; ++i) {
    if (stopper.step(lcm_bus::monotonic_ns()) == guardian::StopState::Confirmed) return true;
  }
  return false;
}

TEST_F(OnLoopback, AStopperLandsARobotWhoseHubIsGone) {
  const auto link = LcmLink::open("");
  ASSERT_TRUE(link.ok()) << link.error().message;
  LivingRobot robot(link.value(), "eb3");
  StopMessages how;
  StopDetails words;
  {
    BridgeSettings settings = settings_for("eb3");
    settings.shutdown.land = false;  // as if it had been killed
    EyebotBridge bridge(settings, [] { return LcmLink::open(""); });
    bridge.robot().actuator<hal::FlightTask>().order = hal::FlightOrder::TakeOff;
    bridge.start();
    ASSERT_TRUE(bridge.wait_active(30 * hal::kNsPerSecond).ok());
    ASSERT_TRUE(loop_until(bridge, [&] { return bridge.status().flight.mode == Mode::Hover; }));
    words = bridge.stop_details();
    words.land = true;
    how = bridge.stop_messages();
    how.body = to_stop_body(words);
  }
  ASSERT_EQ(robot.seen().status.mode, messages::Status::MODE_HOVER);
  // While its hub may come back it hovers; then it lands.
  const auto type = stopper_type();
  EXPECT_TRUE(stopped(*type.make(how, guardian::StopCause::HubFrozen)));
  EXPECT_EQ(robot.seen().status.mode, messages::Status::MODE_HOVER);
  EXPECT_TRUE(stopped(*type.make(how, guardian::StopCause::HubGone)));
  const auto end = robot.seen();
  EXPECT_EQ(end.status.mode, messages::Status::MODE_IDLE);
  EXPECT_EQ(end.status.armed, 0);
  EXPECT_EQ(end.obeyed[end.obeyed.size() - 2], messages::CmdMode::ACT_LAND);
  EXPECT_EQ(end.obeyed.back(), messages::CmdMode::ACT_DISARM);
  EXPECT_EQ(end.last_order.session, words.session);
  EXPECT_GE(end.last_order.seq, 500'000'000);  // newer than all that the hub said
}

/// peer.py: a robot in Python.
class PythonRobot {
 public:
  explicit PythonRobot(const std::string& name) {
    child_ = ::fork();
    if (child_ != 0) return;
    ::execlp("python3", "python3", (std::string(test::kSourceDir) + "/tests/bridges/eyebot/peer.py").c_str(),
             (std::string(test::kBuildDir) + "/tests/eyebot_py").c_str(), name.c_str(), nullptr);
    ::_exit(127);
  }
  ~PythonRobot() {
    ::kill(child_, SIGTERM);
    ::waitpid(child_, nullptr, 0);
  }

 private:
  pid_t child_ = -1;
};

template <class Message>
std::vector<Message> logged(const std::vector<lcm_bus::LoggedEvent>& events, const std::string& channel) {
  std::vector<Message> all;
  for (const auto& e : events) {
    Message m{};
    if (e.channel != channel) continue;
    EXPECT_EQ(messages::decode(std::as_bytes(std::span(e.data.data(), e.data.size())), m), messages::Flaw::None);
    all.push_back(std::move(m));
  }
  return all;
}

TEST_F(OnLoopback, FliesARobotOfAnotherLanguageWithAWitness) {
  const auto ear = LcmLink::open("");
  ASSERT_TRUE(ear.ok()) << ear.error().message;
  lcm_bus::Witness witness("(eyebot|hub)/.*");
  ASSERT_TRUE(witness.wait_until_it_hears(*ear.value()));
  const auto armed = std::make_shared<std::atomic<int>>(-1);
  ASSERT_TRUE(ear.value()
                  ->subscribe("eyebot/py_1/status",
                              [armed](const LcmMessage& m) {
                                messages::Status status{};
                                if (messages::decode(m.data, status) == messages::Flaw::None) *armed = status.armed;
                              })
                  .ok());
  ASSERT_TRUE(ear.value()->start().ok());
  PythonRobot robot("py_1");
  double highest_m = 0.0, farthest_m = 0.0;
  {
    EyebotBridge bridge(settings_for("py_1"), [] { return LcmLink::open(""); });
    auto& task = bridge.robot().actuator<hal::FlightTask>();
    auto& position = bridge.robot().actuator<hal::QuadrotorPosition>();
    const auto& place = bridge.robot().sensor<hal::Positioning>();
    bridge.start();
    const hal::Status ready = bridge.wait_active(30 * hal::kNsPerSecond);
    ASSERT_TRUE(ready.ok()) << ready.error().message;
    task.order = hal::FlightOrder::TakeOff;
    ASSERT_TRUE(loop_until(bridge, [&] { return place.p_WB[2] > 0.9; }));
    task.order = hal::FlightOrder::Fly;
    position.set(1.0, -0.5, 1.0, 0.0);
    ASSERT_TRUE(loop_until(bridge, [&] { return place.p_WB[0] > 0.95 && place.p_WB[1] < -0.45; }));
    highest_m = place.p_WB[2];
    farthest_m = place.p_WB[0];
    EXPECT_EQ(bridge.status().driver.not_understood, 0U);
    EXPECT_EQ(bridge.status().messages.refused, 0U);
  }
  EXPECT_GT(highest_m, 0.9);
  EXPECT_GT(farthest_m, 0.95);
  for (int i = 0; i < 1000 && *armed != 0; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  const auto events = witness.end(*ear.value());
  const auto orders = logged<messages::CmdMode>(events, "eyebot/py_1/cmd/mode");
  std::vector<int> actions;
  for (const auto& m : orders) {
    if (actions.empty() || actions.back() != m.action) actions.push_back(m.action);
  }
  using C = messages::CmdMode;
  EXPECT_THAT(actions, testing::ElementsAre(C::ACT_ARM, C::ACT_TAKEOFF, C::ACT_HOVER, C::ACT_LAND, C::ACT_DISARM));
  EXPECT_GE(logged<messages::CmdPosition>(events, "eyebot/py_1/cmd/position").size(), 1U);
  EXPECT_GE(logged<messages::Ack>(events, "eyebot/py_1/ack").size(), 5U);
  const auto status = logged<messages::Status>(events, "eyebot/py_1/status");
  ASSERT_FALSE(status.empty());
  EXPECT_EQ(status.back().mode, messages::Status::MODE_IDLE);
  EXPECT_EQ(status.back().armed, 0);
}

}  // namespace
}  // namespace tandem::bridges::eyebot
