#include "bridges/footbot_emulator/message.hpp"

#include "bridges/aseba_emulation/stream.hpp"
#include "bridges/footbot_emulator/assembler.hpp"
#include "tests/bridges/footbot_emulator/bench.hpp"

namespace tandem::bridges::footbot_emulator {
namespace {

using aseba_emulation::StreamReader;
using aseba_emulation::to_bytes;

using testing::ElementsAre;

Message message_of(std::size_t inner_bytes) {
  Message m{5, 0x1234, {}};
  for (std::size_t i = 2; i < inner_bytes; ++i) m.payload.push_back(static_cast<std::uint8_t>(i));
  return m;
}

// Examples of the wire, put together by hand from ASEBA's description of it.
TEST(Frames, AreAsOnTheWire) {
  EXPECT_THAT(texts(to_frames(Message{0, type::kListNodes, {}}.add(5))), ElementsAre("300#11A00500"));
  EXPECT_THAT(texts(to_frames(Message{1, type::kNodePresent, {}}.add(5))), ElementsAre("301#0C900500"));
  Message description{1, type::kDescription, {}};
  description.add_text("left-motor").add(4).add(1024).add(32).add(200).add(6).add(1).add(8);
  EXPECT_THAT(texts(to_frames(description)),
              ElementsAre("101#00900A6C6566742D", "001#6D6F746F72040000", "001#042000C800060001", "201#000800"));
  EXPECT_THAT(texts(to_frames(Message{1, type::kNamedVariable, {}}.add(1).add_text("speed"))),
              ElementsAre("101#0190010005737065", "201#6564"));
  EXPECT_THAT(texts(to_frames(Message{0, type::kSetVariables, {}}.add(1).add(34).add(30))),
              ElementsAre("300#0CA0010022001E00"));
  EXPECT_THAT(texts(to_frames(Message{0, type::kSetVariables, {}}.add(1).add(35).add(0xFED4).add(77))),
              ElementsAre("100#0CA001002300D4FE", "200#4D00"));
}

TEST(Frames, AreAsManyAsNeeded) {
  for (const auto& [bytes, count] :
       std::vector<std::pair<std::size_t, std::size_t>>{{2, 1}, {8, 1}, {9, 2}, {16, 2}, {17, 3}, {518, 65}}) {
    const auto frames = to_frames(message_of(bytes));
    EXPECT_EQ(frames.size(), count) << bytes;
    EXPECT_GE(frames.back().size, 1) << bytes;
    Assembler assembler;
    for (std::size_t i = 0; i + 1 < frames.size(); ++i) EXPECT_FALSE(assembler.push(frames[i]));
    EXPECT_EQ(assembler.push(frames.back()), message_of(bytes));
  }
}

TEST(Frames, TakeTheirTime) {
  // 111 bits and 24 that are stuffed in.
  EXPECT_EQ(duration_ns(frame("100#0000000000000000")), 135'000);
  EXPECT_EQ(duration_ns(frame("300#")), 55'000);
}

TEST(Assembler, KeepsSendersApart) {
  Assembler assembler;
  const auto a = to_frames(Message{1, 0x9001, {1, 2, 3, 4, 5, 6, 7, 8}});
  const auto b = to_frames(Message{2, 0x9001, {9, 10, 11, 12, 13, 14, 15, 16}});
  EXPECT_FALSE(assembler.push(a[0]));
  EXPECT_FALSE(assembler.push(b[0]));
  EXPECT_TRUE(assembler.push(frame("303#0C900400")));
  EXPECT_EQ(assembler.push(b[1])->payload.front(), 9);
  EXPECT_EQ(assembler.push(a[1])->payload.front(), 1);
}

// As the firmware does, which has no way to notice.
TEST(Assembler, GivesWhatIsThere) {
  Assembler assembler;
  EXPECT_EQ(assembler.push(frame("200#4D00"))->type, 0x4D);  // no first part
  EXPECT_FALSE(assembler.push(frame("100#0CA001002300D4FE")));
  EXPECT_FALSE(assembler.push(frame("100#0CA001002300D4FE")));  // the last part of the first was lost
  EXPECT_EQ(assembler.push(frame("200#4D00"))->payload.size(), 16U);
  EXPECT_FALSE(assembler.push(frame("300#11")));  // no type
  EXPECT_FALSE(assembler.push(frame("400#11A00500")));
}

TEST(Assembler, ForgetsWhatIsTooLong) {
  Assembler assembler;
  EXPECT_FALSE(assembler.push(frame("100#0CA0010000000000")));
  for (int i = 0; i < 64; ++i) EXPECT_FALSE(assembler.push(frame("000#0000000000000000")));
  const auto rest = assembler.push(frame("200#0102030405060708"));
  ASSERT_TRUE(rest);
  EXPECT_EQ(rest->type, 0x0201);
  EXPECT_EQ(rest->payload.size(), 6U);
}

TEST(Stream, IsAsOnTheWire) {
  const std::vector<std::uint8_t> present = {2, 0, 1, 0, 0x0C, 0x90, 5, 0};
  EXPECT_EQ(to_bytes(Message{1, type::kNodePresent, {5, 0}}), present);
  StreamReader reader;
  for (const std::uint8_t byte : present) {
    EXPECT_FALSE(reader.next());
    reader.push(std::span(&byte, 1));
  }
  EXPECT_EQ(reader.next(), (Message{1, type::kNodePresent, {5, 0}}));
  EXPECT_FALSE(reader.next());
  EXPECT_FALSE(reader.broken());
}

TEST(Stream, BreaksAtALengthThatNoMessageHas) {
  StreamReader reader;
  const std::vector<std::uint8_t> longest = {0x04, 0x02, 0, 0, 0x0C, 0xA0};
  reader.push(longest);
  EXPECT_FALSE(reader.next());
  EXPECT_FALSE(reader.broken());
  StreamReader other;
  other.push(std::vector<std::uint8_t>{0x05, 0x02, 0, 0, 0x0C, 0xA0});
  EXPECT_FALSE(other.next());
  EXPECT_TRUE(other.broken());
}

}  // namespace
}  // namespace tandem::bridges::footbot_emulator
