// The documents tell the truth: their code builds and runs as printed, their commands, options and links exist.
#include <cmath>
#include <gtest/gtest.h>
#include <map>
#include <regex>
#include <set>

#include "tests/checkout.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem {
namespace {

using scenarios::Folder;
using scenarios::Tandem;
using scenarios::text_of;
namespace fs = std::filesystem;

const fs::path kTop = test::kSourceDir;

/// README.md, the pages under docs, and those that stand beside the code that they explain.
std::vector<fs::path> documents() {
  std::vector<fs::path> all = {kTop / "README.md"};
  for (const char* folder :
       {"docs", "app", "bench", "bridges", "core", "mixed_reality", "studies", "tests", "validate"}) {
    for (const auto& entry : fs::recursive_directory_iterator(kTop / folder)) {
      if (entry.path().extension() == ".md") all.push_back(entry.path());
    }
  }
  return all;
}

std::vector<std::smatch> matches(const std::string& text, const std::regex& pattern) {
  return {std::sregex_iterator(text.begin(), text.end(), pattern), std::sregex_iterator()};
}

/// Code blocks that carry a file's name after their language, by that name.
std::map<std::string, std::string> named_blocks(const std::string& markdown) {
  static const std::regex kBlock("```\\w+ (\\S+)\n([^`]*)```");
  std::map<std::string, std::string> blocks;
  for (const std::smatch& m : matches(markdown, kBlock)) blocks[m[1]] = m[2];
  return blocks;
}

/// Without its code blocks.
std::string prose(const std::string& markdown) {
  static const std::regex kBlock("```[^`]*```");
  return std::regex_replace(markdown, kBlock, "");
}

/// The shell block that contains `part`.
std::string shell_block(const std::string& markdown, const std::string& part) {
  static const std::regex kBlock("```sh\n([^`]*)```");
  for (const std::smatch& m : matches(markdown, kBlock)) {
    if (m.str(1).find(part) != std::string::npos) return m[1];
  }
  return {};
}

void replace(std::string& text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  ASSERT_NE(at, std::string::npos) << "no \"" << from << "\" in:\n" << text;
  text.replace(at, from.size(), to);
}

/// Mean distance from the origin at each tick of a trajectory file.
std::map<long, double> mean_distances(const fs::path& csv) {
  std::map<long, std::pair<double, int>> sums;
  std::ifstream in(csv);
  std::string line;
  std::getline(in, line);  // the header
  while (std::getline(in, line)) {
    std::istringstream cells(line);
    std::vector<std::string> row;
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell);
    auto& [sum, count] = sums[std::stol(row.at(0))];
    sum += std::hypot(std::stod(row.at(3)), std::stod(row.at(4)));
    ++count;
  }
  std::map<long, double> means;
  for (const auto& [tick, s] : sums) means[tick] = s.first / s.second;
  return means;
}

