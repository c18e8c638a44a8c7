#include "bridges/peer/controller_copy.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bridges/peer/messages.hpp"

namespace tandem::bridges::peer {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

ControllerCopy a_copy() {
  ControllerCopy copy;
  copy.label = "walk";
  copy.library = {"libwalk.so", std::string(64, 'a')};
  copy.processor = "x86-64 with 64 bits";
  copy.release = "0.1.0";
  copy.commit = std::string(40, '1');
  copy.scripts = {{"lua/walk.lua", std::string(64, 'b')}};
  copy.surfaces = {{"controller", 3}, {"plugin", 1}};
  return copy;
}

ControllerCopy for_a_board() {
  ControllerCopy copy = a_copy();
  copy.library.sha256 = std::string(64, 'c');
  copy.processor = "ARM with 32 bits";
  return copy;
}

TEST(ControllerCopy, IsTheSameWhereEveryFileIs) {
  const CopyComparison compared = compare(a_copy(), a_copy());
  EXPECT_THAT(compared.differs, IsEmpty());
  EXPECT_THAT(compared.not_compared, IsEmpty());
  EXPECT_EQ(compared.same, "lua/walk.lua with sha256 bbbbbbbbbbbb…; libwalk.so with sha256 aaaaaaaaaaaa…");
}

TEST(ControllerCopy, DiffersByNameWhereAFileDoes) {
  ControllerCopy other = a_copy();
  other.library.sha256 = std::string(64, 'd');
  EXPECT_EQ(compare(a_copy(), other).differs,
            "the peer runs libwalk.so with sha256 dddddddddddd…, the hub has libwalk.so with sha256 aaaaaaaaaaaa…");
  other = a_copy();
  other.scripts[0].sha256 = std::string(64, 'e');
  EXPECT_THAT(compare(a_copy(), other).differs, HasSubstr("lua/walk.lua with sha256 eeeeeeeeeeee…, the hub bbbb"));
  other.scripts = {{"lua/turn.lua", std::string(64, 'b')}};
  EXPECT_THAT(compare(a_copy(), other).differs, HasSubstr("does not run the script lua/walk.lua"));
  EXPECT_THAT(compare(a_copy(), other).differs, HasSubstr("the script lua/turn.lua, which the hub does not"));
  other = a_copy();
  other.label = "hop";
  EXPECT_THAT(compare(a_copy(), other).differs, HasSubstr("the peer runs the controller 'hop', the hub has 'walk'"));
}

TEST(ControllerCopy, OfAnotherProcessorIsComparedByWhatItWasBuiltWith) {
  const CopyComparison compared = compare(a_copy(), for_a_board());
  EXPECT_THAT(compared.differs, IsEmpty());
  EXPECT_THAT(compared.same, HasSubstr("lua/walk.lua"));
  EXPECT_THAT(compared.same, HasSubstr("built with Tandem 0.1.0; both programs of commit 111111111111…"));
  EXPECT_EQ(compared.not_compared,
            "the libraries, for the peer's is for ARM with 32 bits, the hub's for x86-64 with 64 bits");
  ControllerCopy board = for_a_board();
  board.release = "0.0.9";
  board.surfaces = {{"controller", 2}, {"port", 1}};
  const std::string differs = compare(a_copy(), board).differs;
  EXPECT_THAT(differs, HasSubstr("was built with Tandem 0.0.9, the hub's with Tandem 0.1.0"));
  EXPECT_THAT(differs, HasSubstr("uses the surface controller 2, the hub's 3"));
  EXPECT_THAT(differs, HasSubstr("does not use the surface plugin"));
  EXPECT_THAT(differs, HasSubstr("uses the surface port, the hub's does not"));
  board = for_a_board();
  board.commit = std::string(40, '2');
  EXPECT_THAT(compare(a_copy(), board).not_compared, HasSubstr("commits 222222222222… (peer) and 111111111111… (hub)"));
  board.commit.clear();
  EXPECT_THAT(compare(a_copy(), board).not_compared, HasSubstr("do not tell one clean commit"));
}

TEST(ControllerCopy, IsNotComparedWithWhatIsNotTold) {
  EXPECT_THAT(compare(a_copy(), std::nullopt).not_compared, HasSubstr("does not tell which controller"));
  const CopyComparison nameless = compare(a_copy(), controller_copy_from(hal::Json::object()));
  EXPECT_THAT(nameless.not_compared, HasSubstr("the peer tells none"));
  EXPECT_THAT(nameless.not_compared, HasSubstr("that of the peer has no digest"));
}

TEST(ControllerCopy, GoesWithReadyWhichMayLeaveItOut) {
  Ready ready{"s", {}, {}, a_copy()};
  const auto bytes = bytes_of(ready);
  const auto read = read_ready(bytes);
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read.value().controller, a_copy());
  ready.controller.reset();
  const auto without = bytes_of(ready);
  EXPECT_EQ(read_ready(without).value().controller, std::nullopt);
  EXPECT_EQ(std::string(without.begin(), without.end()).find("controller"), std::string::npos);
  const std::string odd = R"({"session":"s","takes":[],"controller":{"surfaces":7}})";
  EXPECT_FALSE(read_ready({reinterpret_cast<const std::uint8_t*>(odd.data()), odd.size()}).ok());
}

}  // namespace
}  // namespace tandem::bridges::peer
