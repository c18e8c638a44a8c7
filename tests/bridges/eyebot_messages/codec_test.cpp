#include "bridges/eyebot_messages/codec.hpp"

#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <string>

#include "tests/bridges/eyebot_messages/hex.hpp"

namespace tandem::bridges::eyebot_messages {
namespace {

using Bytes = std::vector<std::byte>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
// utime 1700000000000000, seq 7, session 0x1234
const std::string kHead = "00 06 0A 24 18 1E 40 00 00 00 00 07 00 00 12 34";
const Header kHeader = [] {
  Header h{};
  h.utime = 1700000000000000;
  h.seq = 7;
  h.session = 0x1234;
  return h;
}();

template <class Message>
Bytes encoded(const Message& message) {
  Bytes buffer(kMostBytes);
  const auto written = encode(message, buffer);
  return {written.begin(), written.end()};
}

template <class Message>
Message decoded(const Bytes& bytes) {
  Message message{};
  EXPECT_EQ(decode<Message>(bytes, message), Flaw::None);
  return message;
}

// --- the types are those that robots speak ---

TEST(EyebotFingerprints, AreThoseOfTheFirstVersion) {
  // Worked out from the members by a program of its own; lcm-gen's must be the same.
  EXPECT_EQ(fingerprint<Heartbeat>(), 0x7d370a605beb9bccU);
  EXPECT_EQ(fingerprint<Status>(), 0x3769e950259b2a50U);
  EXPECT_EQ(fingerprint<State>(), 0xc447b9961529edc3U);
  EXPECT_EQ(fingerprint<Altitude>(), 0x7e25f75ecbf0250bU);
  EXPECT_EQ(fingerprint<Battery>(), 0xcf663832974eb4b4U);
  EXPECT_EQ(fingerprint<Scan>(), 0xf811139700a58352U);
  EXPECT_EQ(fingerprint<Rab>(), 0x885e4473e611e92cU);
  EXPECT_EQ(fingerprint<Prox>(), 0x4c8675de71f80fb1U);
  EXPECT_EQ(fingerprint<Light>(), 0x38b7656495718092U);
  EXPECT_EQ(fingerprint<PanTilt>(), 0xc6be20f903991655U);
  EXPECT_EQ(fingerprint<Blobs>(), 0x86121504ba53e1ddU);
  EXPECT_EQ(fingerprint<Image>(), 0xefcb2ef0cd671fbcU);
  EXPECT_EQ(fingerprint<Leds>(), 0xb562848b8a385e4cU);
  EXPECT_EQ(fingerprint<Ack>(), 0x8e40b25f0cb11049U);
  EXPECT_EQ(fingerprint<CmdMode>(), 0x1d06fec683b92e45U);
  EXPECT_EQ(fingerprint<CmdPosition>(), 0xeb2e3942cbf7b819U);
  EXPECT_EQ(fingerprint<CmdVelocity>(), 0xe914935f104f8214U);
  EXPECT_EQ(fingerprint<CmdPanTilt>(), 0x459d5ec80c55142dU);
  EXPECT_EQ(fingerprint<CmdScanner>(), 0x7fdcb6f49522b835U);
  EXPECT_EQ(fingerprint<CmdRab>(), 0x45c4aa329f54ecfdU);
}

// --- bytes that were written by hand ---

TEST(EyebotCodec, WritesAVelocity) {
  CmdVelocity m{};
  m.hdr = kHeader;
  m.frame = CmdVelocity::FRAME_BODY;
  m.vel[0] = 0.5;
  m.vel[2] = -0.25;
  m.yaw_rate = 0.1;
  m.timeout_ms = 500;
  EXPECT_EQ(encoded(m), hex("E9 14 93 5F 10 4F 82 14" + kHead +
                            "01 3F E0 00 00 00 00 00 00 00 00 00 00 00 00 00 00 BF D0 00 00 00 00 00 00"
                            "3F B9 99 99 99 99 99 9A 00 00 01 F4"));
}

TEST(EyebotCodec, WritesAMode) {
  CmdMode m{};
  m.hdr = kHeader;
  m.action = CmdMode::ACT_TAKEOFF;
  m.param = 0.5F;
  EXPECT_EQ(encoded(m), hex("1D 06 FE C6 83 B9 2E 45" + kHead + "03 3F 00 00 00"));
}

TEST(EyebotCodec, ReadsAnAltitude) {
  const auto m = decoded<Altitude>(hex("7E 25 F7 5E CB F0 25 0B" + kHead + "3F C0 00 00 BF 80 00 00"));
  EXPECT_EQ(m.hdr.utime, 1700000000000000);
  EXPECT_EQ(m.hdr.seq, 7);
  EXPECT_EQ(m.hdr.session, 0x1234);
  EXPECT_EQ(m.ground, 1.5F);
  EXPECT_EQ(m.ceiling, -1.0F);
}

TEST(EyebotCodec, ReadsABattery) {
  const auto m =
      decoded<Battery>(hex("CF 66 38 32 97 4E B4 B4" + kHead + "41 31 99 9A BF 80 00 00 BF 80 00 00 BF 80 00 00 00"));
  EXPECT_EQ(m.voltage, 11.1F);
  EXPECT_EQ(m.charge, -1.0F);
  EXPECT_FALSE(m.low);
}

const std::string kHeartbeat =
    "7D 37 0A 60 5B EB 9B CC" + kHead + "00 00 00 04 65 62 30 00 01 01 00 00 00 00 C8 00 00 00 00 00 00 30 39";

TEST(EyebotCodec, ReadsAndWritesAHeartbeat) {
  const auto m = decoded<Heartbeat>(hex(kHeartbeat));
  EXPECT_EQ(m.name, "eb0");
  EXPECT_EQ(m.role, Heartbeat::ROLE_ROBOT);
  EXPECT_EQ(m.proto_major, 1);
  EXPECT_EQ(m.period_ms, 200);
  EXPECT_EQ(m.uptime_ms, 12345);
  EXPECT_EQ(encoded(m), hex(kHeartbeat));
}

const std::string kScan = "F8 11 13 97 00 A5 83 52" + kHead +
                          "41 F0 00 00 00 00 00 00 00 00 00 02 00 02 FF FF F0 60 00 00 00 00"
                          "00 00 00 00 40 46 66 66 3E 80 00 00 C0 00 00 00";

TEST(EyebotCodec, ReadsAScan) {
  const auto m = decoded<Scan>(hex(kScan));
  EXPECT_EQ(m.rpm, 30.0F);
  ASSERT_EQ(m.n, 2);
  EXPECT_EQ(m.sensor[1], 2);
  EXPECT_EQ(m.dt_us[0], -4000);
  EXPECT_EQ(m.angle[1], 3.1F);
  EXPECT_EQ(m.range[0], 0.25F);
  EXPECT_EQ(m.range[1], -2.0F);
}

const std::string kAck = "8E 40 B2 5F 0C B1 10 49" + kHead +
                         "00 00 00 14 65 79 65 62 6F 74 2F 65 62 30 2F 63 6D 64 2F 6D 6F 64 65 00"
                         "00 00 12 34 00 00 00 07 00 00 00 00 01 00";

TEST(EyebotCodec, ReadsAnAck) {
  const auto m = decoded<Ack>(hex(kAck));
  EXPECT_EQ(m.channel, "eyebot/eb0/cmd/mode");
  EXPECT_EQ(m.cmd_session, 0x1234);
  EXPECT_EQ(m.cmd_seq, 7);
  EXPECT_EQ(m.result, Ack::OK);
  EXPECT_EQ(m.text, "");
}

TEST(EyebotCodec, SizesAreThoseThatRobotsSend) {
  EXPECT_EQ(encoded(State{}).size(), 135U);
  EXPECT_EQ(encoded(Prox{}).size(), 120U);
  EXPECT_EQ(encoded(Light{}).size(), 120U);
  EXPECT_EQ(encoded(PanTilt{}).size(), 33U);
  EXPECT_EQ(encoded(Leds{}).size(), 124U);
  EXPECT_EQ(encoded(CmdPosition{}).size(), 66U);
  EXPECT_EQ(encoded(CmdPanTilt{}).size(), 33U);
  EXPECT_EQ(encoded(CmdScanner{}).size(), 34U);
  Rab rab{};
  rab.n = 20;
  rab.pkt.resize(20);
  for (RabPacket& p : rab.pkt) {
    p.len = 10;
    p.data.resize(10);
  }
  EXPECT_EQ(encoded(rab).size(), 728U);
}

TEST(EyebotCodec, WritesNothingThatDoesNotFit) {
  std::array<std::byte, 28> small{};
  EXPECT_TRUE(encode(CmdMode{}, small).empty());
  Rab rab{};
  rab.n = 1;  // of none
  std::array<std::byte, 100> room{};
  EXPECT_TRUE(encode(rab, room).empty());
  Scan scan{};
  scan.n = -1;
  EXPECT_TRUE(encode(scan, room).empty());
}

// --- bytes of somebody who means harm, or of a broken line ---

template <class Message>
Flaw flaw_of(const Bytes& bytes) {
  Message message{};
  return decode<Message>(bytes, message);
}

TEST(HostileMessages, OfAnotherTypeAreRefused) {
  Bytes bytes = hex(kScan);
  EXPECT_EQ(flaw_of<Heartbeat>(bytes), Flaw::WrongType);
  bytes[7] ^= std::byte{1};
  EXPECT_EQ(flaw_of<Scan>(bytes), Flaw::WrongType);
  EXPECT_EQ(flaw_of<Scan>({}), Flaw::WrongType);
}

TEST(HostileMessages, CutShortAnywhereAreRefused) {
  const auto each_cut = [](auto message, const std::string& text) {
    const Bytes whole = hex(text);
    for (std::size_t n = 0; n < whole.size(); ++n) {
      EXPECT_NE(flaw_of<decltype(message)>({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(n)}), Flaw::None)
          << n;
    }
  };
  each_cut(Scan{}, kScan);
  each_cut(Heartbeat{}, kHeartbeat);
  each_cut(Ack{}, kAck);
}

TEST(HostileMessages, WithBytesBehindTheirEndAreRefused) {
  EXPECT_EQ(flaw_of<Scan>(hex(kScan + "00")), Flaw::WrongSize);
  EXPECT_EQ(flaw_of<Heartbeat>(hex(kHeartbeat + "00")), Flaw::WrongSize);
  EXPECT_EQ(flaw_of<Ack>(hex(kAck + "00")), Flaw::WrongSize);
}

TEST(HostileMessages, WithLengthsThatAreNoneAreRefused) {
  const auto with = [](const std::string& text, std::size_t at, std::int32_t n) {
    Bytes bytes = hex(text);
    for (std::size_t i = 0; i < 4; ++i)
      bytes[at + i] = static_cast<std::byte>(static_cast<std::uint32_t>(n) >> (24 - 8 * i));
    return bytes;
  };
  for (const std::int32_t n :
       {-1, std::numeric_limits<std::int32_t>::min(), std::numeric_limits<std::int32_t>::max(), 4097}) {
    EXPECT_EQ(flaw_of<Scan>(with(kScan, 32, n)), Flaw::BadCount) << n;
    EXPECT_EQ(flaw_of<Heartbeat>(with(kHeartbeat, 24, n)), Flaw::BadText) << n;
    EXPECT_EQ(flaw_of<Ack>(with(kAck, 24, n)), Flaw::BadText) << n;
  }
  EXPECT_EQ(flaw_of<Scan>(with(kScan, 32, 3)), Flaw::WrongSize);
  EXPECT_EQ(flaw_of<Scan>(with(kScan, 32, 1)), Flaw::WrongSize);
  EXPECT_EQ(flaw_of<Heartbeat>(with(kHeartbeat, 24, 0)), Flaw::BadText);
  EXPECT_EQ(flaw_of<Heartbeat>(with(kHeartbeat, 24, 3)), Flaw::BadText);  // its end is no zero
}

TEST(HostileMessages, WithTextThatEndsTwiceAreRefused) {
  Bytes bytes = hex(kHeartbeat);
  ASSERT_EQ(flaw_of<Heartbeat>(bytes), Flaw::None);
  bytes[28] = std::byte{0};  // the first letter of its name
  EXPECT_EQ(flaw_of<Heartbeat>(bytes), Flaw::BadText);
}

TEST(HostileMessages, WithPacketsOfNegativeLengthAreRefused) {
  Rab rab{};
  rab.n = 1;
  rab.pkt.resize(1);
  Bytes bytes = encoded(rab);
  ASSERT_EQ(bytes.size(), 28U + 25U);
  bytes.back() = std::byte{0xFF};
  EXPECT_EQ(flaw_of<Rab>(bytes), Flaw::BadCount);
  bytes.back() = std::byte{1};
  EXPECT_EQ(flaw_of<Rab>(bytes), Flaw::WrongSize);
}

TEST(HostileMessages, TooLargeForAnyUseAreRefused) {
  Bytes bytes = hex(kScan);
  bytes.resize(kMostBytes + 1);
  EXPECT_EQ(flaw_of<Scan>(bytes), Flaw::WrongSize);
}

TEST(HostileMessages, WithNumbersThatAreNoneAreRefused) {
  CmdVelocity velocity{};
  velocity.vel[1] = kNan;
  EXPECT_EQ(flaw_of<CmdVelocity>(encoded(velocity)), Flaw::NotFinite);
  CmdPosition position{};
  position.yaw = std::numeric_limits<double>::infinity();
  EXPECT_EQ(flaw_of<CmdPosition>(encoded(position)), Flaw::NotFinite);
  Prox prox{};
  prox.proximity[23] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(flaw_of<Prox>(encoded(prox)), Flaw::NotFinite);
}

TEST(EyebotState, CountsOnlyWhereTheRobotSaysThatItIsValid) {
  State m{};
  EXPECT_EQ(flaw_of<State>(encoded(m)), Flaw::NotFinite);  // no orientation
  m.quat[0] = 1.0;
  m.pos[0] = kNan;
  EXPECT_EQ(flaw_of<State>(encoded(m)), Flaw::None);
  m.pos_valid = 1;
  EXPECT_EQ(flaw_of<State>(encoded(m)), Flaw::NotFinite);
  m.pos[0] = 0.0;
  EXPECT_EQ(flaw_of<State>(encoded(m)), Flaw::None);
  m.omega[2] = kNan;
  EXPECT_EQ(flaw_of<State>(encoded(m)), Flaw::NotFinite);
}

TEST(EyebotHeader, IsSeenWithoutTheRest) {
  EXPECT_FALSE(peek_header(hex("7E 25 F7 5E CB F0 25 0B 00 06 0A 24 18 1E 40 00 00 00 00 07 00 00 12")));
  const auto h = peek_header(hex("7E 25 F7 5E CB F0 25 0B" + kHead));
  ASSERT_TRUE(h);
  EXPECT_EQ(h->utime, 1700000000000000);
  EXPECT_EQ(h->seq, 7);
  EXPECT_EQ(h->session, 0x1234);
  EXPECT_EQ(peek_header(hex("00 00 00 00 00 00 00 00 FF FF FF FF FF FF FF FF FF FF FF FE 80 00 00 00"))->seq, -2);
}

}  // namespace
}  // namespace tandem::bridges::eyebot_messages
