#include "bridges/can/can_link_opener.hpp"

#include <cerrno>
#include <gmock/gmock.h>
#include <sys/socket.h>
#include <unistd.h>

namespace tandem::bridges {
namespace {

using testing::AnyOf;
using testing::HasSubstr;

TEST(CanLinkOpener, TakesOnlyLinksThatCarryFrames) {
  EXPECT_TRUE(can_link_opener(parse_link("can:can0").value()).ok());
  EXPECT_TRUE(can_link_opener(parse_link("slcan:/dev/ttyACM0").value()).ok());
  const auto serial = can_link_opener(parse_link("serial:/dev/ttyUSB0").value());
  ASSERT_FALSE(serial.ok());
  EXPECT_THAT(serial.error().message, HasSubstr("can:INTERFACE or slcan:DEVICE@BITRATE"));
}

TEST(CanLinkOpener, SaysWhatToDoWhereThereIsNoSuchInterface) {
  const auto link = can_link_opener(parse_link("can:nosuchcan0").value()).value()();
  ASSERT_FALSE(link.ok());
  const int probe = ::socket(AF_CAN, SOCK_RAW, 1);
  const bool kernel_has_can = probe >= 0;
  if (probe >= 0) ::close(probe);
  EXPECT_THAT(link.error().message, HasSubstr("can:nosuchcan0"));
  EXPECT_THAT(link.error().message, HasSubstr(kernel_has_can ? "no such interface" : "this kernel has no CAN"));
}

TEST(CanLinkOpener, SaysWhatToDoWhereThereIsNoSuchAdapter) {
  const auto link = can_link_opener(parse_link("slcan:/dev/ttyNoSuchAdapter").value()).value()();
  ASSERT_FALSE(link.ok());
  EXPECT_THAT(link.error().message, HasSubstr("no such device"));
}

}  // namespace
}  // namespace tandem::bridges