TEST(Readme, ItsFirstControllerBuildsRunsAndDoesWhatItSays) {
  const std::string readme = text_of(kTop / "README.md");
  Folder folder;
  const auto blocks = named_blocks(readme);
  for (const char* name : {"seek_light.cpp", "CMakeLists.txt", "seek_light.xml"}) {
    ASSERT_TRUE(blocks.contains(name)) << name;
    folder.write(name, blocks.at(name));
  }
  // As printed, but for where the clone is, and for the launcher, which would build another preset than the one under
  // test.
  std::string commands = shell_block(readme, "-DTandem_DIR");
  replace(commands, "TANDEM=~/tandem", "TANDEM=" + kTop.string());
  replace(commands, "$TANDEM/tandem run", std::string(test::kBuildDir) + "/bin/tandem run");
  folder.write("commands.sh", commands);
  const std::string run = "cd '" + folder.path().string() + "' && sh -e commands.sh >log 2>&1 </dev/null";
  ASSERT_EQ(std::system(run.c_str()), 0) << text_of(folder.path() / "log");

  // The control interface is linked as it was built, and is neither shown nor looked for elsewhere.
  const std::string log = text_of(folder.path() / "log");
  EXPECT_EQ(matches(log, std::regex("Building CXX object")).size(), 1U) << log;
  const std::string module = "'" + (folder.path() / "build/libseek_light.so").string() + "'";
  for (const char* const symbols : {"nm -DC --defined-only ", "nm -DCu "}) {
    ASSERT_EQ(std::system((symbols + module + " >'" + (folder.path() / "symbols").string() + "'").c_str()), 0);
    EXPECT_EQ(text_of(folder.path() / "symbols").find("tandem::"), std::string::npos) << symbols;
  }

  EXPECT_NE(text_of(folder.path() / "end.svg").find("20 × e-puck"), std::string::npos);
  const auto distances = mean_distances(folder.path() / "poses.csv");
  ASSERT_EQ(distances.rbegin()->first, 399);
  EXPECT_GT(distances.at(0), 0.8);
  EXPECT_LT(distances.at(399), 0.3);
}

TEST(Hooks, TheirExampleBuildsRunsAndDoesWhatItSays) {
  const std::string page = text_of(kTop / "docs/hooks.md");
  Folder folder;
  const auto blocks = named_blocks(page);
  for (const char* name : {"crossing.cpp", "CMakeLists.txt", "crossing.xml"}) {
    ASSERT_TRUE(blocks.contains(name)) << name;
    folder.write(name, blocks.at(name));
  }
  std::string commands = shell_block(page, "-DTandem_DIR");
  replace(commands, "TANDEM=~/tandem", "TANDEM=" + kTop.string());
  replace(commands, "$TANDEM/tandem run", std::string(test::kBuildDir) + "/bin/tandem run");
  folder.write("commands.sh", commands);
  const std::string run = "cd '" + folder.path().string() + "' && sh -e commands.sh >log 2>&1 </dev/null";
  ASSERT_EQ(std::system(run.c_str()), 0) << text_of(folder.path() / "log");

  // The wall costs time, and the second trial starts again at tick 0.
  static const std::regex kTicks("without: ([0-9]+) ticks\nwith a wall: ([0-9]+) ticks\n");
  const std::string log = text_of(folder.path() / "log");
  std::smatch ticks;
  ASSERT_TRUE(std::regex_search(log, ticks, kTicks)) << log;
  EXPECT_GT(std::stol(ticks[1]), 300);  // 3.2 m at 10 cm/s and less
  EXPECT_GT(std::stol(ticks[2]), std::stol(ticks[1]));
  EXPECT_TRUE(fs::exists(folder.path() / "end.svg"));
}

TEST(RobotFiles, ItsRobotsRunAsPrinted) {
  const std::string page = text_of(kTop / "docs/robot-files.md");
  Folder folder;
  const auto blocks = named_blocks(page);
  for (const char* name : {"crabs.xml", "crabs_run.xml"}) {
    ASSERT_TRUE(blocks.contains(name)) << name;
    folder.write(name, blocks.at(name));
  }
  std::string commands = shell_block(page, "describe crab --in");
  for (std::size_t at = 0; (at = commands.find("./tandem ", at)) != std::string::npos;)
    commands.replace(at, 9, std::string(test::kBuildDir) + "/bin/tandem ");
  folder.write("commands.sh", commands);
  const std::string run = "cd '" + folder.path().string() + "' && sh -e commands.sh >log 2>&1 </dev/null";
  ASSERT_EQ(std::system(run.c_str()), 0) << text_of(folder.path() / "log");
  const std::string log = text_of(folder.path() / "log");
  for (const char* part : {"good: 2 kinds of robots: crab, old-crab", "robot <crab>: An invented robot on two wheels.",
                           "mount 11: bearing -30 deg", "(crabs.xml:17)"})
    EXPECT_NE(log.find(part), std::string::npos) << part << "\n" << log;
  EXPECT_NE(text_of(folder.path() / "crabs.svg").find("5 × old-crab"), std::string::npos);
}

