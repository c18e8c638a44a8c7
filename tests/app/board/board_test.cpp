// The program for a robot's board, run as the board runs it: by an emulated processor, against an emulated robot.
#include <future>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bridges/epuck_emulator/emulator.hpp"
#include "bridges/footbot_emulator/emulator.hpp"
#include "bridges/link/listener.hpp"
#include "bridges/link/tcp_link.hpp"
#include "bridges/peer/frame.hpp"
#include "bridges/peer/messages.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"
#include "tests/checkout.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem {
namespace {

namespace peer = bridges::peer;

using scenarios::Folder;
using scenarios::json_value;
using scenarios::Tandem;
using scenarios::text_of;
using testing::HasSubstr;

const std::string kConfigs = std::string(test::kSourceDir) + "/configs/";
constexpr double kPatience_s = 60.0;  // an emulated processor is slow

/// A robot's firmware on a thread of its own.
template <class Options>
class Emulated {
 public:
  explicit Emulated(Options options) {
    std::promise<std::string> ready;
    options.ready = [&ready](const std::string& path) { ready.set_value(path); };
    thread_ = std::thread([this, options] { ended_ = run(options, stop_); });
    link_ = ready.get_future().get();
  }
  ~Emulated() {
    stop_ = true;
    thread_.join();
    EXPECT_TRUE(ended_.ok());
  }
  const std::string& link() const { return link_; }

 private:
  std::atomic<bool> stop_{false};
  hal::Status ended_;
  std::string link_;
  std::thread thread_;
};

TEST(Board, ChecksWhatItIsGiven) {
  Folder folder;
  for (const char* file :
       {"epuck_robot.xml", "epuck_robot_lua.xml", "footbot_robot.xml", "footbot_map.xml", "epuck_mixed.xml"}) {
    Tandem check({"check", kConfigs + file}, folder.path());
    EXPECT_EQ(check.wait(kPatience_s), 0) << check.errors();
    EXPECT_THAT(check.output(), HasSubstr("good"));
  }
  std::string wrong = text_of(kConfigs + "epuck_robot.xml");
  wrong.replace(wrong.find("velocity="), 9, "velocitty=");
  folder.write("wrong.xml", wrong);
  Tandem check({"check", "wrong.xml"}, folder.path());
  EXPECT_EQ(check.wait(kPatience_s), 1);
  EXPECT_THAT(check.errors(), HasSubstr("velocitty"));
}

/// An emulated e-puck that `experiment` drives for two seconds.
class BoardOfAnEpuck : public testing::Test {
 protected:
  BoardOfAnEpuck() : epuck_(options()) {}

  void is_driven_by(const std::string& experiment) {
    Tandem robot({"robot", kConfigs + experiment, "--link", link_, "--seconds", "2", "--report", "r.json"},
                 folder_.path());
    ASSERT_EQ(robot.wait(kPatience_s), 0) << robot.errors();
    const std::string report = text_of(folder_.path() / "r.json");
    EXPECT_EQ(json_value(report, "steps"), "20");
    EXPECT_GT(std::stoi(json_value(report, "answers")), 10);
  }

  const Folder folder_;
  const std::string link_ = "serial:" + (folder_.path() / "ep0").string();

 private:
  bridges::epuck_emulator::Options options() const {
    bridges::epuck_emulator::Options options;
    options.link = "pty:" + (folder_.path() / "ep0").string();
    return options;
  }

