// The generated C against bytes written by hand, and against what no generator would write.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <limits>

#include "bridges/eyebot_emulator/commands.hpp"
#include "bridges/eyebot_emulator/telemetry.hpp"
#include "hal/device/cameras.hpp"
#include "tests/bridges/eyebot_emulator/hand_written.hpp"

namespace tandem::bridges::eyebot_emulator {
namespace {

using hand_written::from_hex;
using hand_written::Writer;
using testing::HasSubstr;

constexpr std::int64_t kUtime = 1'700'000'000'000'000;
constexpr Header kHeader{kUtime, 7, 0x1234};
constexpr hand_written::Head kHead{kUtime, 7, 0x1234};

TEST(CommandsFromTheWire, AreThoseOfTheExamples) {
  const auto velocity = read_command(
      "cmd/velocity", from_hex("E9 14 93 5F 10 4F 82 14 | 00 06 0A 24 18 1E 40 00 00 00 00 07 00 00 12 34 | 01"
                               "3F E0 00 00 00 00 00 00 00 00 00 00 00 00 00 00 BF D0 00 00 00 00 00 00 |"
                               "3F B9 99 99 99 99 99 9A | 00 00 01 F4"));
  ASSERT_TRUE(velocity.ok()) << velocity.error().message;
  EXPECT_EQ(velocity.value().header.utime, kUtime);
  EXPECT_EQ(velocity.value().header.seq, 7);
  EXPECT_EQ(velocity.value().header.session, 0x1234);
  const auto& v = std::get<VelocityCommand>(velocity.value().body);
  EXPECT_EQ(v.frame, 1);
  EXPECT_EQ(v.vel, (std::array{0.5, 0.0, -0.25}));
  EXPECT_EQ(v.yaw_rate, 0.1);
  EXPECT_EQ(v.timeout_ms, 500);

  const auto takeoff = read_command(
      "cmd/mode",
      from_hex("1D 06 FE C6 83 B9 2E 45 | 00 06 0A 24 18 1E 40 00 00 00 00 07 00 00 12 34 | 03 | 3F 00 00 00"));
  ASSERT_TRUE(takeoff.ok()) << takeoff.error().message;
  EXPECT_EQ(std::get<ModeCommand>(takeoff.value().body).action, 3);
  EXPECT_EQ(std::get<ModeCommand>(takeoff.value().body).param, 0.5F);

  const auto alive = read_command(
      "heartbeat", from_hex("7D 37 0A 60 5B EB 9B CC | 00 06 0A 24 18 1E 40 00 00 00 00 07 00 00 12 34 | 00 00 00 04 65"
                            "62 30 00 | 01 01 00 | 00 00 00 C8 | 00 00 00 00 00 00 30 39"));
  ASSERT_TRUE(alive.ok()) << alive.error().message;
  EXPECT_EQ(std::get<HubHeartbeat>(alive.value().body).name, "eb0");
  EXPECT_EQ(std::get<HubHeartbeat>(alive.value().body).major, 1);
  EXPECT_EQ(std::get<HubHeartbeat>(alive.value().body).period_ms, 200);
}

TEST(CommandsFromTheWire, CoverEveryChannel) {
  const auto place =
      read_command("cmd/position", hand_written::position(kHead, {1.0, 2.0, 3.0, 1, true, 0.5, 0.7F, 9}));
  ASSERT_TRUE(place.ok());
  const auto& p = std::get<PositionCommand>(place.value().body);
  EXPECT_EQ(p.pos, (std::array{1.0, 2.0, 3.0}));
  EXPECT_TRUE(p.use_yaw && p.frame == 1 && p.yaw == 0.5 && p.max_speed == 0.7F && p.timeout_ms == 9);

  Writer leds("cmd/leds", kHead);
  leds.i8(5);
  for (int i = 0; i < 99; ++i) leds.i8(i);
  const auto lights = read_command("cmd/leds", leds.bytes);
  ASSERT_TRUE(lights.ok());
  const auto& l = std::get<LedsCommand>(lights.value().body);
  EXPECT_EQ(l.rings, 5);
  EXPECT_EQ(l.lower[47], 47);
  EXPECT_EQ(l.upper[0], 48);
  EXPECT_EQ(l.beacon[2], 98);

  const auto head = read_command("cmd/pan_tilt", Writer("cmd/pan_tilt", kHead).f32(1.0F).f32(-0.5F).i8(1).bytes);
  ASSERT_TRUE(head.ok());
  EXPECT_EQ(std::get<PanTiltCommand>(head.value().body).tilt, -0.5F);
  const auto scanner = read_command("cmd/scanner", Writer("cmd/scanner", kHead).i8(1).i8(0).f32(30.0F).f32(2.0F).bytes);
  ASSERT_TRUE(scanner.ok());
  EXPECT_EQ(std::get<ScannerCommand>(scanner.value().body).rpm, 30.0F);
  const auto radio = read_command("cmd/rab", Writer("cmd/rab", kHead).i8(2).i8(7).i8(8).bytes);
  ASSERT_TRUE(radio.ok());
  EXPECT_EQ(std::get<RadioCommand>(radio.value().body).data, (std::vector<std::uint8_t>{7, 8}));
}

TEST(CommandsFromTheWire, AreRefusedInEveryOtherLength) {
  const std::map<std::string, Bytes> whole = {
      {"cmd/mode", hand_written::mode(kHead, 1)},
      {"cmd/position", hand_written::position(kHead, {})},
      {"cmd/velocity", hand_written::velocity(kHead, 0, 0, 0)},
      {"cmd/pan_tilt", Writer("cmd/pan_tilt", kHead).f32(0).f32(0).i8(0).bytes},
      {"cmd/scanner", Writer("cmd/scanner", kHead).i8(0).i8(0).f32(0).f32(0).bytes},
      {"cmd/rab", Writer("cmd/rab", kHead).i8(3).i8(1).i8(2).i8(3).bytes},
      {"heartbeat", hand_written::hub_heartbeat(kHead)}};
  for (const auto& [topic, bytes] : whole) {
    ASSERT_TRUE(read_command(topic, bytes).ok()) << topic;
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      EXPECT_FALSE(read_command(topic, std::span(bytes).first(size)).ok()) << topic << " of " << size;
    }
    Bytes longer = bytes;
    longer.push_back(std::byte{0});
    EXPECT_FALSE(read_command(topic, longer).ok()) << topic;
    Bytes foreign = bytes;
    foreign[3] ^= std::byte{1};
    const auto refused = read_command(topic, foreign);
    ASSERT_FALSE(refused.ok());
    EXPECT_THAT(refused.error().message, HasSubstr("fingerprint")) << topic;
  }
  EXPECT_FALSE(read_command("cmd/explode", hand_written::mode(kHead, 1)).ok());
}

TEST(CommandsFromTheWire, MayLieAboutLengths) {
  for (const int length : {-1, -128, 127, 4}) {
    EXPECT_FALSE(read_command("cmd/rab", Writer("cmd/rab", kHead).i8(length).i8(1).i8(2).i8(3).bytes).ok()) << length;
  }
  const auto named = [](std::int32_t length, std::string_view bytes) {
    Writer w("heartbeat", kHead);
    w.i32(length);
    for (const char c : bytes) w.i8(c);
    return w.i8(0).i8(1).i8(0).i32(200).i64(0).bytes;
  };
  using namespace std::string_view_literals;
  EXPECT_TRUE(read_command("heartbeat", named(4, "lab\0"sv)).ok());
  for (const std::int32_t length : {0, -1, -2147483647, 2147483647, 3, 5, 1000}) {
    EXPECT_FALSE(read_command("heartbeat", named(length, "lab\0"sv)).ok()) << length;
  }
  EXPECT_FALSE(read_command("heartbeat", named(4, "labs"sv)).ok()) << "without end";
  EXPECT_FALSE(read_command("heartbeat", named(4, "l\0b\0"sv)).ok()) << "with two ends";
}

TEST(Commands, AreFiniteOrNot) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr float kInf = std::numeric_limits<float>::infinity();
  EXPECT_TRUE(is_finite(VelocityCommand{0, {1, 2, 3}, 4, 5}));
  EXPECT_FALSE(is_finite(VelocityCommand{0, {1, kNan, 3}, 4, 5}));
  EXPECT_FALSE(is_finite(VelocityCommand{0, {1, 2, 3}, kNan, 5}));
  EXPECT_FALSE(is_finite(PositionCommand{0, true, {1, 2, kNan}, 0, 0, 0}));
  EXPECT_FALSE(is_finite(PositionCommand{0, true, {1, 2, 3}, 0, kInf, 0}));
  EXPECT_FALSE(is_finite(ModeCommand{1, -kInf}));
  EXPECT_FALSE(is_finite(PanTiltCommand{kInf, 0, false}));
  EXPECT_FALSE(is_finite(ScannerCommand{true, true, 0, kInf}));
}

