#include "tests/bridges/epuck_emulator/bench.hpp"

namespace tandem::bridges::epuck_emulator {
namespace {

TEST(FirmwareTiming, AnswersAtLineSpeed) {
  Bench robot;
  robot.send("C\r");
  const TimeNs asked = robot.now;
  robot.wait(kSecond);
  robot.firmware.take_sent(robot.now, robot.heard);
  ASSERT_EQ(robot.heard.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(robot.heard[i].at, asked + static_cast<TimeNs>(i + 1) * kByteNs);
}

TEST(FirmwareTiming, GivesNoByteBeforeItHasLeft) {
  Bench robot;
  robot.send("C\r");
  robot.firmware.take_sent(robot.now + 2 * kByteNs, robot.heard);
  EXPECT_EQ(robot.heard.size(), 2U);
}

TEST(FirmwareTiming, QueuesWhatArrivesWhileItAnswers) {
  Bench robot;
  EXPECT_EQ(robot.say("V\rC\rE\r"), "v,Version 1.2.2 August 2008 GCtronic\r\nHW version: 1\r\nc,3\r\ne,0,0\r\n");
}

TEST(FirmwareTiming, KeepsTheLast64BytesThatArriveMeanwhile) {
  Bench robot;
  robot.send("K\r");
  robot.send(std::string(10, '\r') + "E\r" + std::string(62, '\0') + "C\r");
  // 76 bytes: the first 12 are overwritten, E with them.
  const std::string answer = robot.listen();
  EXPECT_EQ(answer.find("e,0,0"), std::string::npos);
  EXPECT_EQ(answer.substr(answer.find("finished\r\n") + 10), "c,3\r\n");
  EXPECT_EQ(robot.count("\"event\":\"overflow\",\"buffer\":\"receive\""), 1);
}

TEST(FirmwareTiming, HoldsExactly64Bytes) {
  Bench robot;
  robot.send("K\r");
  robot.send("E\r" + std::string(60, '\0') + "C\r");
  const std::string answer = robot.listen();
  EXPECT_EQ(answer.substr(answer.find("finished\r\n") + 10), "e,0,0\r\nc,3\r\n");
  EXPECT_EQ(robot.count("overflow"), 0);
}

TEST(FirmwareTiming, LosesTheRestOfAnAnswerWhenResetInTheMiddle) {
  Bench robot;
  robot.send("V\r");
  robot.wait(10 * kByteNs);
  robot.firmware.take_sent(robot.now, robot.heard);
  robot.firmware.reset(robot.now, "fault");
  EXPECT_EQ(robot.listen(), "v,Version " + std::string(kGreeting));
  EXPECT_EQ(robot.count("\"event\":\"reset\",\"why\":\"fault\""), 1);
}

TEST(FirmwareTiming, HearsNothingWhileItBoots) {
  Bench robot;
  robot.firmware.reset(robot.now, "fault");
  robot.send("D,500,500\r");
  EXPECT_EQ(robot.listen(), kGreeting);
  EXPECT_EQ(robot.body.command().left_m_s, 0.0);
  EXPECT_EQ(robot.say("C\r"), "c,3\r\n");
}

TEST(FirmwareTiming, ForgetsAHalfReceivedPacketWhenReset) {
  Bench robot;
  robot.send(bytes("BC F4"));
  robot.firmware.reset(robot.now, "fault");
  robot.listen();
  EXPECT_EQ(robot.say("C\r"), "c,3\r\n");
}

TEST(FirmwareTiming, CutsOneAnswerOnDemand) {
  Bench robot;
  robot.firmware.cut_next_answer();
  EXPECT_EQ(robot.say(bytes("AF B2 00")).size(), 10U);
  EXPECT_EQ(robot.say(bytes("AF B2 00")).size(), 20U);
}

TEST(FirmwareTiming, NeedsNothingWhileIdle) {
  Bench robot;
  EXPECT_EQ(robot.firmware.next_event(), std::nullopt);
  robot.send("C\r");
  EXPECT_EQ(robot.firmware.next_event(), robot.now + kByteNs);
  EXPECT_EQ(robot.firmware.next_event(kSecond), robot.now + 5 * kByteNs) << "all five bytes at once";
}

TEST(FirmwareTiming, SurvivesAnEndlessLineAndAnEndlessPacket) {
  Bench robot;
  for (int i = 0; i < 200; ++i) robot.say(std::string(60, 'x'));
  EXPECT_EQ(robot.say("\r"), "z,Command not found\r\n");
  EXPECT_GT(robot.count("\"buffer\":\"line\""), 0);
  for (int i = 0; i < 200; ++i) robot.say(std::string(60, '\xB2'));
  EXPECT_EQ(robot.say(std::string(1, '\0')).size(), 4139U);
  EXPECT_EQ(robot.say("C\r"), "c,3\r\n");
}

}  // namespace
}  // namespace tandem::bridges::epuck_emulator
