#include <bit>

#include "tests/bridges/epuck_emulator/bench.hpp"

namespace tandem::bridges::epuck_emulator {
namespace {

float float_at(std::string_view data, std::size_t at) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < 4; ++i)
    bits |= static_cast<std::uint32_t>(static_cast<unsigned char>(data[at + i])) << (8 * i);
  return std::bit_cast<float>(bits);
}

TEST(FirmwareBinary, DoesOneControlCycle) {
  Bench robot;
  BodySenses senses;
  senses.distance_m.fill(0.05);
  robot.body.set_senses(senses);
  const std::string answer = robot.say(bytes("BC F4 01 0C FE AF B2 9F 00"));
  ASSERT_EQ(answer.size(), 26U);
  EXPECT_EQ(answer.substr(0, 4), bytes("00 00 00 00"));
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(int16_at(answer, 4 + 2 * i), 120);
  EXPECT_EQ(answer.substr(20), bytes("00 08 00 08 20 0B"));
  EXPECT_EQ(robot.count("\"event\":\"wheels\",\"left\":500,\"right\":-500"), 1);
  robot.wait(kSecond);
  const std::string counts = robot.say(bytes("AF 00"));
  EXPECT_NEAR(int16_at(counts, 0), 500, 3);
  EXPECT_EQ(int16_at(counts, 0), -int16_at(counts, 2));
}

TEST(FirmwareBinary, AnswersNothingBeforeTheFinalZero) {
  Bench robot;
  EXPECT_EQ(robot.say(bytes("AF BB")), "");
  EXPECT_EQ(robot.say(bytes("00")).size(), 8U);
}

TEST(FirmwareBinary, WaitsForTheZeroThatWasDroppedAndAnswersBothThen) {
  Bench robot;
  EXPECT_EQ(robot.say(bytes("AF")), "");
  EXPECT_EQ(robot.say(bytes("AF 00")).size(), 8U) << "two answers to what the host thinks is one question";
}

TEST(FirmwareBinary, ReadsZerosInPayloadsAsData) {
  Bench robot;
  EXPECT_EQ(robot.say(bytes("BC 00 00 00 00 AF 00")).size(), 4U);
  EXPECT_EQ(robot.say(bytes("B4 00 01 B4 08 01 B4 09 01 00")), "");
  EXPECT_EQ(robot.body.command().ring, 0x01);
  EXPECT_TRUE(robot.body.command().body_led);
  EXPECT_TRUE(robot.body.command().front_led);
  EXPECT_EQ(robot.say(bytes("B4 63 00 00")), "");
  EXPECT_EQ(robot.body.command().ring, 0x00);
}

TEST(FirmwareBinary, IgnoresUnknownCommands) {
  Bench robot;
  EXPECT_EQ(robot.say(bytes("80 AF 81 00")).size(), 4U);
  EXPECT_EQ(robot.count("\"event\":\"unknown\",\"mode\":\"binary\",\"byte\":128"), 1);
  Bench btcom(Variant::Btcom);
  EXPECT_EQ(btcom.say(bytes("9E 99 8C AF 00")).size(), 4U) << "no battery, gyro, temperature in BTcom";
}

TEST(FirmwareBinary, AnswersRightAfterTheGreeting) {
  HeldBody body;
  Firmware firmware({}, body, {});
  firmware.power_on(0);
  firmware.receive(0xAF, kByteNs);  // while the greeting leaves
  firmware.receive(0x00, 2 * kByteNs);
  std::vector<SentByte> out;
  firmware.run_until(kSecond);
  firmware.take_sent(kSecond, out);
  ASSERT_EQ(out.size(), kGreeting.size() + 4);
  EXPECT_EQ(out.back().at, static_cast<TimeNs>(kGreeting.size() + 4) * kByteNs);
}

TEST(FirmwareBinary, ChangesBetweenModesPacketByPacket) {
  Bench robot;
  EXPECT_EQ(robot.say("C\r" + bytes("AF 00") + "C\r"), "c,3\r\n" + bytes("00 00 00 00") + "c,3\r\n");
}

struct SizeCase {
  Variant variant;
  std::string_view packet;
  std::size_t answer;
};
class FirmwareAnswerSizes : public ::testing::TestWithParam<SizeCase> {};

TEST_P(FirmwareAnswerSizes, AreThoseOfTheTable) {
  Bench robot(GetParam().variant);
  EXPECT_EQ(robot.say(bytes(GetParam().packet)).size(), GetParam().answer);
  EXPECT_EQ(robot.say("C\r"), "c,3\r\n") << "in step afterwards";
}

