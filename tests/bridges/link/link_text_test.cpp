#include "bridges/link/link_text.hpp"

#include <gmock/gmock.h>

namespace tandem::bridges {
namespace {

using testing::HasSubstr;

std::string error_of(std::string_view text) {
  const auto parsed = parse_link(text);
  return parsed.ok() ? "accepted" : parsed.error().message;
}

TEST(LinkText, ReadsASerialDeviceWithItsBaudRate) {
  const auto link = parse_link("serial:/dev/ttyUSB0@57600");
  ASSERT_TRUE(link.ok());
  EXPECT_EQ(link.value().scheme, LinkScheme::Serial);
  EXPECT_EQ(link.value().target, "/dev/ttyUSB0");
  EXPECT_EQ(link.value().rate, 57600U);
}

TEST(LinkText, TakesTheUsualRateWhereNoneIsWritten) {
  EXPECT_EQ(parse_link("serial:/dev/rfcomm0").value().rate, 115200U);
  EXPECT_EQ(parse_link("slcan:/dev/ttyACM0").value().rate, 1000000U);
}

TEST(LinkText, ReadsWhatItWrites) {
  for (const char* text : {"serial:/dev/ttyUSB0@115200", "slcan:/dev/ttyACM0@1000000", "can:can0",
                           "lcm:udpm://239.255.76.67:7667?ttl=0", "pty:ep0", "tcp:robot:3000"}) {
    const auto link = parse_link(text);
    ASSERT_TRUE(link.ok()) << text;
    EXPECT_EQ(to_text(link.value()), text);
  }
}

TEST(LinkText, SplitsTheRateOffAtTheLastAt) {
  EXPECT_EQ(parse_link("serial:/dev/a@b@9600").value().target, "/dev/a@b");
}

TEST(LinkText, SaysWhatIsWrong) {
  EXPECT_THAT(error_of("/dev/ttyUSB0"), HasSubstr("no scheme"));
  EXPECT_THAT(error_of("usb:/dev/ttyUSB0"), HasSubstr("unknown scheme 'usb'"));
  EXPECT_THAT(error_of("usb:x"), HasSubstr("serial:/dev/ttyUSB0@115200"));
  EXPECT_THAT(error_of("serial:"), HasSubstr("no device"));
  EXPECT_THAT(error_of("serial:@115200"), HasSubstr("no device"));
  EXPECT_THAT(error_of("can:"), HasSubstr("no CAN interface"));
  EXPECT_THAT(error_of("serial:/dev/ttyS0@fast"), HasSubstr("'fast' after the @ is not a rate"));
  EXPECT_THAT(error_of("serial:/dev/ttyS0@"), HasSubstr("is not a rate"));
  EXPECT_THAT(error_of("serial:/dev/ttyS0@-9600"), HasSubstr("is not a rate"));
  EXPECT_THAT(error_of("serial:/dev/ttyS0@0"), HasSubstr("is not a rate"));
  EXPECT_THAT(error_of("serial:/dev/ttyS0@99999999999"), HasSubstr("is not a rate"));
  EXPECT_THAT(error_of("serial:/dev/ttyS0@115000"), HasSubstr("nearest they have is 115200"));
}

TEST(LinkText, OpensSerialLinksAndTcpForBytes) {
  EXPECT_TRUE(byte_link_opener(parse_link("serial:/dev/ttyUSB0").value()).ok());
  EXPECT_TRUE(byte_link_opener(parse_link("tcp:robot:3000").value()).ok());
  const auto no_port = byte_link_opener(parse_link("tcp:robot").value());
  ASSERT_FALSE(no_port.ok());
  EXPECT_THAT(no_port.error().message, HasSubstr("no port; write for example tcp:robot:3000"));
  const auto can = byte_link_opener(parse_link("can:can0").value());
  ASSERT_FALSE(can.ok());
  EXPECT_THAT(can.error().message, HasSubstr("serial:DEVICE@BAUD"));
}

}  // namespace
}  // namespace tandem::bridges
