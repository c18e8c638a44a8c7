// `tandem bench` as a user meets it: lines, figures, refusals.
#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <gtest/gtest.h>

#include "hal/json/json.hpp"
#include "tests/bench/lines.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem {
namespace {

using bench::line_of;
using bench::on;
using scenarios::Folder;
using scenarios::Tandem;
using scenarios::text_of;

std::vector<hal::Json> objects_in(const std::string& text) {
  std::vector<hal::Json> all;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    auto object = hal::parse_json_object(line);
    EXPECT_TRUE(object.ok()) << line << "\n" << (object.ok() ? "" : object.error().message);
    if (object.ok()) all.push_back(std::move(object).value());
  }
  return all;
}

double number(const hal::Json& o, const char* key) {
  const auto found = o.find(key);
  const bool there = found != o.end() && found->is_number();
  EXPECT_TRUE(there) << key;
  return there ? found->get<double>() : std::nan("");
}

std::string text(const hal::Json& o, const char* key) {
  const auto found = o.find(key);
  const bool there = found != o.end() && found->is_string();
  EXPECT_TRUE(there) << key;
  return there ? found->get<std::string>() : std::string();
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

TEST(BenchCommand, EndsSoonAtCtrlCWithTheCodeOfThat) {
  const std::vector<std::vector<std::string>> benches = {{"view", "--repeat", "1000"},
                                                         {"lockstep", "--robots", "3", "--ticks", "100000000"},
                                                         {"back", "--repeat", "1000"},
                                                         {"diffusion", "--robots", "1000", "--ticks", "100000000"}};
  for (const auto& words : benches) {
    Folder folder;
    std::vector<std::string> all{"bench"};
    all.insert(all.end(), words.begin(), words.end());
    Tandem bench(all, folder.path());
    EXPECT_EQ(bench.wait(3.0), -1000) << words[0] << " is at work: " << bench.errors();
    bench.signal(SIGINT);
    EXPECT_EQ(bench.wait(20.0), 130) << words[0] << ": " << bench.errors();
  }
}

TEST(BenchCommand, TellsTheWayBackToEarlierTicks) {
  Folder folder;
  Tandem bench({"bench", "back", "--robots", "30", "--ticks", "200"}, folder.path());
  EXPECT_EQ(bench.wait(), 0) << bench.errors();
  const auto lines = objects_in(bench.output());
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0]["same_bits"], true);
  EXPECT_GE(number(lines[0], "checkpoints"), 1.0);
  EXPECT_GT(number(lines[0], "checkpoints_MB"), 0.0);
  EXPECT_LT(number(lines[0], "back_longest_s"), 5.0);
}

TEST(BenchLines, TellWhatAWindowCosts) {
  Folder folder;
  Tandem bench({"bench", "view", "--robots", "50", "--ticks", "200", "--repeat", "2"}, folder.path());
  ASSERT_EQ(bench.wait(60.0), 0) << bench.errors();
  const auto lines = objects_in(bench.output());
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_GT(number(lines[0], "wall_quotient"), 0.0);
  EXPECT_GT(number(lines[1], "first_frame_s"), 0.0);
  EXPECT_GE(number(lines[1], "first_frame_s"), number(lines[1], "address_s"));
}

TEST(BenchLines, TellHowManyMessagesTheCodecTakes) {
  Folder folder;
  Tandem bench({"bench", "codec"}, folder.path());
  ASSERT_EQ(bench.wait(), 0) << bench.errors();
  const auto lines = objects_in(bench.output());
  ASSERT_EQ(lines.size(), 4U);
  for (const auto& line : lines) EXPECT_GT(number(line, "messages_per_s"), 0.0) << text(line, "what");
}

TEST(BenchLines, TellOfAFlockInSpace) {
  Folder folder;
  Tandem bench({"bench", "flocking", "--robots", "300", "--threads", "0,2", "--ticks", "5"}, folder.path());
  ASSERT_EQ(bench.wait(), 0) << bench.errors();
  const auto lines = objects_in(bench.output());
  ASSERT_EQ(lines.size(), 2U);
  for (const auto& line : lines) {
    EXPECT_EQ(text(line, "bench"), "flocking");
    EXPECT_EQ(text(line, "robot"), "eye-bot");
    EXPECT_EQ(text(line, "engine"), "particle3d");
    EXPECT_EQ(text(line, "density"), "equal");
    EXPECT_EQ(text(line, "state_hash"), text(lines[0], "state_hash"));
  }
  Tandem wrong({"bench", "flocking", "--robot", "e-puck"}, folder.path());
  EXPECT_EQ(wrong.wait(), 2);
  EXPECT_NE(wrong.errors().find("eye-bot"), std::string::npos) << wrong.errors();
}