constexpr Variant kOne = Variant::Gctronic, kTwo = Variant::Epuck2, kOld = Variant::Btcom, kWeb = Variant::Webots;
INSTANTIATE_TEST_SUITE_P(
    All, FirmwareAnswerSizes,
    ::testing::Values(
        SizeCase{kOne, "9F00", 6}, SizeCase{kOne, "BF00", 12}, SizeCase{kOne, "9E00", 2}, SizeCase{kOld, "9E00", 0},
        SizeCase{kOne, "BB00", 4}, SizeCase{kOne, "9900", 6}, SizeCase{kOne, "B700", 3203}, SizeCase{kOne, "B300", 6},
        SizeCase{kWeb, "B300", 6}, SizeCase{kTwo, "B300", 8}, SizeCase{kOne, "B200", 16}, SizeCase{kOne, "B100", 16},
        SizeCase{kOne, "AF00", 4}, SizeCase{kOne, "8C00", 1}, SizeCase{kOne, "8B00", 6}, SizeCase{kOne, "AB00", 601},
        SizeCase{kTwo, "AB00", 0}, SizeCase{kOne, "A9C0031100", 0}, SizeCase{kTwo, "A7C00300", 1},
        SizeCase{kTwo, "F800", 103}, SizeCase{kTwo, "F500", 1}, SizeCase{kTwo, "F400", 8}, SizeCase{kTwo, "F300", 2},
        SizeCase{kTwo, "F200", 1}, SizeCase{kTwo, "F10100", 1}, SizeCase{kTwo, "F00100", 1},
        SizeCase{kTwo, "EF0100", 1}, SizeCase{kOne, "F800", 0}, SizeCase{kTwo, "F6010203040506070809101112 00", 0},
        SizeCase{kOne, "89 0102030405060708091011121314151617181920 212223242526272829303132333435 00", 0}));

TEST(FirmwareBinary, AnswersGroundOfTenBytesWithCliffSensors) {
  EXPECT_EQ(Bench(Firmware::Options{.cliff_sensors = true}).say(bytes("B3 00")).size(), 10U);
}

TEST(FirmwareBinary, WrapsItsStepCounterAtSixteenBits) {
  Bench robot;
  EXPECT_EQ(robot.say("P,32767,-32768\r"), "p\r\n");
  robot.say("D,1000,-1000\r");
  const TimeNs started = robot.now;
  robot.wait(3 * hal::kNsPerMs - (robot.now - started));
  const std::string counts = robot.say(bytes("AF 00"));
  EXPECT_LT(int16_at(counts, 0), -32700) << "32767, then -32768";
  EXPECT_GT(int16_at(counts, 2), 32700);
  EXPECT_EQ(robot.say("Q\r").substr(0, 4), "q,-3");
}

TEST(FirmwareBinary, CountsOnInThirtyTwoBitsOnVersionTwo) {
  Bench robot(Variant::Epuck2);
  robot.say("P,32767,32767\r");
  robot.say("D,1000,0\r");
  robot.wait(kSecond / 2);
  robot.say("D,0,0\r");
  const std::string text = robot.say("Q\r");
  EXPECT_GT(std::stoi(text.substr(2)), 33000);
  EXPECT_EQ(int16_at(robot.say(bytes("AF 00")), 0), std::stoi(text.substr(2)) - 65536);
}

TEST(FirmwareBinary, HasTheSignQuirkOfVersionTwo) {
  Bench robot(Variant::Epuck2);
  robot.say(bytes("BC 0C FE F4 01 00"));
  EXPECT_EQ(robot.say("E\r"), "e,65036,500\r\n");
  EXPECT_NEAR(robot.body.command().left_m_s, -500 * kStep_m, 1e-6) << "but it drives right";
  EXPECT_EQ(robot.count("\"left\":-500,\"right\":500"), 1);
  EXPECT_EQ(robot.say(bytes("BB 00")), bytes("0C FE F4 01"));
  robot.say(bytes("BC 00 00 00 00 B0 F0 FF 10 00 00"));
  EXPECT_EQ(robot.say("Q\r"), "q,65520,16\r\n");
  EXPECT_EQ(robot.say(bytes("AF 00")), bytes("F0 FF 10 00"));
}

TEST(FirmwareBinary, ClampsSpeeds) {
  Bench one;
  one.say(bytes("BC DC 05 24 FA 00"));  // 1500, -1500
  EXPECT_NEAR(one.body.command().left_m_s, 1000 * kStep_m, 1e-9);
  EXPECT_NEAR(one.body.command().right_m_s, -1000 * kStep_m, 1e-9);
  EXPECT_EQ(one.count("\"left\":1500,\"right\":-1500"), 1) << "the log has them as received";
  Bench two(Variant::Epuck2);
  two.say(bytes("BC DC 05 24 FA 00"));
  EXPECT_NEAR(two.body.command().left_m_s, 1100 * kStep_m, 1e-6);
}

