#include "bridges/guardian/packet.hpp"

#include <gtest/gtest.h>

namespace tandem::bridges::guardian {
namespace {

TEST(GuardianPacket, ComesBackAsItWas) {
  const Packet packet{Word::Watch, {"fb0", "foot-bot", "can:can0", std::string("a\0:\n9:", 6), 17, "name"}, "why: 3:x"};
  const auto back = decode(encode(packet));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->word, packet.word);
  EXPECT_EQ(back->robot, packet.robot);
  EXPECT_EQ(back->text, packet.text);
}

TEST(GuardianPacket, IsRefusedWhenAnyByteOfItIsMissing) {
  const std::string bytes = encode({Word::Claim, {"e", "e-puck", "serial:/dev/rfcomm0@115200", "", 1}, ""});
  for (std::size_t size = 0; size < bytes.size(); ++size) EXPECT_FALSE(decode(bytes.substr(0, size))) << size;
  EXPECT_FALSE(decode(bytes + "0:"));
  EXPECT_FALSE(decode("W99999999999999999999:"));
}

TEST(GuardianPacket, IsNotMadeWhenItWouldBeTooLong) {
  Packet packet;
  packet.robot.body.assign(kLongestPacket, 'x');
  EXPECT_EQ(encode(packet), "");
}

}  // namespace
}  // namespace tandem::bridges::guardian
