#include "bench/result_line.hpp"

#include <gtest/gtest.h>

#include "tests/bench/lines.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem::bench {
namespace {

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

TEST(ResultLine, IsReadAsItWasSaved) {
  const ResultLine saved = on("dynamics2d", "A4", line_of(100, 2, 3.25));
  auto line = parse_result_line(text_of(saved));
  ASSERT_TRUE(line.ok()) << line.error().message;
  EXPECT_EQ(text_of(line.value()), text_of(saved));
  EXPECT_EQ(line->speedup(), 2.0);
}

TEST(ResultLine, SaysWhichFieldIsWrong) {
  const std::string good = text_of(line_of(100, 2, 3.25));
  const std::tuple<const char*, const char*, const char*> kBroken[] = {
      {"\"engine\"", "\"motor\"", "there is no \"engine\""},
      {"\"robots\": 100", "\"robots\": 0", "\"robots\" must be a whole number from 1"},
      {"\"robots\": 100", "\"robots\": 1.5", "\"robots\" must be a whole number from 1"},
      {"\"threads\": 2", "\"threads\": \"2\"", "\"threads\" must be a number"},
      {"\"threads\": 2", "\"threads\": 1e300", "\"threads\" must be a whole number from 0"},
      {"\"density\": \"40 m\"", "\"density\": 40", "\"density\" must be a text"},
      {"\"wall_s\": 3.25", "\"wall_s\": 0", "\"wall_s\" must be greater than 0"},
      {"\"cpu_s\": 6.5", "\"cpu_s\": -1", "\"cpu_s\" must be 0 or greater"},
      {"\"cpu_s\": 6.5", "\"cpu_s\": null", "\"cpu_s\" must be a number"},
      {"{", "{\"failure\": \"a robot left\", ", "this run failed"},
      {"}", "", "no JSON object"}};
  for (const auto& [from, to, why] : kBroken) {
    auto line = parse_result_line(replaced(good, from, to));
    ASSERT_FALSE(line.ok()) << to;
    EXPECT_NE(line.error().message.find(why), std::string::npos) << line.error().message;
  }
}

TEST(ResultLines, KnowTheirPlaceInTheFile) {
  scenarios::Folder folder;
  const std::string a = text_of(line_of(1, 0, 1.0));
  auto lines = read_result_lines(folder.write("t.jsonl", a + "\n\n" + a + "\r\n" + a).string());
  ASSERT_TRUE(lines.ok()) << lines.error().message;
  ASSERT_EQ(lines->size(), 3U);
  EXPECT_EQ(lines.value()[1].number, 3);
  EXPECT_EQ(lines.value()[2].number, 4);

  const std::string broken = folder.write("broken.jsonl", a + "\n\n" + a.substr(0, 50) + "\n").string();
  auto refused = read_result_lines(broken);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().message.find(broken + ":3: error: "), 0U) << refused.error().message;

  for (const std::string& path :
       {folder.write("empty.jsonl", "").string(), folder.path().string(), (folder.path() / "nosuch.jsonl").string()}) {
    auto none = read_result_lines(path);
    ASSERT_FALSE(none.ok()) << path;
    EXPECT_EQ(none.error().message.find(path + ": error: "), 0U) << none.error().message;
  }
}

TEST(ResultLines, OfDifferentScenesOrMachinesAreToldApart) {
  const std::vector<ResultLine> alike = {line_of(1, 0, 1.0), on("dynamics2d", "A4", line_of(10, 2, 2.0))};
  EXPECT_TRUE(check_alike(alike, "t.jsonl").ok());
  const std::pair<const char*, void (*)(ResultLine&)> kChanges[] = {
      {"t.jsonl:7: error: robot 'foot-bot' here, 'e-puck' in line 1", [](ResultLine& l) { l.robot = "foot-bot"; }},
      {"t.jsonl:7: error: density 'equal' here, '40 m' in line 1", [](ResultLine& l) { l.density = "equal"; }},
      {"t.jsonl:7: error: assignment 'dynamic' here", [](ResultLine& l) { l.assignment = "dynamic"; }},
      {"t.jsonl:7: error: processor 'Other' here", [](ResultLine& l) { l.cpu_model = "Other"; }},
      {"t.jsonl:7: error: benchmark 'other' here", [](ResultLine& l) { l.bench = "other"; }},
      {"t.jsonl:7: error: cores '8' here, '4' in line 1", [](ResultLine& l) { l.cores = 8; }}};
  for (const auto& [message, change] : kChanges) {
    auto mixed = alike;
    mixed[1].number = 7;
    change(mixed[1]);
    const hal::Status status = check_alike(mixed, "t.jsonl");
    ASSERT_FALSE(status.ok()) << message;
    EXPECT_EQ(status.error().message.find(message), 0U) << status.error().message;
  }
}

}  // namespace
}  // namespace tandem::bench