TEST(FirmwareBinary, KeepsItsLastSpeedForEver) {
  Bench robot;
  robot.say(bytes("BC 64 00 64 00 00"));
  robot.wait(3600 * kSecond);
  EXPECT_GT(robot.body.command().left_m_s, 0.0);
}

TEST(FirmwareBinary, SendsImagesWithTheHighByteFirst) {
  Bench robot;
  const std::string image = robot.say(bytes("B7 00"));
  EXPECT_EQ(image.substr(0, 3), bytes("01 28 28"));
  // Brighter to the right in the first row: red is in the top bits of the first byte.
  EXPECT_LT(static_cast<unsigned char>(image[3]) >> 3U, static_cast<unsigned char>(image[3 + 2 * 39]) >> 3U);
  EXPECT_NE(robot.say(bytes("B7 00")), image) << "frames change";
  EXPECT_EQ(robot.say(bytes("AF B7 00")).size(), 4U + 3203U);
}

TEST(FirmwareBinary, SendsSoundSamplesBeforeTheOtherAnswers) {
  Bench robot;
  robot.say("P,258,772\r");
  robot.send(bytes("AF AB"));
  robot.wait(kSecond);
  robot.firmware.take_sent(robot.now, robot.heard);
  EXPECT_EQ(robot.heard.size(), 600U) << "at once";
  robot.heard.clear();
  EXPECT_EQ(robot.say(bytes("00")), bytes("02 01 04 03 63"));
}

TEST(FirmwareBinary, WebotsFirmwareSendsRawProximity) {
  Bench robot(Variant::Webots);
  EXPECT_EQ(int16_at(robot.say(bytes("B2 00")), 0), 40);
  EXPECT_EQ(robot.say("N\r"), "n,0,0,0,0,0,0,0,0\r\n");
}

// A level robot, and one that stands on a slope of 30 degrees with its front lower: ahead -4.9, left 0, up 8.5 m/s².
TEST(FirmwareBinary, SendsTheAccelerometerWithTheZeroOfEachFirmwareAndItsAxesLeftAheadUp) {
  struct Case {
    Variant variant;
    const char* level;
    const char* slope;
    const char* level_line;
  };
  for (const Case& c : {Case{Variant::Btcom, "00 00 00 00 20 03", "00 00 70 FE B5 02", "a,0,0,800\r\n"},
                        Case{Variant::Gctronic, "00 08 00 08 20 0B", "00 08 70 06 B5 0A", "a,2048,2048,2848\r\n"},
                        Case{Variant::Webots, "00 08 00 08 20 0B", "00 08 70 06 B5 0A", "a,0,0,800\r\n"},
                        Case{Variant::Epuck2, "00 08 00 08 20 0B", "00 08 70 06 B5 0A", "a,2048,2048,2848\r\n"}}) {
    Bench robot(c.variant);
    EXPECT_EQ(robot.say(bytes("9F 00")), bytes(c.level));
    EXPECT_EQ(robot.say("A\r"), c.level_line);
    BodySenses senses;
    senses.force_m_s2 = {-0.5 * 9.81, 0.0, 0.8660254 * 9.81};
    robot.body.set_senses(senses);
    EXPECT_EQ(robot.say(bytes("9F 00")), bytes(c.slope));
  }
}

TEST(FirmwareBinary, SendsTheGroundSensorsFromLeftToRight) {
  for (const auto& [variant, answer] :
       {std::pair(Variant::Gctronic, "00 00 00 02 FF 03"), std::pair(Variant::Epuck2, "00 00 00 02 FF 03 00 00")}) {
    Bench robot(variant);
    BodySenses senses;
    senses.ground = {1.0, 0.5, 0.0};  // as the kind: right, middle, left
    robot.body.set_senses(senses);
    EXPECT_EQ(robot.say(bytes("B3 00")), bytes(answer));
  }
}

TEST(FirmwareBinary, DerivesTiltFromTheAccelerometer) {
  Bench robot;
  BodySenses senses;
  senses.force_m_s2 = {0.0, -9.81, 0.0};  // to the right
  robot.body.set_senses(senses);
  const std::string tilt = robot.say(bytes("BF 00"));
  EXPECT_FLOAT_EQ(float_at(tilt, 0), 800.0F);
  EXPECT_FLOAT_EQ(float_at(tilt, 4), 270.0F);
  EXPECT_FLOAT_EQ(float_at(tilt, 8), 90.0F);
}

