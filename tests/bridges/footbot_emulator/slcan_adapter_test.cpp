#include "bridges/footbot_emulator/slcan_adapter.hpp"

#include "tests/bridges/footbot_emulator/bench.hpp"

namespace tandem::bridges::footbot_emulator {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class Adapter : public testing::Test {
 protected:
  /// What it answers.
  std::string say(const std::string& text) {
    to_bus_.clear();
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(text.data());
    adapter_.receive({bytes, text.size()}, 12'345 * kMs, to_bus_);
    return adapter_.take_output();
  }
  std::string show(const std::string& text) {
    adapter_.show(frame(text), 61'234 * kMs);
    return adapter_.take_output();
  }
  std::vector<Frame> to_bus_;
  std::vector<std::string> log_;
  SlcanAdapter adapter_{[this](hal::TimeNs at, std::string_view name, const EventFields& fields) {
    log_.push_back(to_json(at, name, fields));
  }};
};

TEST_F(Adapter, IsOpenedAndClosed) {
  EXPECT_EQ(say("O\r"), "\a");  // no bit rate yet
  EXPECT_EQ(say("\r\r\rC\r"), "\r\r\r\a");
  EXPECT_EQ(say("V\r"), "V1013\r");
  EXPECT_EQ(say("N\r"), "NFB00\r");
  EXPECT_EQ(say("S9\r"), "\a");
  EXPECT_EQ(say("S8\r"), "\r");
  EXPECT_EQ(say("F\r"), "\a");
  EXPECT_EQ(say("O\r"), "\r");
  EXPECT_TRUE(adapter_.open());
  EXPECT_EQ(say("S8\r"), "\a");
  EXPECT_EQ(say("O\r"), "\a");
  EXPECT_EQ(say("F\r"), "F00\r");
  EXPECT_EQ(say("C\r"), "\r");
  EXPECT_FALSE(adapter_.open());
}

TEST_F(Adapter, CarriesFrames) {
  say("S8\rO\r");
  EXPECT_EQ(say("t300411A00500\r"), "z\r");
  EXPECT_THAT(texts(to_bus_), ElementsAre("300#11A00500"));
  EXPECT_EQ(say("t300411a0"), "");
  EXPECT_EQ(say("0500\rt3000\r"), "z\rz\r");
  EXPECT_THAT(texts(to_bus_), ElementsAre("300#11A00500", "300#"));
  EXPECT_EQ(show("301#0C900500"), "t30140C900500\r");
  EXPECT_EQ(show("101#00900A6C6566742D"), "t101800900A6C6566742D\r");
  say("C\r");
  EXPECT_EQ(show("301#0C900500"), "");
  EXPECT_EQ(say("t300411A00500\r"), "\a");
  EXPECT_THAT(to_bus_, IsEmpty());
}

TEST_F(Adapter, RefusesWhatIsNoFrame) {
  say("S8\rO\r");
  for (const char* line : {"t", "t300", "t3009", "t300911A00500", "t300411A005", "t300411A0050", "t300411A0050000",
                           "t30G411A00500", "t800411A00500", "t300411A005XX", "T300411A00500", "Q", "x300"}) {
    EXPECT_EQ(say(std::string(line) + "\r"), "\a") << line;
    EXPECT_THAT(to_bus_, IsEmpty()) << line;
  }
  EXPECT_EQ(say(std::string(1000, 't') + "\r"), "\a");
  EXPECT_EQ(say("t300411A00500\r"), "z\r");
}

TEST_F(Adapter, TakesExtendedAndRemoteFramesThatNoModuleWants) {
  say("S8\rO\r");
  EXPECT_EQ(say("T12ABCDEF2AA55\r"), "Z\r");
  EXPECT_EQ(say("r1234\r"), "z\r");
  EXPECT_THAT(to_bus_, IsEmpty());
}

TEST_F(Adapter, OnlyListens) {
  say("S8\rL\r");
  EXPECT_EQ(say("t300411A00500\r"), "\a");
  EXPECT_EQ(show("301#0C900500"), "t30140C900500\r");
}

TEST_F(Adapter, StampsFrames) {
  EXPECT_EQ(say("Z1\rS8\rO\r"), "\r\r\r");
  EXPECT_EQ(show("301#0C900500"), "t30140C90050004D2\r");  // 61,234 ms is 1,234 of the second minute
}

TEST_F(Adapter, HearsNothingAtAnotherBitRate) {
  EXPECT_EQ(say("S6\rO\r"), "\r\r");
  EXPECT_EQ(say("t300411A00500\r"), "z\r");
  EXPECT_THAT(to_bus_, IsEmpty());
  EXPECT_EQ(show("301#0C900500"), "");
  EXPECT_EQ(say("F\r"), "FA0\r");
  EXPECT_EQ(say("F\r"), "F00\r");
}

}  // namespace
}  // namespace tandem::bridges::footbot_emulator