TEST(BenchLines, TellWhichDevicesTheRobotsHave) {
  Folder folder;
  Tandem bench({"bench", "diffusion", "--robots", "200", "--robot", "foot-bot", "--engine", "dynamics2d", "--ticks",
                "3", "--with", "range_and_bearing,omnidirectional_camera"},
               folder.path());
  ASSERT_EQ(bench.wait(), 0) << bench.errors();
  const auto lines = objects_in(bench.output());
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(text(lines[0], "devices"), "range_and_bearing,omnidirectional_camera");
  Tandem without({"bench", "diffusion", "--robots", "1", "--with", "omnidirectional_camera"}, folder.path());
  EXPECT_EQ(without.wait(), 2);
  EXPECT_NE(without.errors().find("device of the e-puck"), std::string::npos) << without.errors();
}

TEST(BenchLines, TellOfASensorFromOutsideWhatTheyTellOfTheSameInside) {
  Folder folder;
  const std::string plugin = std::string(test::kBuildDir) + "/tests/bench_plugins/libtest_outside_proximity.so";
  const auto hash_with = [&](const std::string& implementation) {
    Tandem bench({"bench", "diffusion", "--robots", "500", "--ticks", "50", "--with", "proximity:" + implementation,
                  "--plugin", plugin},
                 folder.path());
    EXPECT_EQ(bench.wait(), 0) << bench.errors();
    const auto lines = objects_in(bench.output());
    EXPECT_EQ(lines.size(), 1U);
    return lines.empty() ? "" : text(lines[0], "state_hash");
  };
  const std::string inside = hash_with("default");
  EXPECT_FALSE(inside.empty());
  EXPECT_EQ(hash_with("outside"), inside);
  Tandem wrong({"bench", "diffusion", "--robots", "1", "--with", "proximity:nowhere"}, folder.path());
  EXPECT_EQ(wrong.wait(), 2);
}

TEST(BenchLines, AreComplete) {
  Folder folder;
  Tandem bench({"bench", "diffusion", "--robots", "1,30", "--threads", "0,2", "--partition", "A1,A4", "--assignment",
                "dynamic", "--ticks", "3", "--repeat", "2"},
               folder.path());
  ASSERT_EQ(bench.wait(), 0) << bench.errors();
  EXPECT_EQ(bench.errors(), "");
  const auto lines = objects_in(bench.output());
  ASSERT_EQ(lines.size(), 16U);
  for (const hal::Json& o : lines) {
    EXPECT_EQ(text(o, "bench"), "diffusion");
    EXPECT_EQ(text(o, "robot"), "e-puck");
    EXPECT_EQ(text(o, "engine"), "kinematics2d");
    EXPECT_EQ(text(o, "density"), "40 m");
    EXPECT_EQ(text(o, "assignment"), "dynamic");
    EXPECT_EQ(number(o, "ticks"), 3.0);
    EXPECT_EQ(number(o, "steps"), 3.0);
    EXPECT_EQ(text(o, "regions"), text(o, "partition") == "A4" ? "2x2" : "1x1");
    EXPECT_GE(number(o, "init_s"), 0.0);
    EXPECT_GE(number(o, "close_s"), 0.0);
    EXPECT_GE(number(o, "bytes_per_robot"), 0.0);
    EXPECT_GE(number(o, "cores"), 1.0);
    EXPECT_FALSE(text(o, "cpu_model").empty());
    EXPECT_EQ(text(o, "state_hash").size(), 18U);
    const double robot_steps = number(o, "robots") * number(o, "steps");
    EXPECT_NEAR(number(o, "cpu_ns_per_robot_step") * robot_steps, number(o, "cpu_s") * 1e9, 1.0);
    EXPECT_NEAR(number(o, "wall_ns_per_robot_step") * robot_steps, number(o, "wall_s") * 1e9, 1.0);
    EXPECT_DOUBLE_EQ(number(o, "speedup"), number(o, "cpu_s") / number(o, "wall_s"));
    EXPECT_DOUBLE_EQ(number(o, "realtime_factor"), number(o, "virtual_s") / number(o, "wall_s"));
  }
}

