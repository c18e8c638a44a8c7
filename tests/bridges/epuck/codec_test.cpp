#include "bridges/epuck/codec.hpp"

#include <bit>
#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>
#include <vector>

namespace tandem::bridges::epuck {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes bytes_of(const Packet& packet) {
  return {packet.bytes().begin(), packet.bytes().end()};
}

void put16(Bytes& bytes, int value) {
  bytes.push_back(static_cast<std::uint8_t>(value & 0xFF));
  bytes.push_back(static_cast<std::uint8_t>((value >> 8) & 0xFF));
}

void put_float(Bytes& bytes, float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  put16(bytes, static_cast<int>(bits & 0xFFFF));
  put16(bytes, static_cast<int>(bits >> 16));
}

const AnswerLayout kLayout{};
const QuantitySet kCycle{Quantity::Encoders, Quantity::Proximity, Quantity::Acceleration};

TEST(EpuckCodec, EncodesOneControlCycle) {
  Packet packet;
  append_speeds(packet, {500}, {-500});
  append_queries(packet, kCycle, kLayout);
  append_end(packet);
  EXPECT_EQ(bytes_of(packet), (Bytes{0xBC, 0xF4, 0x01, 0x0C, 0xFE, 0xAF, 0xB2, 0x9F, 0x00}));
}

TEST(EpuckCodec, DecodesOneControlCycle) {
  const Bytes answer{0x10, 0x00, 0xF0, 0xFF, 0x00, 0x00, 0x0C, 0x00, 0x03, 0x00, 0x00, 0x00, 0x00,
                     0x00, 0x02, 0x00, 0x0F, 0x00, 0x51, 0x00, 0x12, 0x00, 0xFB, 0xFF, 0x20, 0x03};
  RawSensors s;
  ASSERT_EQ(answer_size(kCycle, kLayout), 26U);
  ASSERT_EQ(decode_answer(answer, kCycle, kLayout, s), Decoded::Ok);
  EXPECT_THAT(s.encoders, testing::ElementsAre(16, -16));
  EXPECT_THAT(s.proximity, testing::ElementsAre(0, 12, 3, 0, 0, 2, 15, 81));
  EXPECT_THAT(s.acceleration, testing::ElementsAre(18, -5, 800));
}

TEST(EpuckCodec, GivesEveryCommandItsByte) {
  const auto query = [](Quantity q) {
    Packet packet;
    append_query(packet, q);
    return packet.bytes()[0];
  };
  EXPECT_EQ(query(Quantity::Acceleration), 0x9F);
  EXPECT_EQ(query(Quantity::Battery), 0x9E);
  EXPECT_EQ(query(Quantity::CommandedSpeeds), 0xBB);
  EXPECT_EQ(query(Quantity::Gyro), 0x99);
  EXPECT_EQ(query(Quantity::Ground), 0xB3);
  EXPECT_EQ(query(Quantity::Proximity), 0xB2);
  EXPECT_EQ(query(Quantity::Ambient), 0xB1);
  EXPECT_EQ(query(Quantity::Encoders), 0xAF);
  EXPECT_EQ(query(Quantity::Microphones), 0x8B);
  Packet packet;
  append_led(packet, kBodyLedIndex, LedAction::On);
  append_led(packet, 3, LedAction::Toggle);
  EXPECT_EQ(bytes_of(packet), (Bytes{0xB4, 8, 1, 0xB4, 3, 2}));
}

TEST(EpuckCodec, CountsTheBytesThatEachFirmwareAnswers) {
  EXPECT_EQ(answer_size(Quantity::Ground, {.ground_bytes = 8}), 8U);
  EXPECT_EQ(answer_size(Quantity::Ground, {.ground_bytes = 10}), 10U);
  EXPECT_EQ(answer_size(Quantity::Battery, {.battery_bytes = 0}), 0U);
  EXPECT_EQ(
      answer_size({Quantity::Encoders, Quantity::Battery, Quantity::Ground}, {.ground_bytes = 10, .battery_bytes = 2}),
      16U);
}

TEST(EpuckCodec, DoesNotAskForWhatTheFirmwareDoesNotAnswer) {
  Packet packet;
  append_queries(packet, {Quantity::Encoders, Quantity::Battery}, {.battery_bytes = 0});
  EXPECT_EQ(bytes_of(packet), Bytes{0xAF});
}

TEST(EpuckCodec, ReadsGroundSensorsOfEveryLength) {
  const QuantitySet asked{Quantity::Ground};
  Bytes answer;
  for (const int v : {100, 200, 300, 400, 500}) put16(answer, v);
  RawSensors s;
  ASSERT_EQ(decode_answer(answer, asked, {.ground_bytes = 10}, s), Decoded::Ok);
  EXPECT_THAT(s.ground, testing::ElementsAre(100, 200, 300));
  EXPECT_THAT(s.cliff, testing::ElementsAre(400, 500)) << "right, left";
  EXPECT_EQ(s.cliffs, 2);
  answer.resize(8);
  s = {};
  ASSERT_EQ(decode_answer(answer, asked, {.ground_bytes = 8}, s), Decoded::Ok);
  EXPECT_THAT(s.ground, testing::ElementsAre(100, 200, 300));
  EXPECT_EQ(s.cliff[0], 400) << "the right one";
  EXPECT_EQ(s.cliffs, 1);
}

TEST(EpuckCodec, LeavesTheSensorsAloneWhenTheAnswerIsWrong) {
  RawSensors s;
  s.encoders = {7, 8};
  EXPECT_EQ(decode_answer(Bytes(25, 1), kCycle, kLayout, s), Decoded::WrongLength);
  EXPECT_EQ(decode_answer(Bytes(27, 1), kCycle, kLayout, s), Decoded::WrongLength);
  EXPECT_EQ(decode_answer(Bytes(26, 0x10), kCycle, kLayout, s), Decoded::Implausible);
  EXPECT_THAT(s.encoders, testing::ElementsAre(7, 8));
}

TEST(EpuckCodec, NeverFillsAPacketBeyondTheRobotsBuffer) {
  Packet packet;
  while (append_speeds(packet, {1}, {2})) {
  }
  EXPECT_EQ(packet.size(), 60U);
  EXPECT_FALSE(append_wifi_command(packet, {}));
  EXPECT_EQ(packet.size(), 60U);
}

TEST(EpuckCodec, EncodesTheEpuck2sColours) {
  Packet packet;
  append_rgb_leds(packet, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 100, 101});
  EXPECT_EQ(bytes_of(packet), (Bytes{0xF6, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 100, 100}));
}