TEST(FirmwareBinary, SaysTheTemperatureOnVersionOneOnly) {
  EXPECT_EQ(Bench(Variant::Gctronic).say(bytes("8C 00")), bytes("19"));
  EXPECT_EQ(Bench(Variant::Epuck2).say(bytes("8C 00")), bytes("00")) << "an inverted test there";
}

TEST(FirmwareEpuck2, DoesACycleOfTheRemoteLibrary) {
  Bench robot(Variant::Epuck2);
  BodySenses senses;
  senses.distance_m.fill(0.03);
  senses.turn_rad_s = {0.0, 0.0, -1.0};
  senses.ahead_m = 0.321;
  senses.battery_V = 4.0;
  senses.temperature_C = -5.0;
  senses.sound = {0.0, 0.0, 0.0, 1.0};
  senses.light.fill(1.0);
  senses.ground = {1.0, 0.5, 0.0};  // right, middle, left
  robot.body.set_senses(senses);
  robot.say("P,1,-2\r");
  const std::string all = robot.say(bytes("F7 00 F4 01 0C FE 01 00 00 00 00 00 00 00 00 00 00 00 00 00 F8 00"));
  ASSERT_EQ(all.size(), 103U);
  EXPECT_EQ(robot.count("\"event\":\"wheels\",\"left\":500,\"right\":-500,\"by\":\"F7\""), 1);
  EXPECT_EQ(robot.body.command().ring, 0x01);
  EXPECT_EQ(int16_at(all, 4), 800);
  EXPECT_FLOAT_EQ(float_at(all, 6), 800.0F);
  EXPECT_FLOAT_EQ(float_at(all, 14), 0.0F);
  EXPECT_EQ(int16_at(all, 22), -7510);  // 57.296 degrees a second of 250
  EXPECT_FLOAT_EQ(float_at(all, 24), 20.0F);
  EXPECT_EQ(static_cast<signed char>(all[36]), -5);
  EXPECT_EQ(int16_at(all, 37), 235);
  EXPECT_EQ(int16_at(all, 51), 235);
  EXPECT_EQ(int16_at(all, 53), 0);
  EXPECT_EQ(int16_at(all, 69), 321);
  EXPECT_EQ(int16_at(all, 77), 4095);
  EXPECT_EQ(int16_at(all, 79), 1);
  EXPECT_EQ(int16_at(all, 81), -2);
  EXPECT_EQ(int16_at(all, 83), 3277);
  EXPECT_EQ(all[89], 3);
  EXPECT_EQ(int16_at(all, 90), 0);
  EXPECT_EQ(int16_at(all, 94), 1023);
  EXPECT_EQ(all[102], 0);
}

TEST(FirmwareEpuck2, SetsLightsAndCountersWithAllActuators) {
  Bench robot(Variant::Epuck2);
  robot.say(bytes("F7 04 0A 00 F6 FF 3F 01 02 03 04 05 06 07 08 09 0A 0B 0C 20 00"));
  EXPECT_EQ(robot.say("Q\r"), "q,10,-10\r\n");
  EXPECT_EQ(robot.body.command().left_m_s, 0.0);
  EXPECT_EQ(robot.body.command().ring, 0b0101'0101);
  EXPECT_TRUE(robot.body.command().body_led && robot.body.command().front_led);
  EXPECT_EQ(robot.body.command().rgb[11], 12);
  EXPECT_EQ(robot.count("\"rgb\":\"1,2,3,4,5,6,7,8,9,10,11,12\""), 1);
  robot.say(bytes("F7 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00"));
  EXPECT_EQ(robot.body.command().ring, 0) << "all six are set each time";
  EXPECT_FALSE(robot.body.command().body_led);
}

TEST(FirmwareEpuck2, SkipsAllActuatorsOnceAfterAnOverflow) {
  Bench robot(Variant::Epuck2);
  robot.send("K\r");
  robot.send(std::string(100, '\0'));  // nobody reads them while it calibrates
  robot.listen();
  const std::string go = bytes("F7 00 64 00 64 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00");
  robot.say(go);
  EXPECT_EQ(robot.body.command().left_m_s, 0.0);
  EXPECT_EQ(robot.count("\"event\":\"ignored\""), 1);
  robot.say(go);
  EXPECT_GT(robot.body.command().left_m_s, 0.0);
}

}  // namespace
}  // namespace tandem::bridges::epuck_emulator
