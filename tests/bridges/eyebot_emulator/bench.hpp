// An eye-bot in time that the test turns by hand.
#pragma once
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bridges/eyebot_emulator/eyebot.hpp"
#include "bridges/eyebot_emulator/point_body.hpp"
#include "tests/bridges/eyebot_emulator/hand_written.hpp"

namespace tandem::bridges::eyebot_emulator {

inline constexpr hal::TimeNs kMs = hal::kNsPerMs;
inline constexpr std::int64_t kUnixUs = 1'700'000'000'000'000;
inline constexpr std::int32_t kHub = 0x1234;
inline constexpr std::int32_t kOtherHub = 0x4321;

inline Eyebot::Options fenced(const Fence& fence) {
  Eyebot::Options options;
  options.fence = fence;
  return options;
}

class Bench {
 public:
  explicit Bench(const Eyebot::Options& options = {}, const std::optional<Room>& room = Room{})
      : body({}, room), robot(options, body, [this](hal::TimeNs at, std::string_view name, const EventFields& fields) {
          log.push_back(to_json(at, name, fields));
        }) {
    robot.power_on(now, kUnixUs);
    robot.run_until(now += 200 * kMs);
  }

  hand_written::Head head(std::int32_t session) { return {robot.utime(now), next_seq_++, session}; }
  void hear(std::string_view topic, const Bytes& payload) {
    robot.receive("eyebot/" + robot.options().name + "/" + std::string(topic), payload, now);
  }
  /// Time goes on while the hub in control lives.
  void pass(hal::TimeNs time, bool hub_lives = true) {
    const hal::TimeNs end = now + time;
    while (now < end) {
      const hal::TimeNs step = std::min(end - now, 200 * kMs);
      if (hub_lives) beat(kHub);
      robot.run_until(now += step);
    }
  }
  void beat(std::int32_t session) {
    robot.receive("hub/lab/heartbeat", hand_written::hub_heartbeat(head(session)), now);
  }
  /// @returns what is acknowledged
  int order(Action action, float param = 0.0F, std::int32_t session = kHub) {
    return send_order(hand_written::mode(head(session), static_cast<int>(action), param));
  }
  int send_order(const Bytes& payload) {
    sent("");
    hear("cmd/mode", payload);
    const auto acks = sent("ack");
    EXPECT_EQ(acks.size(), 1U);
    return acks.empty() ? -1 : hand_written::read_ack(acks.front()).result;
  }
  void velocity(double x, double y, double z, double yaw_rate = 0.0, std::int32_t session = kHub) {
    hear("cmd/velocity", hand_written::velocity(head(session), x, y, z, yaw_rate));
  }
  void fly_to(const hand_written::Place& place, std::int32_t session = kHub) {
    hear("cmd/position", hand_written::position(head(session), place));
  }
  /// Armed, and hovering at a metre.
  void take_off() {
    EXPECT_EQ(order(Action::Arm), 0);
    EXPECT_EQ(order(Action::TakeOff), 0);
    pass(4000 * kMs);
    EXPECT_EQ(mode(), Mode::Hover);
  }
  void attach() {
    take_off();
    EXPECT_EQ(order(Action::Attach, 1.0F), 0);
    pass(6000 * kMs);
    EXPECT_EQ(mode(), Mode::Attached);
  }

  /// What was sent on the channels that end so, since the last call of any.
  std::vector<Bytes> sent(std::string_view topic) {
    std::vector<Datagram> all;
    robot.take_sent(all);
    std::vector<Bytes> chosen;
    for (Datagram& d : all) {
      if (d.channel.ends_with("/" + std::string(topic))) chosen.push_back(std::move(d.data));
    }
    return chosen;
  }
  hand_written::Status status() {
    sent("");
    pass(100 * kMs, false);
    return hand_written::read_status(sent("status").back());
  }

  Mode mode() const { return robot.supervisor().mode(); }
  Failsafe failsafe() const { return robot.supervisor().failsafe(); }
  const Vec3& p() const { return robot.senses().p_WB; }
  const Vec3& v() const { return robot.senses().v_WB; }
  int logged(const std::string& part) const {
    return static_cast<int>(
        std::count_if(log.begin(), log.end(), [&](const std::string& l) { return l.find(part) != std::string::npos; }));
  }

  hal::TimeNs now = 1000 * kMs;
  std::vector<std::string> log;
  PointBody body;
  Eyebot robot;

 private:
  std::int32_t next_seq_ = 0;
};

}  // namespace tandem::bridges::eyebot_emulator
