#include "bridges/can/slcan_text.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <vector>

#include "tests/bridges/can/frames.hpp"

namespace tandem::bridges {
namespace {

using What = SlcanSaying::What;

TEST(SlcanText, WritesFramesAsTheAdaptersWantThem) {
  EXPECT_EQ(slcan_line(make_frame(0x300, std::array<std::uint8_t, 4>{0x11, 0xA0, 5, 0})).view(), "t300411A00500\r");
  EXPECT_EQ(slcan_line(make_frame(0x123, {})).view(), "t1230\r");
  CanFrame extended = make_frame(0x12ABCDEF, std::array<std::uint8_t, 2>{0xAA, 0x55});
  extended.extended = true;
  EXPECT_EQ(slcan_line(extended).view(), "T12ABCDEF2AA55\r");
  CanFrame remote = make_frame(0x123, {});
  remote.remote = true;
  EXPECT_EQ(slcan_line(remote).view(), "r1230\r");
}

TEST(SlcanText, ReadsFramesWithAndWithoutTimeStamp) {
  const SlcanSaying plain = parse_slcan_line("t4563112233");
  ASSERT_EQ(plain.what, What::Frame);
  EXPECT_TRUE(same_on_wire(plain.frame, make_frame(0x456, std::array<std::uint8_t, 3>{0x11, 0x22, 0x33})));
  const SlcanSaying stamped = parse_slcan_line("t30140c900500EA5F");
  ASSERT_EQ(stamped.what, What::Frame);
  EXPECT_TRUE(same_on_wire(stamped.frame, make_frame(0x301, std::array<std::uint8_t, 4>{0x0C, 0x90, 5, 0})));
}

TEST(SlcanText, RefusesWhatIsNoFrame) {
  for (const char* line : {"t", "t30", "t300", "t3009", "t30041122", "t300411223344556", "t3004112233445566778",
                           "t30041122zz44", "t8000", "T800000000", "T2000000001", "t300411A005001", "x", "r30", "zz"}) {
    EXPECT_EQ(parse_slcan_line(line).what, What::Malformed) << line;
  }
}

TEST(SlcanText, UnderstandsWhatElseAdaptersSay) {
  EXPECT_EQ(parse_slcan_line("").what, What::Yes);
  EXPECT_EQ(parse_slcan_line("z").what, What::Confirmed);
  EXPECT_EQ(parse_slcan_line("Z").what, What::Confirmed);
  EXPECT_EQ(parse_slcan_line("V1013").what, What::Version);
  EXPECT_EQ(parse_slcan_line("NA123").what, What::Version);
  EXPECT_EQ(parse_slcan_line("sa057033").state, BusState::Active);
  EXPECT_EQ(parse_slcan_line("sp130002").state, BusState::Passive);
  EXPECT_EQ(parse_slcan_line("sb256256").state, BusState::BusOff);
  EXPECT_EQ(parse_slcan_line("sb256256").what, What::State);
  EXPECT_EQ(parse_slcan_line("sx256256").what, What::Malformed);
  EXPECT_TRUE(parse_slcan_line("e1a").no_acknowledge);
  EXPECT_FALSE(parse_slcan_line("e3bcO").overrun);
  EXPECT_TRUE(parse_slcan_line("e2oa").overrun);
  EXPECT_EQ(parse_slcan_line("e2a").what, What::Malformed);
  EXPECT_EQ(parse_slcan_line("F24").flags, kSlcanPassive | kSlcanWarning);
}

TEST(SlcanText, HasTheNineBitRates) {
  EXPECT_EQ(slcan_rate_digit(1'000'000), '8');
  EXPECT_EQ(slcan_rate_digit(10'000), '0');
  EXPECT_EQ(slcan_rate_digit(800'000), '7');
  EXPECT_FALSE(slcan_rate_digit(115'200));
}

TEST(SlcanReader, FindsTheNextLineAfterOneThatIsTooLong) {
  SlcanReader reader;
  std::vector<What> said;
  const std::string text = std::string(500, '1') + "\r\a" + "t1230\r\nz\r" + "t30\a";
  for (const char c : text) {
    if (reader.push(static_cast<std::uint8_t>(c))) said.push_back(reader.saying().what);
  }
  EXPECT_EQ(said, (std::vector<What>{What::Malformed, What::No, What::Frame, What::Confirmed, What::Malformed}));
}

TEST(SlcanText, ReadsBackEveryFrame) {
  EXPECT_TRUE(rc::check([](bool extended, bool remote, std::uint32_t id, std::uint8_t size, std::uint64_t data) {
    CanFrame frame;
    frame.extended = extended;
    frame.remote = remote;
    frame.id = id & (extended ? kLargestExtendedId : kLargestStandardId);
    frame.size = size % 9;
    if (!remote) {
      for (unsigned i = 0; i < frame.size; ++i) frame.data[i] = static_cast<std::uint8_t>(data >> (8 * i));
    }
    SlcanReader reader;
    const SlcanLine line = slcan_line(frame);
    for (std::size_t i = 0; i < line.size; ++i) {
      RC_ASSERT(reader.push(static_cast<std::uint8_t>(line.text[i])) == (i + 1 == line.size));
    }
    RC_ASSERT(reader.saying().what == What::Frame);
    RC_ASSERT(same_on_wire(reader.saying().frame, frame));
  }));
}

}  // namespace
}  // namespace tandem::bridges
