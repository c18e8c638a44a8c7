// The whole robot in time that is turned by hand, told and asked in bytes written by hand.
#include <cmath>
#include <limits>
#include <set>

#include "tests/bridges/eyebot_emulator/bench.hpp"

namespace tandem::bridges::eyebot_emulator {
namespace {

using hand_written::Writer;
using testing::HasSubstr;
using testing::Not;

constexpr hal::TimeNs kSecond = hal::kNsPerSecond;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

double speed(const Bench& bench) {
  return std::hypot(bench.v()[0], bench.v()[1], bench.v()[2]);
}

TEST(Eyebot, ReportsAtItsRates) {
  Bench bench;
  Writer scanner("cmd/scanner", bench.head(kHub));
  bench.hear("cmd/scanner", scanner.i8(1).i8(0).f32(30.0F).f32(0.0F).bytes);
  bench.pass(kSecond);
  std::vector<Datagram> sent;
  bench.robot.take_sent(sent);
  sent.clear();
  bench.pass(10 * kSecond, false);
  bench.robot.take_sent(sent);
  std::map<std::string, int> count;
  for (const Datagram& d : sent) ++count[d.channel.substr(std::string("eyebot/eb0/").size())];
  const std::map<std::string, int> expected = {{"state", 500},  {"altitude", 500}, {"status", 100}, {"heartbeat", 50},
                                               {"battery", 10}, {"scan", 100},     {"rab", 100},    {"prox", 100},
                                               {"light", 100},  {"pan_tilt", 100}, {"blobs", 100}};
  EXPECT_EQ(count, expected);
  for (const Datagram& d : sent) EXPECT_LT(d.data.size(), 1400U) << d.channel << ": one loss would lose more";
}

TEST(Eyebot, SendsImagesWhenItIsToldAtTheStart) {
  Eyebot::Options options;
  options.image_hz = 2.0;
  Bench bench(options);
  bench.sent("");
  bench.pass(5 * kSecond, false);
  EXPECT_EQ(bench.sent("image").size(), 10U);
}

TEST(Eyebot, CountsAndStampsWhatItSends) {
  Bench bench;
  bench.sent("");
  bench.pass(kSecond, false);
  const auto states = bench.sent("state");
  ASSERT_EQ(states.size(), 50U);
  std::optional<hand_written::Head> last;
  for (const Bytes& bytes : states) {
    hand_written::Reader r(bytes);
    EXPECT_EQ(r.fingerprint(), hand_written::kFingerprints.at("state"));
    const hand_written::Head h = r.head();
    EXPECT_EQ(h.session, 1);
    if (last) {
      EXPECT_EQ(h.seq, last->seq + 1);
      EXPECT_EQ(h.utime, last->utime + 20'000);
    }
    last = h;
  }
  EXPECT_NEAR(static_cast<double>(last->utime), static_cast<double>(kUnixUs + 1'200'000), 20'000.0);
}

TEST(Eyebot, FliesToAPlace) {
  Bench bench;
  bench.take_off();
  EXPECT_NEAR(bench.p()[2], 1.0, 0.1);
  bench.fly_to({.x = 3.0, .y = -2.0, .z = 2.0, .use_yaw = true, .yaw = 1.0});
  EXPECT_EQ(bench.mode(), Mode::Position);
  bench.pass(10 * kSecond);
  EXPECT_NEAR(bench.p()[0], 3.0, 0.01);
  EXPECT_NEAR(bench.p()[1], -2.0, 0.01);
  EXPECT_NEAR(bench.p()[2], 2.0, 0.01);
  EXPECT_NEAR(bench.robot.senses().yaw_rad(), 1.0, 0.01);
  // Relative to where it is, and to where it looks.
  bench.fly_to({.x = 1.0, .y = 0.0, .z = -0.5, .frame = 1, .use_yaw = true, .yaw = 0.5});
  bench.pass(10 * kSecond);
  EXPECT_NEAR(bench.p()[0], 3.0 + std::cos(1.0), 0.02);
  EXPECT_NEAR(bench.p()[1], -2.0 + std::sin(1.0), 0.02);
  EXPECT_NEAR(bench.p()[2], 1.5, 0.01);
  EXPECT_NEAR(bench.robot.senses().yaw_rad(), 1.5, 0.02);
}

TEST(Eyebot, ObeysTheSpeedLimitOfAPlace) {
  Bench bench;
  bench.take_off();
  bench.fly_to({.x = 10.0, .z = 1.0, .max_speed = 0.4F});
  bench.pass(5 * kSecond);
  EXPECT_NEAR(speed(bench), 0.4, 1e-6);
}

TEST(Eyebot, FliesWithAVelocityUntilItIsTooOld) {
  Bench bench;
  bench.take_off();
  bench.velocity(0.5, 0.0, 0.0);
  EXPECT_EQ(bench.mode(), Mode::Velocity);
  bench.pass(490 * kMs);
  EXPECT_NEAR(bench.v()[0], 0.5, 1e-9);
  EXPECT_EQ(bench.mode(), Mode::Velocity);
  bench.pass(20 * kMs);
  EXPECT_EQ(bench.mode(), Mode::Hover);
  EXPECT_EQ(bench.failsafe(), Failsafe::CommandTimeout);
  bench.pass(3 * kSecond);
  EXPECT_NEAR(speed(bench), 0.0, 1e-3);
  bench.velocity(0.0, 0.5, 0.0);
  EXPECT_EQ(bench.failsafe(), Failsafe::None);
  EXPECT_EQ(bench.mode(), Mode::Velocity);
}

TEST(Eyebot, LimitsVelocities) {
  Bench bench;
  bench.take_off();
  for (int i = 0; i < 10; ++i) {
    bench.velocity(30.0, 40.0, 0.0, 99.0);
    bench.pass(200 * kMs);
  }
  EXPECT_NEAR(bench.v()[0], 0.6 * hal::eyebot::kind().flight()->max_speed_m_s, 1e-9);
  EXPECT_NEAR(bench.v()[1], 0.8 * hal::eyebot::kind().flight()->max_speed_m_s, 1e-9);
  EXPECT_NEAR(bench.robot.senses().turn_rad_s[2], hal::eyebot::kind().flight()->max_turn_rad_s, 1e-9);
}

TEST(Eyebot, TurnsVelocitiesOfTheBodyWithItself) {
  Bench bench;
  bench.take_off();
  bench.fly_to({.z = 1.0, .use_yaw = true, .yaw = 2.0});
  bench.pass(5 * kSecond);
  bench.hear("cmd/velocity", hand_written::velocity(bench.head(kHub), 1.0, 0.0, 0.0, 0.0, 1000, 1));
  bench.pass(900 * kMs);
  EXPECT_NEAR(bench.v()[0], std::cos(2.0), 0.02);
  EXPECT_NEAR(bench.v()[1], std::sin(2.0), 0.02);
}

TEST(Eyebot, LandsAndRestsArmed) {
  Bench bench;
  bench.take_off();
  EXPECT_EQ(bench.order(Action::Land, 0.5F), 0);
  bench.pass(4 * kSecond);
  EXPECT_EQ(bench.mode(), Mode::Idle);
  EXPECT_TRUE(bench.robot.senses().on_ground);
  EXPECT_TRUE(bench.status().armed);
  EXPECT_EQ(bench.logged(R"("event":"landed")"), 1);
}

TEST(Eyebot, HangsAtTheCeilingAndComesBack) {
  Bench bench;
  bench.attach();
  const auto status = bench.status();
  EXPECT_TRUE(status.attached && status.magnet);
  EXPECT_NEAR(bench.p()[2], 5.0 - hal::eyebot::kind().body.height_m, 1e-9);
  EXPECT_FALSE(bench.robot.command().motors);
  bench.velocity(1.0, 0.0, 0.0);
  EXPECT_EQ(bench.mode(), Mode::Attached);
  EXPECT_EQ(bench.robot.rejected(), 1);
  EXPECT_EQ(bench.order(Action::Detach), 0);
  bench.pass(3 * kSecond);
  EXPECT_EQ(bench.mode(), Mode::Hover);
  EXPECT_LT(bench.p()[2], 5.0 - hal::eyebot::kind().body.height_m - 0.25);
  EXPECT_NEAR(speed(bench), 0.0, 1e-2);
}

TEST(Eyebot, FallsInAnEmergency) {
  Bench bench;
  bench.take_off();
  EXPECT_EQ(bench.order(Action::Estop, 0.0F, kOtherHub), 0);
  bench.pass(2 * kSecond);
  EXPECT_EQ(bench.mode(), Mode::Estop);
  EXPECT_TRUE(bench.robot.senses().on_ground);
  EXPECT_EQ(bench.status().mode, 10);
  EXPECT_EQ(bench.logged(R"("event":"landed","robot":"eb0","speed_m_s":4.)"), 1) << "from a metre";
}

// Orders -----------------------------------------------------------------------

TEST(Orders, AreAcknowledgedByNumber) {
  Bench bench;
  const auto head = bench.head(kHub);
  bench.sent("");
  bench.hear("cmd/mode", hand_written::mode(head, 1));
  const auto acks = bench.sent("ack");
  ASSERT_EQ(acks.size(), 1U);
  const auto ack = hand_written::read_ack(acks[0]);
  EXPECT_EQ(ack.channel, "eyebot/eb0/cmd/mode");
  EXPECT_EQ(ack.session, kHub);
  EXPECT_EQ(ack.seq, head.seq);
  EXPECT_EQ(ack.result, 0);
}

TEST(Orders, AreCarriedOutOnceAndAnsweredAgain) {
  Bench bench;
  EXPECT_EQ(bench.order(Action::Arm), 0);
  const Bytes takeoff = hand_written::mode(bench.head(kHub), 3);
  EXPECT_EQ(bench.send_order(takeoff), 0);
  bench.pass(4 * kSecond);
  EXPECT_EQ(bench.order(Action::Land), 0);
  bench.pass(6 * kSecond);
  ASSERT_EQ(bench.mode(), Mode::Idle);
  EXPECT_EQ(bench.send_order(takeoff), 0) << "as it was answered";
  bench.pass(kSecond);
  EXPECT_EQ(bench.mode(), Mode::Idle) << "and not flown again";
  EXPECT_EQ(bench.logged(R"("again":true)"), 1);
  EXPECT_EQ(bench.robot.rejected(), 0);
}

TEST(Orders, ThatWereRefusedAreRefusedAgainWithoutCounting) {
  Bench bench;
  const Bytes takeoff = hand_written::mode(bench.head(kHub), 3);
  EXPECT_EQ(bench.send_order(takeoff), 4);
  EXPECT_EQ(bench.order(Action::Arm), 0);
  EXPECT_EQ(bench.send_order(takeoff), 4) << "what was refused is not done later";
  EXPECT_EQ(bench.mode(), Mode::Idle);
  EXPECT_EQ(bench.robot.rejected(), 1);
}

TEST(Orders, ThatCameTooLateAreStale) {
  Bench bench;
  EXPECT_EQ(bench.send_order(hand_written::mode({bench.robot.utime(bench.now), 50, kHub}, 1)), 0);
  EXPECT_EQ(bench.send_order(hand_written::mode({bench.robot.utime(bench.now), 49, kHub}, 3)), 3);
  EXPECT_EQ(bench.mode(), Mode::Idle);
}

TEST(Orders, AreRememberedAmongManyHubs) {
  Bench bench;
  const Bytes arm = hand_written::mode(bench.head(kHub), 1);
  EXPECT_EQ(bench.send_order(arm), 0);
  EXPECT_EQ(bench.order(Action::Disarm), 0);
  for (std::int32_t hub = 1; hub <= 30; ++hub) bench.beat(1000 + hub);
  EXPECT_EQ(bench.send_order(arm), 0) << "as it was answered";
  EXPECT_FALSE(bench.robot.supervisor().armed()) << "and not done again";
  EXPECT_EQ(bench.logged(R"("event":"heartbeat")"), 30) << "each hub is told once";
  for (std::int32_t hub = 1; hub <= 30; ++hub) bench.beat(1000 + hub);
  EXPECT_EQ(bench.logged(R"("event":"heartbeat")"), 30);
}

TEST(Orders, OfUnknownKindsAreUnsupported) {
  Bench bench;
  EXPECT_EQ(bench.send_order(hand_written::mode(bench.head(kHub), 42)), 5);
}

TEST(Orders, OfAnotherHubAreRefusedWhileOneIsInControl) {
  Bench bench;
  bench.take_off();
  EXPECT_EQ(bench.order(Action::Land, 0.0F, kOtherHub), 4);
  EXPECT_EQ(bench.order(Action::Arm, 0.0F, kOtherHub), 4);
  bench.velocity(1.0, 0.0, 0.0, 0.0, kOtherHub);
  EXPECT_EQ(bench.mode(), Mode::Hover);
  EXPECT_EQ(bench.robot.rejected(), 3);
  EXPECT_EQ(bench.status().rejected, 3);
}

TEST(Orders, ShowInTheStatus) {
  Bench bench;
  bench.take_off();
  const auto head = bench.head(kHub);
  bench.hear("cmd/velocity", hand_written::velocity(head, 0.1, 0.0, 0.0));
  const auto status = bench.status();
  EXPECT_EQ(status.mode, 5);
  EXPECT_EQ(status.cmd_session, kHub);
  EXPECT_EQ(status.cmd_seq, head.seq);
  EXPECT_GE(status.cmd_age_ms, 0);
  EXPECT_LE(status.cmd_age_ms, 100);
}

// Setpoints --------------------------------------------------------------------

TEST(Setpoints, AreTakenInTheirOrderOnly) {
  Bench bench;
  bench.take_off();
  const std::int64_t utime = bench.robot.utime(bench.now);
  const auto flown = [&](std::int32_t seq, double x) {
    bench.hear("cmd/velocity", hand_written::velocity({utime, seq, kHub}, x, 0.0, 0.0));
    bench.robot.run_until(bench.now += 10 * kMs);
    return bench.robot.command().velocity_m_s[0];
  };
  EXPECT_EQ(flown(0x7FFFFFFF, 0.1), 0.1);
  EXPECT_EQ(flown(0x7FFFFFFF, 0.2), 0.1) << "the same once more";
  EXPECT_EQ(flown(0x7FFFFFFE, 0.3), 0.1) << "an older one";
  EXPECT_EQ(flown(-0x7FFFFFFF - 1, 0.4), 0.4) << "the numbers go on beyond their end";
  EXPECT_EQ(flown(-0x7FFFFFFF, 0.5), 0.5);
  EXPECT_EQ(flown(0x7FFFFFFF, 0.6), 0.5);
  EXPECT_EQ(bench.robot.rejected(), 3);
}

TEST(Setpoints, AreRefusedWhenTheirStampIsOff) {
  Bench bench;
  bench.take_off();
  const std::int64_t now = bench.robot.utime(bench.now);
  std::int32_t seq = 1000;
  const auto taken = [&](std::int64_t utime) {
    const std::int32_t before = bench.robot.rejected();
    bench.hear("cmd/velocity", hand_written::velocity({utime, seq++, kHub}, 0.1, 0.0, 0.0));
    return bench.robot.rejected() == before;
  };
  EXPECT_TRUE(taken(now));
  EXPECT_TRUE(taken(now - 250'000));
  EXPECT_TRUE(taken(now + 250'000));
  EXPECT_FALSE(taken(now - 250'001));
  EXPECT_FALSE(taken(now + 250'001));
  EXPECT_FALSE(taken(std::numeric_limits<std::int64_t>::min()));
  EXPECT_FALSE(taken(std::numeric_limits<std::int64_t>::max()));
}

TEST(Setpoints, MayHaveAnyStampWhereClocksDiffer) {
  Eyebot::Options options;
  options.clock_synced = false;
  Bench bench(options);
  bench.take_off();
  std::int32_t seq = 1000;
  for (const std::int64_t utime :
       {std::int64_t{0}, std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max()}) {
    bench.hear("cmd/velocity", hand_written::velocity({utime, seq++, kHub}, 0.1, 0.0, 0.0));
  }
  EXPECT_EQ(bench.robot.rejected(), 0);
  EXPECT_EQ(bench.mode(), Mode::Velocity);
}

TEST(Setpoints, ThatAreNoNumbersChangeNothing) {
  Bench bench;
  bench.take_off();
  bench.velocity(0.3, 0.0, 0.0);
  bench.velocity(kNan, 0.0, 0.0);
  bench.velocity(0.0, 0.0, std::numeric_limits<double>::infinity());
  bench.velocity(0.0, 0.0, 0.0, kNan);
  bench.fly_to({.x = kNan});
  bench.fly_to({.use_yaw = true, .yaw = kNan});
  bench.fly_to({.max_speed = std::numeric_limits<float>::quiet_NaN()});
  EXPECT_EQ(bench.robot.rejected(), 6);
  EXPECT_EQ(bench.failsafe(), Failsafe::None);
  EXPECT_EQ(bench.mode(), Mode::Velocity);
  bench.pass(300 * kMs);
  EXPECT_NEAR(bench.v()[0], 0.3, 1e-9);
}

TEST(Setpoints, InNoFrameOrBeyondTheFenceAreRefused) {
  Bench bench(fenced({5.0, 5.0, 3.0}));
  bench.take_off();
  bench.fly_to({.x = 5.1, .z = 1.0});
  bench.fly_to({.z = 3.1});
  bench.fly_to({.z = 1.0, .frame = 2});
  bench.hear("cmd/velocity", hand_written::velocity(bench.head(kHub), 1.0, 0.0, 0.0, 0.0, 0, -1));
  EXPECT_EQ(bench.robot.rejected(), 4);
  EXPECT_EQ(bench.mode(), Mode::Hover);
  bench.fly_to({.x = 4.9, .z = 1.0});
  EXPECT_EQ(bench.mode(), Mode::Position);
}

TEST(Setpoints, OfPlacesEndWhenTheySaySo) {
  Bench bench;
  bench.take_off();
  bench.fly_to({.x = 9.0, .z = 1.0, .timeout_ms = 1000});
  bench.pass(990 * kMs);
  EXPECT_EQ(bench.mode(), Mode::Position);
  bench.pass(20 * kMs);
  EXPECT_EQ(bench.mode(), Mode::Hover);
  EXPECT_EQ(bench.failsafe(), Failsafe::CommandTimeout);
}

// Fail-safes -------------------------------------------------------------------

TEST(Failsafes, HoverAndThenLandWithoutTheHub) {
  Bench bench;
  bench.take_off();
  bench.hear("cmd/velocity", hand_written::velocity(bench.head(kHub), 0.5, 0.0, 0.0, 0.0, 60'000));
  bench.pass(1700 * kMs, false);
  EXPECT_EQ(bench.mode(), Mode::Velocity);
  bench.pass(400 * kMs, false);
  EXPECT_EQ(bench.mode(), Mode::Hover);
  EXPECT_EQ(bench.failsafe(), Failsafe::LinkLost);
  bench.pass(3 * kSecond, false);
  EXPECT_NEAR(speed(bench), 0.0, 1e-2);
  EXPECT_GT(bench.p()[2], 0.8);
  bench.pass(5 * kSecond, false);
  EXPECT_EQ(bench.mode(), Mode::Land);
  bench.pass(5 * kSecond, false);
  EXPECT_EQ(bench.mode(), Mode::Idle);
  const auto status = bench.status();
  EXPECT_FALSE(status.armed);
  EXPECT_EQ(status.failsafe, 2);
  EXPECT_THAT(status.text, HasSubstr("link_lost"));
}

TEST(Failsafes, EndWhenTheHubIsBackAndClearsThem) {
  Bench bench;
  bench.take_off();
  bench.pass(3 * kSecond, false);
  ASSERT_EQ(bench.failsafe(), Failsafe::LinkLost);
  bench.beat(kHub);
  bench.velocity(0.2, 0.0, 0.0);
  EXPECT_EQ(bench.mode(), Mode::Hover) << "latched";
  EXPECT_EQ(bench.order(Action::ClearFailsafe), 0);
  bench.velocity(0.2, 0.0, 0.0);
  EXPECT_EQ(bench.mode(), Mode::Velocity);
}

TEST(Failsafes, HoverAtTheFence) {
  Bench bench(fenced({3.0, 50.0, 20.0}));
  bench.take_off();
  for (int i = 0; i < 20 && bench.failsafe() == Failsafe::None; ++i) {
    bench.velocity(1.0, 0.0, 0.0);
    bench.pass(200 * kMs);
  }
  EXPECT_EQ(bench.failsafe(), Failsafe::Geofence);
  EXPECT_EQ(bench.mode(), Mode::Hover);
  bench.pass(5 * kSecond);
  EXPECT_NEAR(bench.p()[0], 2.95, 0.02);
  bench.velocity(-1.0, 0.0, 0.0);
  EXPECT_EQ(bench.mode(), Mode::Hover) << "latched";
  EXPECT_EQ(bench.order(Action::ClearFailsafe), 0);
  bench.velocity(-1.0, 0.0, 0.0);
  EXPECT_EQ(bench.mode(), Mode::Velocity);
}

TEST(Failsafes, LandWithAnEmptyBattery) {
  Bench bench;
  bench.take_off();
  bench.robot.set_charge(0.15);
  bench.sent("");
  bench.pass(kSecond);
  const auto reports = bench.sent("battery");
  ASSERT_FALSE(reports.empty());
  EXPECT_EQ(reports.back().back(), std::byte{1}) << "low";
  EXPECT_EQ(bench.mode(), Mode::Hover);
  bench.robot.set_charge(0.09);
  bench.pass(10 * kSecond);
  EXPECT_EQ(bench.mode(), Mode::Idle);
  EXPECT_EQ(bench.failsafe(), Failsafe::LowBattery);
  EXPECT_EQ(bench.order(Action::ClearFailsafe), 6);
  EXPECT_EQ(bench.order(Action::TakeOff), 1);
}

TEST(Failsafes, LandWhenTheBatteryHasRunDown) {
  Eyebot::Options options;
  options.flight_s = 20.0;
  Bench bench(options);
  bench.take_off();
  bench.pass(20 * kSecond);
  EXPECT_EQ(bench.failsafe(), Failsafe::LowBattery);
  EXPECT_EQ(bench.mode(), Mode::Idle);
}

TEST(Failsafes, SinkWithoutAPosition) {
  Bench bench;
  bench.take_off();
  bench.velocity(1.0, 0.0, 0.0);
  bench.robot.set_position_lost(true);
  bench.pass(kSecond);
  EXPECT_EQ(bench.failsafe(), Failsafe::NoPosition);
  EXPECT_NEAR(bench.v()[2], -0.3, 1e-6);
  EXPECT_NEAR(std::hypot(bench.v()[0], bench.v()[1]), 0.0, 1e-6);
  EXPECT_EQ(std::to_integer<int>(bench.sent("state").back()[25]), 0) << "pos_valid";
  bench.robot.set_position_lost(false);
  bench.pass(kSecond);
  EXPECT_EQ(bench.failsafe(), Failsafe::None);
  EXPECT_EQ(bench.mode(), Mode::Hover);
  EXPECT_EQ(std::to_integer<int>(bench.sent("state").back()[25]), 1);
}

TEST(Failsafes, SurviveAClockThatJumps) {
  Bench bench;
  bench.take_off();
  bench.velocity(0.5, 0.0, 0.0);
  bench.robot.jump_clock(3'600'000'000);
  const std::int64_t hubs_clock = bench.robot.utime(bench.now) - 3'600'000'000;
  for (int i = 0; i < 10; ++i) {
    bench.hear("cmd/velocity", hand_written::velocity({hubs_clock, 5000 + i, kHub}, 0.5, 0.0, 0.0));
    bench.pass(100 * kMs);
  }
  EXPECT_EQ(bench.robot.rejected(), 10);
  EXPECT_EQ(bench.mode(), Mode::Hover);
  EXPECT_EQ(bench.failsafe(), Failsafe::CommandTimeout) << "its hub lives, but says nothing that counts";
  const auto estop = hand_written::mode({hubs_clock, 6000, kHub}, 8);
  EXPECT_EQ(bench.send_order(estop), 0) << "an emergency has no age";
}

TEST(Failsafes, AreSilentAboutAnotherRobotsCommands) {
  Bench bench;
  bench.take_off();
  bench.robot.receive("eyebot/eb1/cmd/mode", hand_written::mode(bench.head(kHub), 8), bench.now);
  bench.robot.receive("eyebot/eb/cmd/mode", hand_written::mode(bench.head(kHub), 8), bench.now);
  bench.robot.receive("eyebot/eb0/status", hand_written::mode(bench.head(kHub), 8), bench.now);
  EXPECT_EQ(bench.mode(), Mode::Hover);
}

// Devices ----------------------------------------------------------------------

TEST(Devices, DoTheNewestThatTheyAreTold) {
  Bench bench;
  Writer leds("cmd/leds", bench.head(kHub));
  leds.i8(5);
  for (int i = 0; i < 99; ++i) leds.i8(i);
  bench.hear("cmd/leds", leds.bytes);
  EXPECT_TRUE(bench.robot.command().lights.lower_on && !bench.robot.command().lights.upper_on);
  EXPECT_EQ(bench.robot.command().lights.upper[1], 49);
  bench.hear("cmd/pan_tilt", Writer("cmd/pan_tilt", bench.head(kHub)).f32(1.0F).f32(0.5F).i8(1).bytes);
  bench.hear("cmd/rab", Writer("cmd/rab", bench.head(kHub)).i8(2).i8(7).i8(8).bytes);
  EXPECT_EQ(bench.robot.command().radio, (std::vector<std::uint8_t>{7, 8}));
  bench.hear("cmd/rab", Writer("cmd/rab", bench.head(kHub)).i8(0).bytes);
  EXPECT_TRUE(bench.robot.command().radio.empty());
  bench.pass(kSecond);
  const Bytes report = bench.sent("pan_tilt").back();
  hand_written::Reader r(report);
  r.fingerprint();
  r.head();
  EXPECT_FLOAT_EQ(r.f32(), 1.0F);
  EXPECT_FLOAT_EQ(r.f32(), 0.5F);
  EXPECT_EQ(r.i8(), 1);
  EXPECT_EQ(bench.logged(R"("event":"lights")"), 1);
  EXPECT_EQ(bench.logged(R"("event":"pan_tilt")"), 1);
  EXPECT_EQ(bench.logged(R"("event":"radio")"), 2);
}

TEST(Devices, TellTheLightsWhenTheyChange) {
  Bench bench;
  bench.sent("");
  for (const int shade : {9, 9, 10}) {
    Writer leds("cmd/leds", bench.head(kHub));
    leds.i8(1);
    for (int i = 0; i < 99; ++i) leds.i8(shade);
    bench.hear("cmd/leds", leds.bytes);
  }
  const auto told = bench.sent("leds");
  ASSERT_EQ(told.size(), 2U);
  EXPECT_EQ(told[1].back(), std::byte{10});
}

TEST(Devices, RefuseWhatTheyCannotDo) {
  Bench bench;
  Writer radio("cmd/rab", bench.head(kHub));
  radio.i8(11);
  for (int i = 0; i < 11; ++i) radio.i8(1);
  bench.hear("cmd/rab", radio.bytes);
  EXPECT_TRUE(bench.robot.command().radio.empty());
  const float nan = std::numeric_limits<float>::quiet_NaN();
  bench.hear("cmd/pan_tilt", Writer("cmd/pan_tilt", bench.head(kHub)).f32(nan).f32(0.0F).i8(0).bytes);
  EXPECT_EQ(bench.robot.command().pan_rad, 0.0);
  EXPECT_EQ(bench.logged(R"("verdict":"rejected_range")"), 2);
  EXPECT_EQ(bench.robot.rejected(), 0) << "no flight commands";
}

TEST(Devices, ObeyTheHubInControlAlone) {
  Bench bench;
  EXPECT_EQ(bench.order(Action::Arm), 0);
  bench.hear("cmd/rab", Writer("cmd/rab", bench.head(kOtherHub)).i8(1).i8(7).bytes);
  EXPECT_TRUE(bench.robot.command().radio.empty());
  bench.hear("cmd/rab", Writer("cmd/rab", bench.head(kHub)).i8(1).i8(7).bytes);
  EXPECT_FALSE(bench.robot.command().radio.empty());
}

TEST(Devices, ScanTheRoom) {
  Bench bench({}, Room{4.0, 4.0, 5.0});
  bench.hear("cmd/scanner", Writer("cmd/scanner", bench.head(kHub)).i8(1).i8(0).f32(60.0F).f32(0.0F).bytes);
  bench.pass(kSecond);
  const auto scans = bench.sent("scan");
  ASSERT_FALSE(scans.empty());
  hand_written::Reader r(scans.back());
  r.fingerprint();
  r.head();
  EXPECT_FLOAT_EQ(r.f32(), 60.0F);
  r.f32();
  const int n = r.i32();
  ASSERT_EQ(n, 40);
  std::set<int> heads;
  for (int i = 0; i < n; ++i) heads.insert(r.i8());
  EXPECT_EQ(heads, (std::set{0, 1, 2, 3}));
  std::vector<int> dt;
  for (int i = 0; i < n; ++i) dt.push_back(r.i32());
  EXPECT_LE(*std::max_element(dt.begin(), dt.end()), 0);
  EXPECT_EQ(dt.front(), -90'000);
  std::vector<float> angle;
  for (int i = 0; i < n; ++i) angle.push_back(r.f32());
  for (const float a : angle) {
    const float range = r.f32();
    const float wall = 2.0F / std::max(std::fabs(std::cos(a)), std::fabs(std::sin(a)));
    EXPECT_NEAR(range, wall, 1e-4F);
  }
  EXPECT_TRUE(r.at_end());
}

TEST(Devices, HearTheRadio) {
  Bench bench;
  bench.body.heard.push_back({5, 1.5, 0.5, 0.25, {1, 2, 3}});
  bench.sent("");
  bench.pass(200 * kMs, false);
  const auto reports = bench.sent("rab");
  ASSERT_EQ(reports.size(), 2U);
  hand_written::Reader r(reports[0]);
  r.fingerprint();
  r.head();
  ASSERT_EQ(r.i32(), 1);
  EXPECT_EQ(r.i32(), 5);
  EXPECT_EQ(r.f32(), 1.5F);
  EXPECT_EQ(r.f32(), 0.5F);
  EXPECT_EQ(r.f32(), 0.25F);
  r.i64();
  ASSERT_EQ(r.i8(), 3);
  EXPECT_EQ(reports[1].size(), 28U) << "each is told once";
}

TEST(Devices, LoseTheirStateWithThePower) {
  Bench bench;
  bench.take_off();
  bench.hear("cmd/rab", Writer("cmd/rab", bench.head(kHub)).i8(1).i8(7).bytes);
  bench.robot.restart(99, bench.now);
  EXPECT_EQ(bench.mode(), Mode::Off);
  bench.sent("");
  bench.velocity(1.0, 0.0, 0.0);
  EXPECT_EQ(bench.sent("status").size(), 0U) << "deaf and mute while it starts";
  bench.pass(2 * kSecond);
  EXPECT_EQ(bench.mode(), Mode::Idle);
  EXPECT_TRUE(bench.robot.senses().on_ground) << "it fell";
  EXPECT_TRUE(bench.robot.command().radio.empty());
  const auto status = bench.status();
  EXPECT_EQ(status.head.session, 99);
  EXPECT_FALSE(status.armed);
  EXPECT_EQ(bench.order(Action::TakeOff), 4) << "nobody is in control any more";
}

// The log ----------------------------------------------------------------------

TEST(Log, TellsHowLongACommandTook) {
  Bench bench;
  bench.take_off();
  bench.robot.run_until(bench.now += 20 * kMs);
  bench.robot.state_left(bench.now + kMs);
  bench.now += 2 * kMs;
  bench.velocity(0.1, 0.0, 0.0);
  const std::string line = bench.log.back().find("command") != std::string::npos ? bench.log.back() : [&] {
    return *std::find_if(bench.log.rbegin(), bench.log.rend(),
                         [](const std::string& l) { return l.find(R"("event":"command")") != std::string::npos; });
  }();
  EXPECT_THAT(line, HasSubstr("{\"t_ns\":" + std::to_string(bench.now)));
  EXPECT_THAT(line, HasSubstr("\"state_sent_ns\":" + std::to_string(bench.now - kMs)));
  EXPECT_THAT(line, HasSubstr("\"first\":true"));
  EXPECT_THAT(line, HasSubstr("\"age_us\":0,"));
  EXPECT_THAT(line, HasSubstr("\"x\":0.1,"));
  bench.velocity(0.1, 0.0, 0.0);
  const auto again = std::find_if(bench.log.rbegin(), bench.log.rend(), [](const std::string& l) {
    return l.find(R"("event":"command")") != std::string::npos;
  });
  EXPECT_THAT(*again, HasSubstr("\"first\":false"));
}

TEST(Delays, TheBodyFliesLateAndItsPlaceIsToldLater) {
  const auto flown = [](const Delays& delays) {
    Eyebot::Options options;
    options.delays = delays;
    Bench bench(options);
    bench.take_off();
    const double from_m = bench.body.sense(bench.now).p_WB[0];
    bench.velocity(0.2, 0.0, 0.0);
    bench.pass(400 * kMs);
    const double body_m = bench.body.sense(bench.now).p_WB[0];
    return std::pair(body_m - from_m, body_m - bench.robot.senses().p_WB[0]);
  };
  const auto at_once = flown({});
  const auto late = flown({.command_s = 0.1});
  EXPECT_NEAR(at_once.first - late.first, 0.1 * 0.2, 0.004);
  const auto told_late = flown({.counters_s = 0.1});
  EXPECT_NEAR(at_once.first, told_late.first, 0.004);
  EXPECT_NEAR(told_late.second - at_once.second, 0.1 * 0.2, 0.004);
}

TEST(Log, TellsOfDamageAtMostEveryTenSeconds) {
  Bench bench;
  for (int i = 0; i < 100; ++i) {
    bench.hear("cmd/velocity", Bytes(60));
    bench.pass(100 * kMs);
  }
  bench.hear("cmd/velocity", Bytes(60));
  bench.hear("cmd/mode", Bytes(29));
  EXPECT_EQ(bench.logged(R"("event":"malformed")"), 3);
  EXPECT_EQ(bench.logged(R"("count":101)"), 1);
  EXPECT_EQ(bench.mode(), Mode::Idle);
  EXPECT_EQ(bench.robot.rejected(), 0);
}

TEST(Log, CountsWhatWasSent) {
  Bench bench;
  bench.robot.tell_sent(bench.now);
  const int states = static_cast<int>(bench.sent("state").size());
  EXPECT_EQ(bench.logged("\"channel\":\"eyebot/eb0/state\",\"count\":" + std::to_string(states) +
                         ",\"last_seq\":" + std::to_string(states - 1)),
            1);
}

}  // namespace
}  // namespace tandem::bridges::eyebot_emulator