TEST(Reports, AreTheBytesOfTheExamples) {
  BodySenses senses;
  senses.ground_m = 1.5;
  EXPECT_EQ(write_altitude(kHeader, senses),
            from_hex("7E 25 F7 5E CB F0 25 0B | 00 06 0A 24 18 1E 40 00 00 00 00 07 00 00 12 34 | 3F C0 00 00 |"
                     "BF 80 00 00"));
  EXPECT_EQ(
      write_battery(kHeader, {11.1, -1.0, -1.0, -1.0, false}),
      from_hex("CF 66 38 32 97 4E B4 B4 | 00 06 0A 24 18 1E 40 00 00 00 00 07 00 00 12 34 | 41 31 99 9A BF 80 00 00"
               "BF 80 00 00 BF 80 00 00 00"));
  EXPECT_EQ(
      write_heartbeat(kHeader, "eb0", 12345),
      from_hex("7D 37 0A 60 5B EB 9B CC | 00 06 0A 24 18 1E 40 00 00 00 00 07 00 00 12 34 | 00 00 00 04 65 62 30 00"
               "| 01 01 00 | 00 00 00 C8 | 00 00 00 00 00 00 30 39"));
  const double angle = static_cast<double>(std::bit_cast<float>(0x40466666U));
  EXPECT_EQ(write_scan(kHeader, 30.0, 0.0, {{0, kUtime - 4000, 0.0, 0.25}, {2, kUtime, angle, -2.0}}),
            from_hex("F8 11 13 97 00 A5 83 52 | 00 06 0A 24 18 1E 40 00 00 00 00 07 00 00 12 34 | 41 F0 00 00 |"
                     "00 00 00 00 | 00 00 00 02 | 00 02 | FF FF F0 60 00 00 00 00 | 00 00 00 00 40 46 66 66 |"
                     "3E 80 00 00 C0 00 00 00"));
  EXPECT_EQ(write_ack(kHeader, {"eyebot/eb0/cmd/mode", 0x1234, 7, 0, ""}), [] {
    Writer w("ack", kHead);
    return w.text("eyebot/eb0/cmd/mode").i32(0x1234).i32(7).i8(0).text("").bytes;
  }());
}