TEST(RobotFiles, ShowsAKindAsTheProgramPrintsIt) {
  Folder folder;
  Tandem describe({"describe", "e-puck", "--xml"}, folder.path());
  ASSERT_EQ(describe.wait(), 0);
  EXPECT_NE(text_of(kTop / "docs/robot-files.md").find("```xml\n" + describe.output() + "```"), std::string::npos)
      << "print it anew: ./tandem describe e-puck --xml";
}

TEST(Controllers, TheirExampleBuildsRunsAndDoesWhatItSays) {
  const std::string page = text_of(kTop / "docs/controllers.md");
  Folder folder;
  const auto blocks = named_blocks(page);
  for (const char* name : {"scout.hpp", "scout.cpp", "lessons.cpp", "CMakeLists.txt", "scouts.xml"}) {
    ASSERT_TRUE(blocks.contains(name)) << name;
    folder.write(name, blocks.at(name));
  }
  std::string commands = shell_block(page, "-DTandem_DIR");
  replace(commands, "TANDEM=~/tandem", "TANDEM=" + kTop.string());
  replace(commands, "$TANDEM/tandem run", std::string(test::kBuildDir) + "/bin/tandem run");
  folder.write("commands.sh", commands);
  const std::string run = "cd '" + folder.path().string() + "' && sh -e commands.sh >log 2>&1 </dev/null";
  ASSERT_EQ(std::system(run.c_str()), 0) << text_of(folder.path() / "log");

  const std::string log = text_of(folder.path() / "log");
  std::vector<double> covered;
  static const std::regex kTrial("legs of [0-9.]+ s: ([0-9.]+)\n");
  for (const std::smatch& m : matches(log, kTrial)) covered.push_back(std::stod(m[1]));
  ASSERT_EQ(covered.size(), 3U) << log;
  EXPECT_LT(covered[0], covered[2]) << "longer legs cover more";
  const std::string report = text_of(folder.path() / "scouts.json");
  EXPECT_NEAR(std::stod(scenarios::json_value(report, "covered")), covered[2], 1e-4);
  const std::string picture = text_of(folder.path() / "scouts.svg");
  EXPECT_NE(picture.find("<polygon"), std::string::npos);
  EXPECT_TRUE(picture.find(">walk</text>") != std::string::npos || picture.find(">turn</text>") != std::string::npos);
}

TEST(Plugins, TheirPagesShowTheVerySourcesOfTheExamples) {
  std::map<std::string, std::string> shown = named_blocks(text_of(kTop / "docs/plugins.md"));
  shown.merge(named_blocks(text_of(kTop / "docs/plugin-examples.md")));
  int compared = 0;
  for (const auto& file : fs::directory_iterator(kTop / "examples/plugins")) {
    const std::string name = file.path().filename().string();
    ASSERT_TRUE(shown.contains(name)) << name << " is on neither page";
    EXPECT_EQ(shown.at(name), text_of(file.path())) << name;
    ++compared;
  }
  EXPECT_GT(compared, 15);
}

/// The words that follow "Subcommands:" or the options of a command, from the program's own help.
std::set<std::string> words_of_help(const std::vector<std::string>& arguments, const std::regex& pattern) {
  Folder folder;
  Tandem help(arguments, folder.path());
  EXPECT_EQ(help.wait(), 0) << help.errors();
  const std::string text = help.output();
  std::set<std::string> words;
  for (const std::smatch& m : matches(text, pattern)) words.insert(m[1]);
  return words;
}

