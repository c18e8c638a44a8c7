#include "tests/bridges/epuck_emulator/bench.hpp"

namespace tandem::bridges::epuck_emulator {
namespace {

TEST(FirmwareAscii, GreetsOnceWhenSwitchedOn) {
  Bench robot;
  EXPECT_EQ(robot.greeting, kGreeting);
  EXPECT_EQ(robot.greeting.size(), 88U);
  EXPECT_EQ(robot.listen(), "");
}

TEST(FirmwareAscii, SetsSpeedsAndAcknowledges) {
  Bench robot;
  robot.say("D,0,0\r");
  EXPECT_FALSE(robot.firmware.first_driven_at());
  EXPECT_EQ(robot.say(bytes("44 2C 35 30 30 2C 2D 35 30 30 0D")), bytes("64 0D 0A"));
  const auto driven_at = robot.firmware.first_driven_at();
  ASSERT_TRUE(driven_at);
  EXPECT_NEAR(robot.body.command().left_m_s, 500 * kStep_m, 1e-9);
  EXPECT_NEAR(robot.body.command().right_m_s, -500 * kStep_m, 1e-9);
  EXPECT_EQ(robot.say("E\r"), "e,500,-500\r\n");
  robot.say("D,100,100\r");
  EXPECT_EQ(robot.firmware.first_driven_at(), driven_at);
  EXPECT_EQ(robot.count("\"event\":\"wheels\",\"left\":500,\"right\":-500"), 1);
}

TEST(FirmwareAscii, TakesSmallLettersAndLineFeeds) {
  Bench robot;
  EXPECT_EQ(robot.say("d,100,200\n"), "d\r\n");
  EXPECT_EQ(robot.say("e\n"), "e,100,200\r\n");
}

struct VersionCase {
  Variant variant;
  std::string_view answer;
};
class FirmwareVersions : public ::testing::TestWithParam<VersionCase> {};

TEST_P(FirmwareVersions, SayWhoTheyAreInOneLineOrTwo) {
  Bench robot(GetParam().variant);
  EXPECT_EQ(robot.say("V\r"), GetParam().answer);
  EXPECT_EQ(robot.say("V\r"), GetParam().answer);
}

INSTANTIATE_TEST_SUITE_P(
    All, FirmwareVersions,
    ::testing::Values(VersionCase{Variant::Btcom, "v,Version 2.0.0 January 2008\r\n"},
                      VersionCase{Variant::Gctronic, "v,Version 1.2.2 August 2008 GCtronic\r\nHW version: 1\r\n"},
                      VersionCase{Variant::Webots, "v,Version 1.5.3 November 2016 (Webots)\r\nHW version: 1\r\n"},
                      VersionCase{Variant::Epuck2, "v,Version 2.0 January 2018 GCtronic\r\nHW version: 2\r\n"}));

TEST(FirmwareAscii, AnswersUnknownLetters) {
  Bench robot;
  EXPECT_EQ(robot.say("!\r"), "z,Command not found\r\n");
  EXPECT_EQ(robot.count("\"event\":\"unknown\""), 1);
}

TEST(FirmwareAscii, IgnoresZerosWhileIdleOnly) {
  Bench robot;
  EXPECT_EQ(robot.say(std::string(40, '\0')), "");
  EXPECT_EQ(robot.say("C\r"), "c,3\r\n");
  // After CR LF the robot waits for a line: a zero is then its first character.
  EXPECT_EQ(robot.say(std::string("C\r\n\0C\r", 6)), "c,3\r\nz,Command not found\r\n");
}

TEST(FirmwareAscii, SkipsTheSecondHalfOfCrLfBeforeTheNextLine) {
  Bench robot;
  EXPECT_EQ(robot.say("C\r\n"), "c,3\r\n");
  EXPECT_EQ(robot.say("E\r\n"), "e,0,0\r\n");
}

TEST(FirmwareAscii, SwallowsABinaryPacketAfterCrLf) {
  Bench robot;
  EXPECT_EQ(robot.say("C\r\n"), "c,3\r\n");
  EXPECT_EQ(robot.say(bytes("AF 00")), "") << "now the head of a line";
  EXPECT_EQ(robot.say("\r"), "z,Command not found\r\n");
  EXPECT_EQ(robot.say(bytes("AF 00")), bytes("00 00 00 00"));
}

TEST(FirmwareAscii, KeepsOldArgumentsWhereNewOnesAreMissing) {
  Bench robot;
  robot.say("D,100,200\r");
  EXPECT_EQ(robot.say("D,abc\r"), "d\r\n");
  EXPECT_EQ(robot.say("E\r"), "e,100,200\r\n");
  EXPECT_EQ(robot.say("D,50\r"), "d\r\n");
  EXPECT_EQ(robot.say("E\r"), "e,50,200\r\n");
  EXPECT_EQ(robot.say("D, 7,x\r"), "d\r\n");
  EXPECT_EQ(robot.say("E\r"), "e,7,200\r\n");
  EXPECT_EQ(robot.count("\"event\":\"wheels\""), 4);
}

TEST(FirmwareAscii, WrapsArgumentsAtSixteenBitsOnVersionOne) {
  Bench robot;
  robot.say("D,40000,-32769\r");
  EXPECT_EQ(robot.say("E\r"), "e,-25536,32767\r\n");
  Bench two(Variant::Epuck2);
  two.say("D,40000,-32769\r");
  EXPECT_EQ(two.say("E\r"), "e,40000,-32769\r\n");
  EXPECT_LT(two.body.command().left_m_s, 0.0) << "the motors take 16 bits";
}

TEST(FirmwareAscii, TakesATypedTAsTheSound) {
  Bench robot;
  EXPECT_EQ(robot.say("T,3\r"), "t\r\n");
  EXPECT_EQ(robot.say("t\r"), "t\r\n");
  EXPECT_EQ(robot.count("\"event\":\"sound\",\"number\":3"), 2);
}

TEST(FirmwareAscii, TellsBatteryFromBodyLightByCaseWhereItCan) {
  Bench robot;
  HeldBody& body = robot.body;
  BodySenses senses;
  senses.battery_V = 4.2;
  body.set_senses(senses);
  EXPECT_EQ(robot.say("b\r"), "b,2560 (100%)\r\n");
  senses.battery_V = 3.4;
  body.set_senses(senses);
  EXPECT_EQ(robot.say("b\r"), "b,2070 (0%)\r\n");
  EXPECT_FALSE(body.command().body_led);
  EXPECT_EQ(robot.say("B,1\r"), "b\r\n");
  EXPECT_TRUE(body.command().body_led);

  Bench old(Variant::Btcom);
  EXPECT_EQ(old.say("b,1\r"), "b\r\n");
  EXPECT_TRUE(old.body.command().body_led);

  Bench unmeasured(Firmware::Options{.hardware_1_3 = false});
  EXPECT_EQ(unmeasured.say("b\r"), "b,1\r\n");
  senses.battery_V = 3.3;
  unmeasured.body.set_senses(senses);
  EXPECT_EQ(unmeasured.say("b\r"), "b,0\r\n");
}

TEST(FirmwareAscii, MeasuresTheBatteryOfVersionTwoBehindItsDivider) {
  Bench robot(Variant::Epuck2);
  BodySenses senses;
  senses.battery_V = 4.2;
  robot.body.set_senses(senses);
  EXPECT_EQ(robot.say("b\r"), "b,3441 (100%)\r\n");  // 4.2 V * 0.6 / 3.0 V * 4096 = 3440.6
}

TEST(FirmwareAscii, SwitchesLights) {
  Bench robot;
  EXPECT_EQ(robot.say("L,3,1\r"), "l\r\n");
  EXPECT_EQ(robot.body.command().ring, 0x08);
  EXPECT_EQ(robot.say("L,3,2\r"), "l\r\n");
  EXPECT_EQ(robot.body.command().ring, 0x00);
  EXPECT_EQ(robot.say("L,9,1\r"), "l\r\n");
  EXPECT_EQ(robot.body.command().ring, 0xFF) << "any other index is the whole ring";
  EXPECT_FALSE(robot.body.command().front_led);
  EXPECT_EQ(robot.say("F,1\r"), "f\r\n");
  EXPECT_TRUE(robot.body.command().front_led);
  EXPECT_EQ(robot.count("\"event\":\"leds\",\"ring\":255,\"body\":false,\"front\":true"), 1);
}

TEST(FirmwareAscii, StopsWheelsAndRingButNotTheOtherLights) {
  Bench robot;
  robot.say("D,300,300\r");
  robot.say("L,0,1\r");
  robot.say("F,1\r");
  EXPECT_EQ(robot.say("S\r"), "s\r\n");
  EXPECT_EQ(robot.body.command().left_m_s, 0.0);
  EXPECT_EQ(robot.body.command().ring, 0);
  EXPECT_TRUE(robot.body.command().front_led);
  EXPECT_EQ(robot.count("\"event\":\"stop\""), 1);
  EXPECT_EQ(robot.count("\"event\":\"wheels\",\"left\":0,\"right\":0,\"by\":\"S\""), 1);
  EXPECT_EQ(robot.say("E\r"), "e,300,300\r\n") << "the command is remembered";
  Bench webots(Variant::Webots);
  webots.say("D,300,300\r");
  webots.say("S\r");
  EXPECT_EQ(webots.say("E\r"), "e,0,0\r\n");
  webots.say("F,1\r");
  webots.say("S\r");
  EXPECT_FALSE(webots.body.command().front_led);
}

TEST(FirmwareAscii, ReportsWhatItSenses) {
  Bench robot;
  BodySenses senses;
  senses.distance_m = {0.1, 0.05, 0.02, 0.0, 0.5, 0.0075, 0.1, 0.1};
  senses.light = {0.0, 1.0, 0.5, 0, 0, 0, 0, 0};
  senses.ground = {1.0, 0.5, 0.0};
  senses.force_m_s2 = {0.0, -9.81, 0.5 * 9.81};
  senses.sound = {0.0, 0.5, 1.0, 0.25};
  robot.body.set_senses(senses);
  EXPECT_EQ(robot.say("N\r"), "n,0,120,384,4095,0,1800,0,0\r\n");
  EXPECT_EQ(robot.say("O\r"), "o,4095,0,2048,4095,4095,4095,4095,4095\r\n");
  EXPECT_EQ(robot.say("M\r"), "m,0,512,1023\r\n") << "the board counts from the left";
  EXPECT_EQ(robot.say("A\r"), "a,1248,2048,2448\r\n") << "left, ahead, up";
  EXPECT_EQ(robot.say("U\r"), "u,0,2048,4095\r\n");
  EXPECT_EQ(robot.say("g\r"), "g,0,0,0\r\n");
  EXPECT_EQ(robot.say("G\r"), "g IR check : 0x0, address : 0x0, data : 0x0\r\n");
}

TEST(FirmwareAscii, ReportsGroundAndCliffAsFarAsTheyAreThere) {
  EXPECT_EQ(Bench(Firmware::Options{.cliff_sensors = true}).say("M\r"), "m,1023,1023,1023,1023,1023\r\n");
  EXPECT_EQ(Bench(Firmware::Options{.variant = Variant::Btcom, .ground_board = false}).say("M\r"), "m,0,0,0\r\n");
}

TEST(FirmwareAscii, CalibratesAwayWhatIsNearInTwoLines) {
  Bench robot;
  BodySenses senses;
  senses.distance_m.fill(0.03);
  robot.body.set_senses(senses);
  EXPECT_EQ(robot.say("N\r"), "n,235,235,235,235,235,235,235,235\r\n");
  const TimeNs asked = robot.now;
  EXPECT_EQ(robot.say("K\r"),
            "k, Starting calibration - Remove any object in sensors range\r\nk, Calibration finished\r\n");
  EXPECT_GE(robot.now - asked, kSecond);
  EXPECT_EQ(robot.say("N\r"), "n,0,0,0,0,0,0,0,0\r\n");
}

TEST(FirmwareAscii, SetsTheCameraOrFallsBackSilently) {
  Bench robot;
  EXPECT_EQ(robot.say("I\r"), "i,1,40,40,8,3200\r\n");
  EXPECT_EQ(robot.say("J,0,60,60,4\r"), "j\r\n");
  EXPECT_EQ(robot.say("I\r"), "i,0,60,60,4,3600\r\n");
  EXPECT_EQ(robot.say("J,1,60,60,4\r"), "j\r\n") << "7200 bytes do not fit";
  EXPECT_EQ(robot.say("I\r"), "i,1,40,40,4,3200\r\n");
}

TEST(FirmwareAscii, TalksToItsBusWhereItHasTheCommands) {
  Bench robot;
  EXPECT_EQ(robot.say("W,192,3,17\r"), "w\r\n");
  EXPECT_EQ(robot.say("Y,192,3\r"), "y,192,3\r\ny,17\r\n");
  EXPECT_EQ(robot.say("X,3\r"), "z,Command not found\r\n");
  Bench webots(Variant::Webots);
  EXPECT_EQ(webots.say("X,3\r"), "x,111\r\n");
  EXPECT_EQ(webots.say("X,-3\r"), "x,\r\n");
  Bench btcom(Variant::Btcom);
  EXPECT_EQ(btcom.say("Y,192,3\r"), "z,Command not found\r\n");
}

TEST(FirmwareAscii, HelpsWithALoneLineFeedFirst) {
  Bench robot;
  const std::string help = robot.say("H\r");
  EXPECT_EQ(help.front(), '\n');
  EXPECT_NE(help.find("\"D,#,#\""), std::string::npos);
}

TEST(FirmwareAscii, RestartsOnR) {
  Bench robot;
  robot.say("D,300,300\r");
  robot.say("J,0,60,60,4\r");
  robot.wait(kSecond);
  EXPECT_EQ(robot.say("R\r"), "r\r\n" + std::string(kGreeting));
  EXPECT_EQ(robot.body.command().left_m_s, 0.0);
  EXPECT_EQ(robot.say("E\r"), "e,0,0\r\n");
  EXPECT_EQ(robot.say("Q\r"), "q,0,0\r\n");
  EXPECT_EQ(robot.say("I\r"), "i,1,40,40,8,3200\r\n");
  EXPECT_EQ(robot.count("\"event\":\"reset\""), 1);
  EXPECT_EQ(robot.count("\"event\":\"greeting\""), 1);
}

TEST(FirmwareAscii, VersionTwoIgnoresR) {
  Bench robot(Variant::Epuck2);
  robot.say("D,300,300\r");
  EXPECT_EQ(robot.say("R\r"), "");
  EXPECT_EQ(robot.say("E\r"), "e,300,300\r\n");
}

TEST(FirmwareAscii, IsBroughtBackInStepByZerosAndOneCarriageReturn) {
  Bench robot;
  robot.say(bytes("BC F4"));  // half a binary packet, then silence
  const std::string answer = robot.say(std::string(40, '\0') + "\r" + "V\r");
  EXPECT_NE(answer.find("v,Version"), std::string::npos);
  EXPECT_EQ(robot.say(bytes("AF 00")).size(), 4U);
  EXPECT_EQ(robot.count("\"left\":244,\"right\":0"), 1) << "the zeros complete the half command, and it is obeyed";
}

}  // namespace
}  // namespace tandem::bridges::epuck_emulator
