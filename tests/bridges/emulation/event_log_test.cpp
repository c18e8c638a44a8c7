#include "bridges/emulation/event_log.hpp"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <limits>

namespace tandem::bridges {
namespace {

TEST(EventLog, WritesOneObjectALine) {
  EXPECT_EQ(to_json(12, "wheels", {{"left", 500}, {"right", -500}}),
            R"({"t_ns":12,"event":"wheels","left":500,"right":-500})");
  EXPECT_EQ(to_json(0, "x", {{"a", true}, {"b", 0.25}, {"c", "text"}, {"d", std::vector<std::int64_t>{-1, 2}}}),
            R"({"t_ns":0,"event":"x","a":true,"b":0.25,"c":"text","d":[-1,2]})");
}

TEST(EventLog, EscapesWhateverBytesCameIn) {
  EXPECT_EQ(to_json(0, "x", {{"text", std::string("a\"\\\n\0\xFF", 6)}}),
            "{\"t_ns\":0,\"event\":\"x\",\"text\":\"a\\\"\\\\\\n\\u0000\xEF\xBF\xBD\"}");
  EXPECT_EQ(to_json(0, "x", {{"v", std::numeric_limits<double>::quiet_NaN()}}), R"({"t_ns":0,"event":"x","v":null})");
}

TEST(EventLog, WritesNamesAsTheyAre) {
  EXPECT_EQ(to_json(0, "x", {{"name", "Zürich 🤖"}}), R"({"t_ns":0,"event":"x","name":"Zürich 🤖"})");
}

TEST(EventLog, IsReadableWhileItIsWritten) {
  const auto path = std::filesystem::temp_directory_path() / ("emulation_event_log_" + std::to_string(getpid()));
  const auto log = EventLog::open(path.string());
  ASSERT_TRUE(log.ok());
  log.value()->write(1, "stop", {});
  std::string line;
  std::getline(std::ifstream(path), line);
  EXPECT_EQ(line, R"({"t_ns":1,"event":"stop"})");
  std::filesystem::remove(path);
}

TEST(EventLog, SaysWhereItCannotBeWritten) {
  const auto log = EventLog::open("/nowhere/at/all");
  ASSERT_FALSE(log.ok());
  EXPECT_NE(log.error().message.find("/nowhere/at/all"), std::string::npos);
}

TEST(EventSinks, InOrderNeverGoBack) {
  std::vector<hal::TimeNs> stamps;
  const auto sink =
      open_event_sink("", [&](hal::TimeNs at, std::string_view, const EventFields&) { stamps.push_back(at); });
  ASSERT_TRUE(sink.ok());
  const EventSink tell = in_order(sink.value());
  for (const hal::TimeNs at : {3, 1, 4}) tell(at, "x", {});
  EXPECT_EQ(stamps, (std::vector<hal::TimeNs>{3, 3, 4}));
}

}  // namespace
}  // namespace tandem::bridges