TEST(EpuckCodec, DecodesAllSensorsOfTheEpuck2) {
  Bytes b;
  for (const int v : {1, -2, 800}) put16(b, v);
  for (const float v : {801.5F, 90.0F, 1.5F}) put_float(b, v);
  for (const int v : {10, -20, 30}) put16(b, v);
  for (const float v : {20.5F, -3.0F, 44.0F}) put_float(b, v);
  b.push_back(static_cast<std::uint8_t>(-5));
  for (int i = 0; i < 8; ++i) put16(b, 100 + i);
  for (int i = 0; i < 8; ++i) put16(b, 4000 + i);
  put16(b, 1234);
  for (const int v : {5, 6, 7, 8}) put16(b, v);
  put16(b, 32767);
  put16(b, -32768);
  put16(b, 2400);
  b.push_back(1);
  for (const int v : {1, 2, 3}) b.push_back(static_cast<std::uint8_t>(v));
  b.push_back(9);
  for (const int v : {900, 901, 902}) put16(b, v);
  for (const int v : {50, 51, 52}) put16(b, v);
  b.push_back(1);
  ASSERT_EQ(b.size(), kAllSensorsSize);

  AllSensors s;
  ASSERT_EQ(decode_all_sensors(b, s), Decoded::Ok);
  EXPECT_THAT(s.common.acceleration, testing::ElementsAre(1, -2, 800));
  EXPECT_FLOAT_EQ(s.acceleration_norm, 801.5F);
  EXPECT_FLOAT_EQ(s.orientation_deg, 90.0F);
  EXPECT_THAT(s.common.gyro, testing::ElementsAre(10, -20, 30));
  EXPECT_FLOAT_EQ(s.magnetic_field_uT[2], 44.0F);
  EXPECT_EQ(s.temperature_C, -5);
  EXPECT_EQ(s.common.proximity[7], 107);
  EXPECT_EQ(s.common.ambient[0], 4000);
  EXPECT_EQ(s.common.time_of_flight_mm, 1234);
  EXPECT_THAT(s.common.microphones, testing::ElementsAre(5, 6, 7, 8));
  EXPECT_THAT(s.common.encoders, testing::ElementsAre(32767, -32768));
  EXPECT_EQ(s.common.battery, 2400);
  EXPECT_THAT(s.remote_control, testing::ElementsAre(1, 2, 3));
  EXPECT_EQ(s.common.selector, 9);
  EXPECT_THAT(s.common.ground, testing::ElementsAre(900, 901, 902));
  EXPECT_THAT(s.ground_ambient, testing::ElementsAre(50, 51, 52));
  EXPECT_EQ(s.button, 1);
  b.pop_back();
  EXPECT_EQ(decode_all_sensors(b, s), Decoded::WrongLength);
}