TEST(Documents, NameOnlyCommandsAndOptionsThatExist) {
  static const std::regex kSubcommand("\n  ([a-z]+) ");
  static const std::regex kOption("(--[a-z]+)");
  static const std::regex kUse(R"(\./tandem ([a-z]+)([^`\n|]*))");
  const std::set<std::string> commands = words_of_help({"--help"}, kSubcommand);
  const std::set<std::string> of_launcher = {"test", "build", "format", "package", "python"};
  ASSERT_TRUE(commands.contains("run"));
  std::map<std::string, std::set<std::string>> options;
  int used = 0;
  for (const fs::path& file : documents()) {
    const std::string text = text_of(file);
    for (const std::smatch& use : matches(text, kUse)) {
      ++used;
      const std::string command = use[1];
      if (of_launcher.contains(command)) continue;
      EXPECT_TRUE(commands.contains(command)) << file << ": " << use.str();
      if (!commands.contains(command)) continue;
      if (!options.contains(command)) {
        options[command] = words_of_help({command, "--help"}, kOption);
        for (const char* word : {"new", "check"}) {
          if (command == "plugin") options[command].merge(words_of_help({command, word, "--help"}, kOption));
        }
      }
      const std::string rest = use[2];
      for (const std::smatch& option : matches(rest, kOption)) {
        EXPECT_TRUE(options[command].contains(option[1])) << file << ": " << use.str();
      }
    }
  }
  EXPECT_GT(used, 10);
}

TEST(Documents, OfTrackersNameEveryAttributeOfThem) {
  static const std::regex kAttribute("\n  ([a-z_]+)=\"");
  const std::string page = text_of(kTop / "docs/trackers.md");
  for (const char* tracker : {"udp", "lcm", "apriltag"}) {
    const std::set<std::string> attributes = words_of_help({"describe", tracker}, kAttribute);
    ASSERT_TRUE(attributes.contains("clock")) << tracker;
    for (const std::string& name : attributes) {
      const bool named = page.find("`" + name + "`") != std::string::npos ||
                         page.find("`" + name + "=") != std::string::npos ||
                         page.find(" " + name + "=\"") != std::string::npos;
      EXPECT_TRUE(named) << tracker << ": " << name;
    }
  }
}

TEST(Documents, LinkOnlyToWhatExists) {
  static const std::regex kLink(R"(\]\(([^)#:]+)\))");
  static const std::regex kFolder(R"(\| `([a-z_]+/)` \|)");
  int links = 0;
  for (const fs::path& file : documents()) {
    const std::string text = prose(text_of(file));
    for (const std::smatch& link : matches(text, kLink)) {
      ++links;
      EXPECT_TRUE(fs::exists(file.parent_path() / link.str(1))) << file << ": " << link.str(1);
    }
    for (const std::smatch& folder : matches(text, kFolder)) {
      EXPECT_TRUE(fs::is_directory(kTop / folder.str(1))) << file << ": " << folder.str(1);
    }
  }
  EXPECT_GT(links, 10);
}

TEST(Documents, StayWithinTheirWords) {
  EXPECT_EQ(std::system(("'" + (kTop / "scripts/doc-words").string() + "' --most 35000 >/dev/null").c_str()), 0);
}

TEST(Documents, ListEveryDecision) {
  const std::string list = text_of(kTop / "docs/decisions/README.md");
  for (const auto& page : fs::directory_iterator(kTop / "docs/decisions")) {
    const std::string name = page.path().filename().string();
    if (name == "README.md") continue;
    EXPECT_NE(list.find("(" + name + ")"), std::string::npos) << name;
  }
}

TEST(Documents, NameOnlyExperimentsThatExist) {
  static const std::regex kConfig(R"((configs/[a-z_0-9]+\.xml))");
  for (const fs::path& file : documents()) {
    const std::string text = text_of(file);
    for (const std::smatch& config : matches(text, kConfig)) {
      EXPECT_TRUE(fs::exists(kTop / config.str(1))) << file << ": " << config.str(1);
    }
  }
}

}  // namespace
}  // namespace tandem
