// An eye-bot on a fake clock, as simple as can be, that does what its test says.
#pragma once
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "bridges/eyebot/driver.hpp"
#include "bridges/eyebot_messages/codec.hpp"

namespace tandem::bridges::eyebot {

namespace messages = eyebot_messages;
inline constexpr hal::TimeNs kMs = hal::kNsPerMs;

/// What the driver said, taken apart.
struct Said {
  std::string channel;
  std::vector<std::byte> data;
  hal::TimeNs at_ns = 0;

  template <class Message>
  Message as() const {
    Message m{};
    if (messages::decode(std::span<const std::byte>(data), m) != messages::Flaw::None) std::abort();
    return m;
  }
};

class ScriptedRobot final : public Outbox {
 public:
  explicit ScriptedRobot(Inbox& inbox, std::string name = "eb0") : inbox_(inbox), name_(std::move(name)) {
    state.quat[0] = 1.0;
    state.pos_valid = 1;
    state.yaw_valid = 1;
    heartbeat.name = name_;
    heartbeat.role = messages::Heartbeat::ROLE_ROBOT;
    heartbeat.proto_major = 1;
    heartbeat.period_ms = 200;
    status.mode = messages::Status::MODE_IDLE;
  }

  // What it says; every millisecond of `live` it says what is due.
  messages::Heartbeat heartbeat{};
  messages::Status status{};
  messages::State state{};
  std::int32_t session = 77;
  hal::TimeNs clock_minus_ours_ns = 1'700'000'000 * hal::kNsPerSecond;
  bool alive = true;
  // What it does with orders.
  bool answers = true;
  std::int8_t result = messages::Ack::OK;
  int deaf_times = 0;  // so many orders are not heard

  std::vector<Said> said;   // all that the driver said
  std::vector<int> obeyed;  // actions, in order
  bool reachable = true;    // else nothing that the driver says comes here

  void live(hal::TimeNs now) {
    now_ = now;
    if (!alive) return;
    const auto due = [&](Topic topic, hal::TimeNs period) {
      return now - last_[topic] >= period || !last_.contains(topic);
    };
    if (due(Topic::Heartbeat, 200 * kMs)) say(Topic::Heartbeat, heartbeat);
    if (due(Topic::Status, 100 * kMs)) say(Topic::Status, status);
    if (due(Topic::State, 20 * kMs)) say(Topic::State, state);
  }
  template <class Message>
  void say(Topic topic, Message& m) {
    last_[topic] = now_;
    m.hdr.utime = (now_ + clock_minus_ours_ns) / 1000;
    m.hdr.seq = seq[topic]++;
    m.hdr.session = session;
    std::vector<std::byte> buffer(messages::kMostBytes);
    inbox_.deliver(topic, messages::encode(m, buffer), now_);
  }
  std::map<Topic, std::int32_t> seq;

  bool publish(const std::string& channel, std::span<const std::byte> data) noexcept override {
    said.push_back({channel, {data.begin(), data.end()}, now_});
    if (reachable && channel == "eyebot/" + name_ + "/cmd/mode") obey(said.back().as<messages::CmdMode>());
    return reachable;
  }
  void at(hal::TimeNs now) { now_ = now; }

  std::vector<Said> all(const std::string& suffix) const {
    std::vector<Said> found;
    for (const Said& s : said) {
      if (s.channel.ends_with(suffix)) found.push_back(s);
    }
    return found;
  }

 private:
  void obey(const messages::CmdMode& m) {
    if (deaf_times > 0) {
      --deaf_times;
      return;
    }
    const bool again = executed_ == m.hdr.seq + 1;
    if (!again && result == messages::Ack::OK) {
      obeyed.push_back(m.action);
      executed_ = m.hdr.seq + 1;
      change(m.action);
    }
    if (!answers) return;
    ack_.channel = "eyebot/" + name_ + "/cmd/mode";
    ack_.cmd_session = m.hdr.session;
    ack_.cmd_seq = m.hdr.seq;
    ack_.result = result;
    say(Topic::Ack, ack_);
    say(Topic::Status, status);
  }
  void change(std::int8_t action) {
    using S = messages::Status;
    using C = messages::CmdMode;
    if (action == C::ACT_ARM) status.armed = 1;
    if (action == C::ACT_DISARM) status.armed = 0;
    if (action == C::ACT_TAKEOFF || action == C::ACT_HOVER || action == C::ACT_DETACH) status.mode = S::MODE_HOVER;
    if (action == C::ACT_LAND) status.mode = S::MODE_IDLE;
    if (action == C::ACT_ATTACH) status.mode = S::MODE_ATTACHED;
    if (action == C::ACT_ESTOP) status.mode = S::MODE_ESTOP;
    if (action == C::ACT_CLEAR_FAILSAFE) status.failsafe = S::FS_NONE;
  }

  Inbox& inbox_;
  std::string name_;
  hal::TimeNs now_ = 0;
  std::map<Topic, hal::TimeNs> last_;
  std::int32_t executed_ = 0;
  messages::Ack ack_{};
};

/// A robot, its driver and a loop of ten ticks a second, on one fake clock.
struct Scene {
  explicit Scene(DriverSettings wanted = {})
      : robot(inbox), driver(with_defaults(std::move(wanted)), inbox, robot, log()) {}

  Inbox inbox;
  ScriptedRobot robot;
  std::vector<std::string> logged;
  EyebotDriver driver;
  hal::TimeNs now = 1000 * hal::kNsPerSecond;
  hal::Tick tick = 0;
  bool commits = true;
  std::function<void()> controller = [] {};

  void run(int milliseconds) {
    for (int i = 0; i < milliseconds; i += 10) {
      now += 10 * kMs;
      robot.live(now);
      robot.at(now);
      if (commits && (now / (10 * kMs)) % 10 == 0) {
        driver.latch(tick++, now);
        controller();
        driver.commit(now);
      } else {
        driver.pump(now);
      }
    }
  }
  template <class T>
  T& actuator() {
    return driver.robot().actuator<T>();
  }
  template <class T>
  const T& sensor() {
    return driver.robot().sensor<T>();
  }
  /// Armed, in the air, obeying.
  void fly() {
    actuator<hal::FlightTask>();
    robot.status.mode = messages::Status::MODE_HOVER;
    robot.status.armed = 1;
    run(1000);
  }
  bool has_logged(const std::string& text) const {
    for (const std::string& line : logged) {
      if (line.find(text) != std::string::npos) return true;
    }
    return false;
  }

 private:
  static DriverSettings with_defaults(DriverSettings s) {
    s.name = "eb0";
    s.session = 0x1234;
    s.hub = "lab";
    return s;
  }
  hal::Log log() {
    return hal::Log([this](hal::Severity, std::string_view text) { logged.emplace_back(text); });
  }
};

}  // namespace tandem::bridges::eyebot
