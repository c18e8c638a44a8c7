// What two identities have in common, and what of them travels in lock files and packets.
#include "bridges/robot_identity.hpp"

#include <gtest/gtest.h>

namespace tandem::bridges {
namespace {

RobotIdentity epuck() {
  return {.link = "serial:/dev/rfcomm0@115200",
          .device = "/dev/rfcomm0 216:0",
          .firmware = "e-puck 1.3",
          .hardware = "1A",
          .address = "Bluetooth 08:00:17:2C:E0:88",
          .session = 1};
}

TEST(RobotIdentity, NamesTheFirstWordThatDiffers) {
  RobotIdentity other = epuck();
  other.firmware = "asercom 2.0";
  EXPECT_EQ(difference(epuck(), other), "firmware: 'e-puck 1.3' was armed, 'asercom 2.0' answers");
  other.device = "/dev/rfcomm1 216:1";
  EXPECT_EQ(difference(epuck(), other), "device: '/dev/rfcomm0 216:0' was armed, '/dev/rfcomm1 216:1' answers");
  EXPECT_EQ(difference(epuck(), epuck()), "");
}

TEST(RobotIdentity, IsTheSameUnderAnotherNameOfTheDeviceAndInAnotherSession) {
  RobotIdentity again = epuck();
  again.link = "serial:/dev/puck@115200";
  again.session = 7;
  EXPECT_EQ(difference(epuck(), again), "");
}

TEST(RobotIdentity, AWordThatOneDoesNotTellDiffersButContradictsNothing) {
  RobotIdentity silent = epuck();
  silent.hardware.reset();
  EXPECT_EQ(difference(epuck(), silent), "hardware: '1A' was armed, none answers");
  EXPECT_EQ(difference(silent, epuck()), "hardware: none was armed, '1A' answers");
  EXPECT_EQ(contradiction(epuck(), silent), "");
  silent.firmware = "asercom 2.0";
  EXPECT_EQ(contradiction(epuck(), silent), "firmware: 'e-puck 1.3' was armed, 'asercom 2.0' answers");
}

TEST(RobotIdentity, AnEmptyWordIsNoAbsentOne) {
  RobotIdentity empty = epuck(), absent = epuck();
  empty.name = "";
  EXPECT_NE(difference(empty, absent), "");
}

TEST(RobotIdentity, TravelsAsOneLineOfPrintableText) {
  RobotIdentity all = epuck();
  all.name = std::string("näme\n;=%\0 x", 12);
  all.hardware = "";
  const std::string line = encode(all);
  for (const char c : line) EXPECT_TRUE(c > ' ' && c <= '~') << line;
  const auto back = decode_identity(line);
  ASSERT_TRUE(back);
  EXPECT_EQ(*back, all);
  EXPECT_EQ(decode_identity(encode({})), RobotIdentity{});
}

TEST(RobotIdentity, AnythingElseIsNoIdentity) {
  const std::string line = encode(epuck());
  for (std::size_t n = 0; n < line.size(); ++n) EXPECT_FALSE(decode_identity(line.substr(0, n))) << n;
  for (const std::string_view text : {"", "1;0;;;;;;;", "2;x;;;;;;;", "2;0;;a;;;;;", "2;0;%g0;;;;;;", "2;0;;;;;;;;"})
    EXPECT_FALSE(decode_identity(text)) << text;
}

TEST(RobotIdentity, TellsPeopleTheWordsThatItHas) {
  EXPECT_EQ(to_text(epuck()), "e-puck 1.3, hardware 1A, Bluetooth 08:00:17:2C:E0:88");
  EXPECT_EQ(to_text({}), "");
}

}  // namespace
}  // namespace tandem::bridges
