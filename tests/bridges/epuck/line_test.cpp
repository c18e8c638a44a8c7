#include "bridges/epuck/line.hpp"

#include <gmock/gmock.h>
#include <string>
#include <vector>

namespace tandem::bridges::epuck {
namespace {

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

}  // namespace
}  // namespace tandem::bridges::epuck