RC_GTEST_PROP(EpuckCodecProperty, DecodesWhatARobotWouldEncode, (const std::vector<std::int16_t>& words)) {
  Bytes answer;
  QuantitySet asked{Quantity::Encoders, Quantity::Acceleration, Quantity::CommandedSpeeds};
  std::vector<std::int16_t> sent = words;
  sent.resize(7);
  for (const std::int16_t w : sent) put16(answer, w);
  RawSensors s;
  RC_ASSERT(decode_answer(answer, asked, kLayout, s) == Decoded::Ok);
  RC_ASSERT((std::vector<std::int16_t>{s.encoders[0], s.encoders[1], s.acceleration[0], s.acceleration[1],
                                       s.acceleration[2], s.commanded[0], s.commanded[1]}) == sent);
}

TEST(EpuckCodec, AsksAnEpuck2ForWhatItAloneTells) {
  const AnswerLayout epuck2{.ground_bytes = 8, .microphone_bytes = 8, .time_of_flight_bytes = 2, .selector_bytes = 103};
  const QuantitySet asked{Quantity::Microphones, Quantity::TimeOfFlight, Quantity::Selector};
  Packet packet;
  append_queries(packet, asked, epuck2);
  EXPECT_EQ(bytes_of(packet), (Bytes{0xF4, 0xF3, 0xF8}));
  Packet older;
  append_queries(older, asked, {});
  EXPECT_EQ(bytes_of(older), (Bytes{0x8B})) << "which an e-puck does not tell";
  Bytes answer;
  for (const int v : {10, 20, 30, 40, 1500}) put16(answer, v);
  answer.resize(answer.size() + 103);
  answer[10 + 89] = 12;
  RawSensors s;
  ASSERT_EQ(decode_answer(answer, asked, epuck2, s), Decoded::Ok);
  EXPECT_THAT(s.microphones, testing::ElementsAre(10, 20, 30, 40));
  EXPECT_EQ(s.time_of_flight_mm, 1500);
  EXPECT_EQ(s.selector, 12);
}

RC_GTEST_PROP(EpuckCodecProperty, FindsEveryPacketOfTheRadioHoweverManyStandBetween,
              (const std::vector<std::uint8_t>& kinds)) {
  WifiReader reader;
  std::size_t told = 0, wanted = 0;
  std::uint8_t number = 0;
  for (const std::uint8_t kind : kinds) {
    ++number;
    const bool sensors = kind % 2 == 0;
    Bytes packet(sensors ? 105 : 1, number);
    packet[0] = sensors ? 2 : 3;
    wanted += sensors ? 1 : 0;
    for (const std::uint8_t byte : packet) {
      const auto event = reader.push(byte);
      RC_ASSERT(event != WifiReader::Event::OutOfStep);
      if (event != WifiReader::Event::Sensors) continue;
      ++told;
      RC_ASSERT(reader.sensors().front() == number);
      RC_ASSERT(reader.sensors().back() == number);
    }
  }
  RC_ASSERT(told == wanted);
}

RC_GTEST_PROP(EpuckCodecProperty, TakesAnyBytesForAnyQuestion,
              (const Bytes& bytes, std::uint16_t bits, std::uint8_t ground)) {
  QuantitySet asked;
  for (unsigned i = 0; i < kQuantityCount; ++i) {
    if ((bits >> i & 1U) != 0) asked.add(static_cast<Quantity>(i));
  }
  const AnswerLayout layout{static_cast<std::uint8_t>(ground % 6 * 2), 2, 6};
  RawSensors s;
  const Decoded decoded = decode_answer(bytes, asked, layout, s);
  RC_ASSERT((decoded == Decoded::WrongLength) == (bytes.size() != answer_size(asked, layout)));
  if (decoded != Decoded::Ok) RC_ASSERT(s == RawSensors{});
}

}  // namespace
}  // namespace tandem::bridges::epuck
