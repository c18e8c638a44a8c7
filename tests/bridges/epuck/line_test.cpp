#include "bridges/epuck/line.hpp"

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>
#include <string>
#include <vector>

namespace tandem::bridges::epuck {
namespace {

std::string text_of(const Packet& packet) {
  return {packet.bytes().begin(), packet.bytes().end()};
}

std::vector<std::string> lines_of(std::string_view bytes) {
  LineReader reader;
  std::vector<std::string> lines;
  for (const char c : bytes) {
    if (reader.push(static_cast<std::uint8_t>(c))) lines.emplace_back(reader.line());
  }
  return lines;
}

constexpr std::string_view kGreetingText =
    "\x0C\x07WELCOME to the SerCom protocol on e-Puck\r\nthe EPFL education robot type \"H\" for help\r\n";

TEST(EpuckLine, EndsARequestWithOneCarriageReturn) {
  Packet packet;
  append_line(packet, 'D', {500, -500});
  EXPECT_EQ(text_of(packet), "D,500,-500\r");
  append_line(packet, 'N');
  EXPECT_EQ(text_of(packet), "D,500,-500\rN\r");
}

TEST(EpuckLine, NeverSendsTheLetterThatPlaysASound) {
  Packet packet;
  EXPECT_FALSE(append_line(packet, 't'));
  EXPECT_TRUE(packet.empty());
}

TEST(EpuckLine, RefusesARequestThatDoesNotFit) {
  Packet packet;
  for (int i = 0; i < 60; ++i) packet.append({0});
  EXPECT_FALSE(append_line(packet, 'D', {1000, 1000}));
  EXPECT_EQ(packet.size(), 60U);
  EXPECT_FALSE(
      append_line(packet, 'J', {-2147483647, -2147483647, -2147483647, -2147483647, -2147483647, -2147483647}));
}

TEST(EpuckLine, CutsAStreamIntoLines) {
  EXPECT_THAT(lines_of("d\r\nn,0,12\r\n\r\ns\r\n"), testing::ElementsAre("d", "n,0,12", "s"));
  EXPECT_THAT(lines_of("unfinished"), testing::IsEmpty());
}

TEST(EpuckLine, KeepsTheEndOfALineThatIsTooLong) {
  const std::string line = std::string(5000, 'x') + "v,Version 2.0.0 January 2008";
  LineReader reader;
  for (const char c : line) EXPECT_FALSE(reader.push(static_cast<std::uint8_t>(c)));
  EXPECT_TRUE(reader.push('\n'));
  Identity identity;
  EXPECT_TRUE(parse_version(reader.line(), identity));
  EXPECT_EQ(reader.cut_lines(), 1U);
}

TEST(EpuckLine, ReadsAnAnswersNumbers) {
  LineAnswer answer;
  ASSERT_TRUE(parse_answer("n,0,12,3,0,0,2,15,81", answer));
  EXPECT_EQ(answer.letter, 'n');
  EXPECT_EQ(answer.count, 8U);
  EXPECT_EQ(answer.values[7], 81);
  ASSERT_TRUE(parse_answer("q,-32768,32767", answer));
  EXPECT_EQ(answer.values[0], -32768);
  ASSERT_TRUE(parse_answer("d", answer));
  EXPECT_EQ(answer.count, 0U);
}

TEST(EpuckLine, RefusesWhatIsNoAnswer) {
  LineAnswer answer;
  for (const char* line : {"", "N,1", "the EPFL education robot", "n;1", "n,", "n,1,", "n,1x", "n,99999999999",
                           "z,Command not found", "n,1,2,3,4,5,6,7,8,9,10,11"}) {
    EXPECT_FALSE(parse_answer(line, answer)) << line;
  }
}

TEST(EpuckLine, TellsTheFirmwaresApart) {
  const std::pair<const char*, Firmware> known[] = {
      {"v,Version 2.0.0 January 2008", Firmware::BTcom},
      {"v,Version 1.2.2 August 2008 GCtronic", Firmware::GCtronic},
      {"v,Version 1.5.3 November 2016 (Webots)", Firmware::Webots},
      {"v,Version 2.0 January 2018 GCtronic", Firmware::Epuck2},
      {"v,Version 7", Firmware::Unknown},
  };
  for (const auto& [line, firmware] : known) {
    Identity identity;
    ASSERT_TRUE(parse_version(line, identity)) << line;
    EXPECT_EQ(identity.firmware, firmware) << line;
    EXPECT_EQ("v," + std::string(identity.version_text()), line);
  }
}

TEST(EpuckLine, FindsTheVersionBehindTheRestOfAnotherAnswer) {
  Identity identity;
  EXPECT_TRUE(parse_version("\x01\xFFgarbage v,Versiov,Version 2.0.0 January 2008", identity));
  EXPECT_EQ(identity.firmware, Firmware::BTcom);
  EXPECT_FALSE(parse_version("v,Versio", identity));
  EXPECT_FALSE(parse_version("the EPFL education robot type \"H\" for help", identity));
}

TEST(EpuckLine, CutsAVersionThatIsTooLongAndHidesControlBytes) {
  Identity identity;
  ASSERT_TRUE(parse_version("v,Version \x07" + std::string(300, 'y'), identity));
  EXPECT_EQ(identity.version_text().size(), identity.version.size() - 1);
  EXPECT_EQ(identity.version_text().substr(0, 10), "Version ?y");
}

TEST(EpuckLine, ReadsTheHardwareVersionInHexadecimal) {
  std::uint32_t hardware = 0;
  EXPECT_TRUE(parse_hardware("HW version: 1A", hardware));
  EXPECT_EQ(hardware, 0x1AU);
  EXPECT_FALSE(parse_hardware("HW version: ", hardware));
  EXPECT_FALSE(parse_hardware("HW version: 1G", hardware));
}

TEST(EpuckGreeting, IsSpottedOnceWhereverItStands) {
  GreetingSpotter spotter;
  int seen = 0;
  for (const char c : "\x0C\x0C\x07WELC" + std::string(kGreetingText) + "n,1\r\n" + std::string(kGreetingText)) {
    if (spotter.push(static_cast<std::uint8_t>(c))) ++seen;
  }
  EXPECT_EQ(kGreetingText.size(), 88U);
  EXPECT_EQ(seen, 2);
}

RC_GTEST_PROP(EpuckLineProperty, ReadsBackTheNumbersThatItWrites, (std::int16_t a, std::int32_t b)) {
  Packet packet;
  RC_ASSERT(append_line(packet, 'q', {a, b}));
  std::string line = text_of(packet);
  line.pop_back();
  LineAnswer answer;
  RC_ASSERT(parse_answer(line, answer));
  RC_ASSERT(answer.count == 2U);
  RC_ASSERT(answer.values[0] == a);
  RC_ASSERT(answer.values[1] == b);
}

}  // namespace
}  // namespace tandem::bridges::epuck