TEST(Reports, HaveTheirFingerprintsAndSizes) {
  BodySenses senses;
  senses.blobs = {{320.0, 240.0, {1, 2, 3}}, {0.0, 0.0, {4, 5, 6}}};
  const std::vector<Heard> heard(20, Heard{3, 1.0, 0.5, 0.25, std::vector<std::uint8_t>(10)});
  const std::vector<ScanSample> scan(40);
  const std::map<std::string_view, std::pair<Bytes, std::size_t>> reports = {
      {"heartbeat", {write_heartbeat(kHeader, "eb0", 1), 47}},
      {"status", {write_status(kHeader, {}), 50}},
      {"state", {write_state(kHeader, senses, true), 135}},
      {"altitude", {write_altitude(kHeader, senses), 32}},
      {"battery", {write_battery(kHeader, {}), 41}},
      {"scan", {write_scan(kHeader, 0.0, 0.0, scan), 556}},
      {"rab", {write_radio(kHeader, heard, kUtime), 728}},
      {"prox", {write_proximity(kHeader, senses), 120}},
      {"light", {write_light(kHeader, senses), 120}},
      {"pan_tilt", {write_pan_tilt(kHeader, senses, true), 33}},
      {"blobs", {write_blobs(kHeader, senses), 32 + 27 * 2}},
      {"image", {write_image(kHeader, senses), 24 + 16 + 64 * 48}},
      {"leds", {write_leds(kHeader, {}), 124}}};
  for (const auto& [topic, report] : reports) {
    const auto& [bytes, size] = report;
    hand_written::Reader r(bytes);
    EXPECT_EQ(r.fingerprint(), hand_written::kFingerprints.at(topic)) << topic;
    const hand_written::Head head = r.head();
    EXPECT_EQ(head.utime, kUtime);
    EXPECT_EQ(head.seq, 7);
    EXPECT_EQ(head.session, 0x1234);
    EXPECT_EQ(bytes.size(), size) << topic;
  }
}

TEST(Reports, SayWhereBlobsAre) {
  BodySenses senses;
  senses.blobs = {{320.0, 0.0, {}}, {0.0, 240.0, {}}};
  const auto directions = [&] {
    const Bytes bytes = write_blobs(kHeader, senses);
    hand_written::Reader r(bytes);
    r.fingerprint();
    r.head();
    r.i32();
    std::vector<std::pair<float, float>> all;
    for (int n = r.i32(); n > 0; --n) {
      r.f32(), r.f32(), r.f32(), r.i8(), r.i8(), r.i8(), r.f32();
      const float azimuth = r.f32();
      all.emplace_back(azimuth, r.f32());
    }
    EXPECT_TRUE(r.at_end());
    return all;
  };
  const float half_pi = static_cast<float>(std::numbers::pi / 2.0);
  const float edge = static_cast<float>(hal::eyebot::kind().part<hal::CameraPart>()->aperture_rad / 2.0);
  // Straight down: the upper edge is ahead, the left edge to the left.
  EXPECT_NEAR(directions()[0].first, 0.0F, 1e-6F);
  EXPECT_NEAR(directions()[0].second, std::atan(std::tan(edge) * 480.0F / 640.0F) - half_pi, 1e-6F);
  EXPECT_NEAR(directions()[1].first, half_pi, 1e-6F);
  EXPECT_NEAR(directions()[1].second, edge - half_pi, 1e-6F);
  // Level, to the left: the middle of the left edge is farther to the left, at the horizon.
  senses.tilt_rad = std::numbers::pi / 2.0;
  senses.pan_rad = std::numbers::pi / 2.0;
  EXPECT_NEAR(directions()[1].first, half_pi + edge, 1e-6F);
  EXPECT_NEAR(directions()[1].second, 0.0F, 1e-6F);
}

}  // namespace
}  // namespace tandem::bridges::eyebot_emulator