  const Emulated<bridges::epuck_emulator::Options> epuck_;
};

TEST_F(BoardOfAnEpuck, DrivesIt) {
  ASSERT_NO_FATAL_FAILURE(is_driven_by("epuck_robot.xml"));
  Tandem inspect({"inspect", link_}, folder_.path());
  EXPECT_EQ(inspect.wait(kPatience_s), 0) << inspect.errors();
  EXPECT_THAT(inspect.output(), HasSubstr("proximity:"));
}

TEST_F(BoardOfAnEpuck, DrivesItByAScript) {
  is_driven_by("epuck_robot_lua.xml");
}

TEST(Board, DrivesAFootbotBehindItsSwitch) {
  Folder folder;
  bridges::footbot_emulator::Options options;
  options.link = "tcp-listen:0";
  const Emulated footbot(options);
  Tandem robot(
      {"robot", kConfigs + "footbot_robot.xml", "--link", footbot.link(), "--seconds", "2", "--report", "r.json"},
      folder.path());
  ASSERT_EQ(robot.wait(kPatience_s), 0) << robot.errors();
  const std::string report = text_of(folder.path() / "r.json");
  EXPECT_EQ(json_value(report, "steps"), "20");
  EXPECT_GT(std::stoi(json_value(report, "messages_in")), 10);
}

/// The hub's side of one peer, by hand.
class HandHub {
 public:
  HandHub() : listener_(bridges::Listener::open("tcp", "tcp", "0").value()) {}
  std::string link() const { return "peer:" + listener_->path(); }
  bool admit() {
    int socket = -1;
    if (!scenarios::eventually([&] { return (socket = listener_->accept()) >= 0; }, kPatience_s)) return false;
    link_ = bridges::TcpLink::take_over("tcp:peer", socket);
    return true;
  }
  void say(peer::MessageType type, const std::vector<std::uint8_t>& payload) {
    (void)link_->write(peer::frame_of(type, payload), hal::kNsPerSecond);
  }
  std::vector<std::uint8_t> hear(peer::MessageType type) {
    for (const auto end = bridges::monotonic_ns() + 60 * hal::kNsPerSecond; bridges::monotonic_ns() < end;) {
      while (const auto frame = reader_.next()) {
        if (frame->type == type) return {frame->payload.begin(), frame->payload.end()};
      }
      link_->wait(20 * hal::kNsPerMs);
      std::array<std::uint8_t, 4096> buffer;
      const auto got = link_->read(buffer);
      reader_.push(std::span(buffer).first(got.size));
    }
    return {};
  }

 private:
  std::unique_ptr<bridges::Listener> listener_;
  std::unique_ptr<bridges::ByteLink> link_;
  peer::FrameReader reader_;
};

TEST(Board, StepsAControllerForAHubInLockstep) {
  Folder folder;
  HandHub hub;
  Tandem robot({"robot", kConfigs + "epuck_robot.xml", "--link", hub.link(), "--report", "r.json"}, folder.path());
  ASSERT_TRUE(hub.admit()) << robot.errors();
  EXPECT_EQ(peer::read_hello(hub.hear(peer::MessageType::Hello)).value().robot, "ep0");
  peer::RobotMessage told{"s", "ep0", "e-puck", "by hand", 10, 7, 0, {}, {}, {}, peer::kVersion};
  const peer::RowForm proximity(hal::port_type<hal::Proximity>()), wheels(hal::port_type<hal::WheelSpeeds>());
  told.ports = {{hal::Role::Sensor, "proximity", proximity.digest()},
                {hal::Role::Actuator, "differential_steering", wheels.digest()}};
  told.fields = {proximity.fields(), wheels.fields()};
  hub.say(peer::MessageType::Robot, peer::bytes_of(told));
  EXPECT_EQ(peer::read_ready(hub.hear(peer::MessageType::Ready)).value().takes.size(), 2U);
  hal::Proximity reading;
  reading.validity = hal::Validity::Fresh;
  reading.count = 8;
  reading.range_m = 0.1F;
  reading.distance_m.fill(0.1F);
  for (hal::Tick tick = 0; tick < 20; ++tick) {
    std::vector<std::uint8_t> question;
    peer::append_tick(question, tick, 0);
    proximity.pack(&reading, question);
    hub.say(peer::MessageType::Tick, question);
    const auto answer = hub.hear(peer::MessageType::Commands);
    std::span<const std::uint8_t> in = answer;
    peer::TickHead head;
    ASSERT_TRUE(peer::take_head(in, head)) << robot.errors();
    EXPECT_EQ(head.tick, tick);
    hal::WheelSpeeds command;
    ASSERT_TRUE(wheels.unpack(in, &command));
    EXPECT_EQ(command.left_m_s, 0.05) << "nothing is near";
    EXPECT_EQ(command.right_m_s, 0.05);
  }
  hub.say(peer::MessageType::End, peer::bytes_of(peer::Farewell{false, "done"}));
  EXPECT_EQ(robot.wait(kPatience_s), 0) << robot.errors();
  EXPECT_EQ(json_value(text_of(folder.path() / "r.json"), "steps"), "20");
}

}  // namespace
}  // namespace tandem