TEST(BenchLines, TellWhichRobotWasMeasured) {
  Folder folder;
  Tandem bench(
      {"bench", "diffusion", "--robot", "foot-bot", "--engine", "dynamics2d", "--robots", "30", "--ticks", "3"},
      folder.path());
  ASSERT_EQ(bench.wait(), 0) << bench.errors();
  const auto lines = objects_in(bench.output());
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(text(lines[0], "robot"), "foot-bot");
  EXPECT_EQ(number(lines[0], "steps"), 3.0);
}

TEST(BenchLines, GoRoundAllCasesAndKeepTheirStateForAnyNumberOfThreads) {
  Folder folder;
  Tandem bench({"bench", "--robots", "100,300", "--threads", "0,2", "--regions", "3x2,auto", "--ticks", "5", "--repeat",
                "2", "--density", "equal"},
               folder.path());
  ASSERT_EQ(bench.wait(), 0) << bench.errors();
  const auto lines = objects_in(bench.output());
  ASSERT_EQ(lines.size(), 16U);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    EXPECT_EQ(number(lines[i], "repeat"), i < 8 ? 0.0 : 1.0);
    EXPECT_EQ(text(lines[i], "partition"), i % 8 < 4 ? "3x2" : "auto");
    EXPECT_EQ(number(lines[i], "robots"), i % 4 < 2 ? 100.0 : 300.0);
    EXPECT_EQ(number(lines[i], "threads"), i % 2 == 0 ? 0.0 : 2.0);
    EXPECT_EQ(text(lines[i], "density"), "equal");
    EXPECT_EQ(text(lines[i], "assignment"), "static");
    EXPECT_EQ(text(lines[i], "state_hash"), text(lines[i % 8 / 2 * 2], "state_hash")) << i;
  }
  EXPECT_NE(text(lines[0], "state_hash"), text(lines[2], "state_hash"));
}

