// Whatever hubs send, the robot stays what it is.
#include <rapidcheck.h>

#include "tests/bridges/eyebot_emulator/bench.hpp"

namespace tandem::bridges::eyebot_emulator {
namespace {

struct Sent {
  std::string channel;
  Bytes payload;
  hal::TimeNs pause = 0;
};

Bytes bytes_of(const std::vector<std::uint8_t>& values) {
  Bytes bytes;
  for (const std::uint8_t v : values) bytes.push_back(std::byte{v});
  return bytes;
}

/// Payloads that are mostly sensible, with a bite taken out of some.
rc::Gen<Sent> any_message() {
  return rc::gen::exec([] {
    using rc::gen::arbitrary;
    using rc::gen::element;
    using rc::gen::inRange;
    Sent sent;
    const hand_written::Head head{kUnixUs + *inRange(0, 400'000), *inRange(0, 200), *element(kHub, kOtherHub, 0)};
    const auto any = [] {
      return *rc::gen::weightedOneOf<double>(
          {{8, rc::gen::map(inRange(-400, 400), [](int v) { return 0.01 * v; })}, {1, arbitrary<double>()}});
    };
    switch (*inRange(0, 6)) {
      case 0:
        sent = {"eyebot/eb0/cmd/mode", hand_written::mode(head, *inRange(-1, 11), static_cast<float>(any()))};
        break;
      case 1:
        sent = {"eyebot/eb0/cmd/velocity",
                hand_written::velocity(head, any(), any(), any(), any(), *inRange(-1, 3000), *inRange(-1, 3))};
        break;
      case 2:
        sent = {"eyebot/eb0/cmd/position",
                hand_written::position(head, {any(), any(), any(), *inRange(-1, 3), *arbitrary<bool>(), any(),
                                              static_cast<float>(any()), *inRange(-1, 3000)})};
        break;
      case 3:
        sent = {"hub/lab/heartbeat", hand_written::hub_heartbeat(head, "lab", *element(1, 1, 1, 2))};
        break;
      case 4:
        sent = {"eyebot/eb0/cmd/rab", bytes_of(*arbitrary<std::vector<std::uint8_t>>())};
        break;
      default:
        sent = {"eyebot/eb0/cmd/" + *element<std::string>("mode", "leds", "pan_tilt", "scanner", "velocity", "x", ""),
                bytes_of(*arbitrary<std::vector<std::uint8_t>>())};
        break;
    }
    if (*inRange(0, 10) == 0 && !sent.payload.empty())
      sent.payload.resize(*inRange<std::size_t>(0, sent.payload.size()));
    if (*inRange(0, 10) == 0 && !sent.payload.empty()) {
      sent.payload[*inRange<std::size_t>(0, sent.payload.size())] = std::byte{*arbitrary<std::uint8_t>()};
    }
    sent.pause = *inRange<hal::TimeNs>(0, 700) * kMs;
    return sent;
  });
}

rc::Gen<std::vector<Sent>> any_messages() {
  return rc::gen::container<std::vector<Sent>>(any_message());
}

Eyebot::Options unsynced() {
  Eyebot::Options options;
  options.clock_synced = false;
  return options;
}

TEST(AnyHub, FindsARobotWithinItsLimits) {
  EXPECT_TRUE(rc::check([] {
    Bench bench(unsynced());
    for (const Sent& sent : *any_messages()) {
      bench.robot.receive(sent.channel, sent.payload, bench.now);
      bench.robot.run_until(bench.now += sent.pause);
      const Supervisor& s = bench.robot.supervisor();
      const Vec3& v = bench.robot.command().velocity_m_s;
      RC_ASSERT(std::hypot(v[0], v[1], v[2]) <= hal::eyebot::kind().flight()->max_speed_m_s + 1e-9);
      RC_ASSERT(std::fabs(bench.robot.command().yaw_rad_s) <= hal::eyebot::kind().flight()->max_turn_rad_s);
      for (const double p : bench.p()) RC_ASSERT(std::isfinite(p));
      RC_ASSERT(!s.motors() || s.armed());
      RC_ASSERT(s.mode() != Mode::Velocity || s.failsafe() == Failsafe::None);
      RC_ASSERT(s.mode() != Mode::Position || s.failsafe() == Failsafe::None);
      const bool near_ceiling = s.mode() == Mode::Attaching || s.mode() == Mode::Attached || s.mode() == Mode::Estop;
      RC_ASSERT(!s.magnet() || near_ceiling);
    }
  }));
}

TEST(AnyHub, ThatFallsSilentFindsTheRobotOnTheGroundOrTheCeiling) {
  EXPECT_TRUE(rc::check([] {
    Bench bench(unsynced());
    for (const Sent& sent : *any_messages()) {
      bench.robot.receive(sent.channel, sent.payload, bench.now);
      bench.robot.run_until(bench.now += sent.pause);
    }
    bench.pass(60 * hal::kNsPerSecond, false);
    RC_ASSERT(!bench.robot.command().motors);
    RC_ASSERT(bench.robot.senses().on_ground || bench.robot.senses().at_ceiling);
    RC_ASSERT(bench.robot.supervisor().controller() == 0);
  }));
}

TEST(AnyHub, GetsAnAnswerToEveryOrder) {
  EXPECT_TRUE(rc::check([](std::int32_t seq, std::int8_t action, float param) {
    Bench bench(unsynced());
    bench.sent("");
    const Bytes order = hand_written::mode({0, seq, kHub}, action, param);
    bench.hear("cmd/mode", order);
    bench.hear("cmd/mode", order);
    const auto acks = bench.sent("ack");
    RC_ASSERT(acks.size() == 2U);
    const auto first = hand_written::read_ack(acks[0]);
    const auto second = hand_written::read_ack(acks[1]);
    RC_ASSERT(first.seq == seq && second.seq == seq && first.session == kHub);
    RC_ASSERT(first.result == second.result && first.text == second.text);
  }));
}

TEST(AnyHub, GetsTheSameFromTheSame) {
  EXPECT_TRUE(rc::check([] {
    const auto messages = *any_messages();
    Bench one(unsynced());
    Bench other(unsynced());
    for (const Sent& sent : messages) {
      for (Bench* bench : {&one, &other}) bench->robot.receive(sent.channel, sent.payload, bench->now);
      one.robot.run_until(one.now += sent.pause);
      other.robot.run_until(other.now + sent.pause / 2);  // looked at more often
      other.robot.run_until(other.now += sent.pause);
    }
    RC_ASSERT(one.log == other.log);
    RC_ASSERT(one.sent("state") == other.sent("state"));
  }));
}

TEST(AnyNumbers, AreNewerOneWayOnly) {
  EXPECT_TRUE(rc::check([](std::int32_t a, std::int32_t b) {
    RC_PRE(a != b && static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b) != 0x80000000U);
    RC_ASSERT(is_newer(a, b) != is_newer(b, a));
  }));
}

TEST(AnyBytes, AreACommandOrNone) {
  EXPECT_TRUE(rc::check([](const std::vector<std::uint8_t>& tail) {
    for (const std::string_view topic : kCommandChannels) {
      const Bytes noise = bytes_of(tail);
      (void)read_command(topic, noise);
      const auto found = hand_written::kFingerprints.find(topic);
      Bytes nearly = hand_written::Writer(found->first, {}).bytes;
      nearly.insert(nearly.end(), noise.begin(), noise.end());
      const auto command = read_command(topic, nearly);
      if (command.ok()) RC_ASSERT(command.value().header.session == 0);
    }
  }));
}

}  // namespace
}  // namespace tandem::bridges::eyebot_emulator