class BenchRefuses : public testing::Test {
 protected:
  void refuses(const std::vector<std::string>& arguments, int code, const std::vector<std::string>& parts) {
    std::vector<std::string> all = {"bench", "diffusion"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    Tandem bench(all, folder_.path());
    EXPECT_EQ(bench.wait(), code) << bench.errors();
    EXPECT_EQ(bench.output(), "");
    for (const std::string& part : parts)
      EXPECT_NE(bench.errors().find(part), std::string::npos) << "no \"" << part << "\" in:\n" << bench.errors();
  }
  Folder folder_;
};

TEST_F(BenchRefuses, WordsThatItDoesNotKnowAndNamesTheChoices) {
  refuses({"--engine", "kinematics2d,warp"}, 2, {"there is no engine 'warp'; there are: kinematics2d, dynamics2d"});
  refuses({"--partition", "A1,A3"}, 2, {"there is no partition 'A3'", "A1, A2, A4, A8, A16", "--regions"});
  refuses({"--regions", "4x4,4"}, 2, {"columns x lines", "auto", "'4'"});
  refuses({"--partition", "A1", "--regions", "4x4"}, 2, {"--partition", "--regions"});
  refuses({"--threads", "0,x"}, 2, {"--threads", "0 to 1024"});
  refuses({"--threads", "0,5000"}, 2, {"--threads", "0 to 1024"});
  refuses({"--robots", "10,0"}, 2, {"--robots", "1 to 100000000"});
  refuses({"--robot", "r2d2"}, 2, {"there is no robot 'r2d2'; there are: e-puck, foot-bot"});
  refuses({"--assignment", "random"}, 2, {"static or dynamic"});
  refuses({"--density", "high"}, 2, {"equal"});
  refuses({"--plot", "figure.gif"}, 2, {"figure.gif", ".svg, .png or .pdf"});
  refuses({"--compare-threads"}, 2, {"--threads 0,2"});
}

TEST_F(BenchRefuses, WhatTheWorldRefusesInItsWords) {
  refuses({"--engine", "dynamics2d", "--regions", "999x999", "--robots", "1", "--plot", "f.svg"}, 1,
          {"bench diffusion: error: regions=\"999x999\" are more than 4096 parts"});
  EXPECT_FALSE(scenarios::fs::exists(folder_.path() / "f.svg"));
}

TEST_F(BenchRefuses, FiguresThatCannotBeDrawnBeforeItMeasures) {
  refuses({"--robots", "100000000", "--plot", "no/such/folder/f.svg"}, 1, {"no/such/folder/f.svg"});
  const char* path = std::getenv("PATH");
  const std::string before = path == nullptr ? "" : path;
  setenv("PATH", "/nonexistent", 1);
  refuses({"--robots", "100000000", "--plot", "f.svg"}, 3, {"gnuplot", "gnuplot-nox"});
  setenv("PATH", before.c_str(), 1);
}

TEST_F(BenchRefuses, SavedLinesThatAreBrokenMixedOrNotThere) {
  const std::string good = bench::text_of(line_of(10, 0, 1.0)) + "\n";
  bench::ResultLine other = line_of(10, 2, 1.0);
  other.density = "equal";
  folder_.write("good.jsonl", good);
  folder_.write("broken.jsonl", good + good.substr(0, 40) + "\n");
  folder_.write("mixed.jsonl", good + good + bench::text_of(other) + "\n");
  refuses({"--from", "nosuch.jsonl", "--plot", "f.svg"}, 1, {"nosuch.jsonl: error: "});
  refuses({"--from", "broken.jsonl", "--plot", "f.svg"}, 1, {"broken.jsonl:2: error: "});
  refuses({"--from", "mixed.jsonl", "--plot", "f.svg"}, 1, {"mixed.jsonl:3: error: density 'equal'"});
  refuses({"--from", "good.jsonl", "--plot", "f.svg", "--robots", "11"}, 1, {"good.jsonl: error: none of its lines"});
  refuses({"--from", "good.jsonl"}, 2, {"--plot", "--compare-threads"});
  refuses({"--from", "good.jsonl", "--plot", "f.svg", "--repeat", "2"}, 2, {"--repeat", "--from"});
  EXPECT_FALSE(scenarios::fs::exists(folder_.path() / "f.svg"));
  refuses({"--from", "mixed.jsonl", "--plot", "f.svg", "--density", "equal"}, 0, {});  // what goes together is chosen
  EXPECT_TRUE(scenarios::fs::exists(folder_.path() / "f.svg"));
}

/// Whether another program than the one that drew it can read the picture.
void expect_readable(const scenarios::fs::path& svg) {
  const std::string command = "rsvg-convert '" + svg.string() + "' -o '" + svg.string() + ".png'";
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
  EXPECT_GT(scenarios::fs::file_size(svg.string() + ".png"), 1000U);
}

/// Width and height of a PNG (W3C PNG specification, 11.2.2); checks that the file is whole.
std::array<int, 2> size_of_png(const scenarios::fs::path& file) {
  const std::string bytes = text_of(file);
  if (bytes.size() < 45) ADD_FAILURE() << "only " << bytes.size() << " bytes";
  if (bytes.size() < 45) return {};
  EXPECT_EQ(bytes.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(bytes.substr(12, 4), "IHDR");
  EXPECT_EQ(bytes.substr(bytes.size() - 8, 4), "IEND");
  const auto at = [&](std::size_t i) { return static_cast<int>(static_cast<unsigned char>(bytes[i])); };
  return {at(18) * 256 + at(19), at(22) * 256 + at(23)};
}

TEST(BenchFigure, IsDrawnWhileMeasuringAndTheSameFromSavedLines) {
  Folder folder;
  Tandem bench({"bench", "diffusion", "--robots", "1,10,100", "--threads", "0,1,2", "--ticks", "20", "--repeat", "3",
                "--plot", "measured.svg"},
               folder.path());
  ASSERT_EQ(bench.wait(), 0) << bench.errors();
  ASSERT_EQ(objects_in(bench.output()).size(), 27U);
  const std::string svg = text_of(folder.path() / "measured.svg");
  for (const char* label : {"P = 0", "P = 1", "P = 2"})
    EXPECT_EQ(count(svg, std::string("<title>") + label + "</title>"), 2U) << label;  // wall time and speed-up
  for (const char* words : {"wall time [s]", "number of robots N", "speed-up (CPU / wall)", "real time, T = 2 s",
                            "kinematics2d, automatic split", "medians of 3 runs"})
    EXPECT_EQ(count(svg, words), 1U) << words;
  EXPECT_GT(count(svg, "stroke-dasharray"), 0U);
  expect_readable(folder.path() / "measured.svg");

  folder.write("saved.jsonl", bench.output());
  Tandem again({"bench", "--from", "saved.jsonl", "--plot", "saved.svg"}, folder.path());
  ASSERT_EQ(again.wait(), 0) << again.errors();
  EXPECT_EQ(again.output() + again.errors(), "");
  EXPECT_EQ(text_of(folder.path() / "saved.svg"), svg);
  EXPECT_FALSE(scenarios::fs::exists(folder.path() / "saved.svg.part"));
}

TEST(BenchFigure, HasAPanelForEachEngineAndPartitionAndIsPngWhereAsked) {
  std::string lines;
  for (const char* engine : {"kinematics2d", "dynamics3d"}) {
    for (const char* partition : {"A1", "A4", "A16"}) {
      for (const std::int64_t threads : {0, 4}) {
        for (const std::int64_t robots : {1, 1000, 100'000})
          lines += bench::text_of(on(engine, partition, line_of(robots, threads, 1e-3 * static_cast<double>(robots)))) +
                   "\n";
      }
    }
  }
  Folder folder;
  folder.write("t.jsonl", lines);
  const auto draw = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"bench", "--from", "t.jsonl", "--plot"});
    Tandem bench(more, folder.path());
    EXPECT_EQ(bench.wait(), 0) << bench.errors();
  };
  draw({"all.svg"});
  const std::string all = text_of(folder.path() / "all.svg");
  EXPECT_EQ(count(all, "<title>P = 0</title>"), 12U);
  EXPECT_EQ(count(all, "<title>P = 4</title>"), 12U);
  for (const char* title : {"kinematics2d, A16", "dynamics3d, A1<", "dynamics3d, A4"}) EXPECT_EQ(count(all, title), 1U);

  draw({"fixed.svg", "--threads", "4", "--engine", "dynamics3d"});
  const std::string fixed = text_of(folder.path() / "fixed.svg");
  for (const char* partition : {"A1", "A4", "A16"})
    EXPECT_EQ(count(fixed, "<title>" + std::string(partition) + "</title>"), 2U) << partition;
  EXPECT_EQ(count(fixed, "dynamics3d, P = 4"), 1U);

  draw({"one.png", "--partition", "A4", "--engine", "dynamics3d"});
  draw({"six.png"});
  const auto one = size_of_png(folder.path() / "one.png");
  const auto six = size_of_png(folder.path() / "six.png");
  EXPECT_GT(one[0], 1000);
  EXPECT_GT(one[1], 1000);
  EXPECT_GT(six[0], 2 * one[0]);
  EXPECT_GT(2 * six[1], 3 * one[1]);
}

TEST(BenchFigure, ComparesThreadsOnStandardError) {
  Folder folder;
  std::string lines;
  for (const double slower : {1.0, 3.0, 10.0}) {
    lines += bench::text_of(line_of(1000, 0, 2.0 * slower)) + "\n";
    lines += bench::text_of(line_of(1000, 2, 1.0 * slower)) + "\n";
  }
  folder.write("t.jsonl", lines);
  Tandem saved({"bench", "--from", "t.jsonl", "--compare-threads"}, folder.path());
  ASSERT_EQ(saved.wait(), 0);
  EXPECT_EQ(saved.errors(), "kinematics2d, A1, N = 1000: P = 2: 2.00 times as fast as P = 0 (2.00 to 2.00, 3 pairs)\n");
  EXPECT_EQ(saved.output(), "");

  Tandem measured({"bench", "--robots", "5", "--threads", "0,2", "--ticks", "5", "--compare-threads"}, folder.path());
  ASSERT_EQ(measured.wait(), 0) << measured.errors();
  EXPECT_EQ(objects_in(measured.output()).size(), 2U);
  EXPECT_EQ(measured.errors().find("kinematics2d, auto, N = 5: P = 2: "), 0U) << measured.errors();
}

}  // namespace
}  // namespace tandem
