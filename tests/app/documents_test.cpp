// The documents tell the truth: their code builds and runs as printed, their commands, options and links exist.
#include <algorithm>
#include <atomic>
#include <cctype>
#include <cmath>
#include <gtest/gtest.h>
#include <map>
#include <regex>
#include <set>
#include <thread>

#include "tests/app/pages.hpp"
#include "tests/checkout.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem {
namespace {

using pages::Command;
using pages::documents;
using pages::named_blocks;
using pages::Page;
using scenarios::Folder;
using scenarios::Tandem;
using scenarios::text_of;
namespace fs = std::filesystem;

const fs::path kTop = test::kSourceDir;

std::vector<std::smatch> matches(const std::string& text, const std::regex& pattern) {
  return {std::sregex_iterator(text.begin(), text.end(), pattern), std::sregex_iterator()};
}

/// Without its code blocks.
std::string prose(const std::string& markdown) {
  static const std::regex kBlock("```[^`]*```");
  return std::regex_replace(markdown, kBlock, "");
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

/// That the control interface is linked as it was built, and is neither shown nor looked for elsewhere.
void check_light_seeker(const Page& page) {
  const std::string log = page.log();
  const std::string module = "'" + (page.folder() / "build/libseek_light.so").string() + "'";
  for (const char* const symbols : {"nm -DC --defined-only ", "nm -DCu "}) {
    const fs::path listed = page.folder() / "symbols";
    ASSERT_EQ(std::system((symbols + module + " >'" + listed.string() + "'").c_str()), 0);
    EXPECT_EQ(text_of(listed).find("tandem::"), std::string::npos) << symbols;
  }
  EXPECT_NE(text_of(page.folder() / "end.svg").find("20 × e-puck"), std::string::npos);
  const auto distances = mean_distances(page.folder() / "poses.csv");
  ASSERT_EQ(distances.rbegin()->first, 399);
  EXPECT_GT(distances.at(0), 0.8);
  EXPECT_LT(distances.at(399), 0.3);
}

/// That the wall costs time, and the second trial starts again at tick 0.
void check_hooks(const Page& page) {
  static const std::regex kTicks("without: ([0-9]+) ticks\nwith a wall: ([0-9]+) ticks\n");
  const std::string log = page.log();
  std::smatch ticks;
  ASSERT_TRUE(std::regex_search(log, ticks, kTicks)) << log;
  EXPECT_GT(std::stol(ticks[1]), 300);  // 3.2 m at 10 cm/s and less
  EXPECT_GT(std::stol(ticks[2]), std::stol(ticks[1]));
  EXPECT_TRUE(fs::exists(page.folder() / "end.svg"));
}

void check_robot_files(const Page& page) {
  const std::string log = page.log();
  for (const char* part : {"good: 2 kinds of robots: crab, old-crab", "robot <crab>: An invented robot on two wheels.",
                           "mount 11: bearing -30 deg", "(crabs.xml:17)"})
    EXPECT_NE(log.find(part), std::string::npos) << part << "\n" << log;
  EXPECT_NE(text_of(page.folder() / "crabs.svg").find("5 × old-crab"), std::string::npos);
}

void check_controllers(const Page& page) {
  const std::string log = page.log();
  std::vector<double> covered;
  static const std::regex kTrial("legs of [0-9.]+ s: ([0-9.]+)\n");
  for (const std::smatch& m : matches(log, kTrial)) covered.push_back(std::stod(m[1]));
  ASSERT_EQ(covered.size(), 3U) << log;
  EXPECT_LT(covered[0], covered[2]) << "longer legs cover more";
  const std::string report = text_of(page.folder() / "scouts.json");
  EXPECT_NEAR(std::stod(scenarios::json_value(report, "covered")), covered[2], 1e-4);
  const std::string picture = text_of(page.folder() / "scouts.svg");
  EXPECT_NE(picture.find("<polygon"), std::string::npos);
  EXPECT_TRUE(picture.find(">walk</text>") != std::string::npos || picture.find(">turn</text>") != std::string::npos);
}

/// What must have come of a page's commands, besides that they went well.
const std::map<std::string, void (*)(const Page&)> kChecks = {{"tutorial.md", check_light_seeker},
                                                              {"hooks.md", check_hooks},
                                                              {"robot-files.md", check_robot_files},
                                                              {"controllers.md", check_controllers}};

std::vector<fs::path> pages_with_commands() {
  std::vector<fs::path> pages = documents();
  std::erase_if(pages, [](const fs::path& page) {
    return std::ranges::none_of(pages::commands_of(text_of(page)),
                                [](const Command& c) { return c.kind == Command::Kind::Typed; });
  });
  return pages;
}

/// Pages mostly wait for programs, so those of the tests that will run are done side by side before the first of them.
class Pages : public testing::TestWithParam<fs::path> {
 protected:
  static void SetUpTestSuite() {
    const testing::TestSuite& suite = *testing::UnitTest::GetInstance()->current_test_suite();
    const std::vector<fs::path> all = pages_with_commands();
    std::vector<fs::path> chosen;
    for (int i = 0; i < suite.total_test_count(); ++i) {
      if (suite.GetTestInfo(i)->should_run()) chosen.push_back(all.at(static_cast<std::size_t>(i)));
    }
    for (const fs::path& page : chosen) done_.try_emplace(page, page);
    std::atomic<std::size_t> next = 0;
    std::vector<std::thread> workers;
    const bool apart = std::system("unshare -n true 2>/dev/null") == 0;  // else pages would share the default ports
    for (int i = 0; i < (apart ? 4 : 1); ++i) {
      workers.emplace_back([&] {
        for (std::size_t n = 0; (n = next++) < chosen.size();) done_.at(chosen[n]).run();
      });
    }
    for (std::thread& worker : workers) worker.join();
  }
  static std::map<fs::path, Page> done_;
};
std::map<fs::path, Page> Pages::done_;

TEST_P(Pages, CommandsRunAsPrinted) {
  const Page& page = done_.at(GetParam());
  ASSERT_EQ(page.failed(), "") << page.log();
  const auto check = kChecks.find(GetParam().filename().string());
  if (check != kChecks.end()) check->second(page);
}

INSTANTIATE_TEST_SUITE_P(Documents, Pages, testing::ValuesIn(pages_with_commands()), [](const auto& page) {
  std::string name = pages::name_of(page.param);
  std::ranges::replace_if(
      name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
  return name;
});

TEST(Documents, RunAllCommandsButAFew) {
  int not_run = 0;
  for (const fs::path& page : documents()) {
    for (const Command& command : pages::commands_of(text_of(page))) {
      EXPECT_NE(command.kind, Command::Kind::Astray) << page << ":" << command.line << ": not in a block `sh`:\n"
                                                     << command.text;
      if (command.kind != Command::Kind::NotRun) continue;
      EXPECT_NE(command.text, "") << page << ":" << command.line << ": no reason";
      ++not_run;
    }
  }
  EXPECT_LE(not_run, 15);
}

TEST(RobotFiles, ShowsAKindAsTheProgramPrintsIt) {
  Folder folder;
  Tandem describe({"describe", "e-puck", "--xml"}, folder.path());
  ASSERT_EQ(describe.wait(), 0);
  EXPECT_NE(text_of(kTop / "docs/robot-files.md").find("```xml\n" + describe.output() + "```"), std::string::npos)
      << "print it anew: ./tandem describe e-puck --xml";
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

/// The commands, or the options of a command, from the program's own help.
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
  const std::set<std::string> of_launcher = {"test", "build", "docs", "format", "package", "python"};
  ASSERT_TRUE(commands.contains("run"));
  std::map<std::string, std::set<std::string>> options;
  int used = 0;
  for (const fs::path& file : documents()) {
    const std::string text = text_of(file);
    for (const std::smatch& use : matches(text, kUse)) {
      ++used;
      const std::string command = use[1];
      if (of_launcher.contains(command) || command == "emulate") continue;  // emulators have options of their own
      EXPECT_TRUE(commands.contains(command)) << file << ": " << use.str();
      if (!commands.contains(command)) continue;
      if (!options.contains(command)) {
        options[command] = words_of_help({command, "--help"}, kOption);
        const std::vector<std::string> further = command == "plugin" ? std::vector<std::string>{"new", "check"}
                                                 : command == "calibrate"
                                                     ? std::vector<std::string>{"board", "camera", "arena"}
                                                     : std::vector<std::string>{};
        for (const std::string& word : further)
          options[command].merge(words_of_help({command, word, "--help"}, kOption));
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

/// A page's headings as links name them.
std::set<std::string> anchors_of(const fs::path& page) {
  static const std::regex kHeading("(^|\n)#+ ([^\n]*)");
  const std::string text = prose(text_of(page));
  std::set<std::string> anchors;
  for (const std::smatch& heading : matches(text, kHeading)) {
    std::string anchor;
    for (const char c : heading.str(2)) {
      if (c == ' ' || c == '-' || c == '_' || std::isalnum(static_cast<unsigned char>(c)) != 0)
        anchor += c == ' ' ? '-' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    anchors.insert(anchor);
  }
  return anchors;
}

TEST(Documents, LinkOnlyToWhatExists) {
  static const std::regex kLink(R"(\]\(([^)#:]*)(#([^)]+))?\))");
  static const std::regex kFolder(R"(\| `([a-z_]+/)` \|)");
  int links = 0;
  for (const fs::path& file : documents()) {
    const std::string text = prose(text_of(file));
    for (const std::smatch& link : matches(text, kLink)) {
      ++links;
      const fs::path to = link.str(1).empty() ? file : file.parent_path() / link.str(1);
      EXPECT_TRUE(fs::exists(to)) << file << ": " << link.str(1);
      if (link[3].matched && to.extension() == ".md") {
        EXPECT_TRUE(anchors_of(to).contains(link.str(3))) << file << ": " << link.str(1) << link.str(2);
      }
    }
    for (const std::smatch& folder : matches(text, kFolder)) {
      EXPECT_TRUE(fs::is_directory(kTop / folder.str(1))) << file << ": " << folder.str(1);
    }
  }
  EXPECT_GT(links, 10);
}

TEST(Documents, StayWithinTheirWords) {
  EXPECT_EQ(std::system(("'" + (kTop / "scripts/doc-words").string() + "' --most 37000 >/dev/null").c_str()), 0);
}

TEST(Documents, AreAllReachedFromTheFirst) {
  static const std::regex kLink(R"(\]\(([^)#:]+\.md)(#[^)]*)?\))");
  std::vector<fs::path> todo = {kTop / "README.md"};
  std::set<fs::path> reached;
  while (!todo.empty()) {
    const fs::path page = todo.back();
    todo.pop_back();
    if (!reached.insert(page).second) continue;
    const std::string text = text_of(page);
    for (const std::smatch& link : matches(text, kLink))
      todo.push_back((page.parent_path() / link.str(1)).lexically_normal());
  }
  for (const fs::path& page : documents()) EXPECT_TRUE(reached.contains(page)) << page;
}

TEST(Documents, MakeASiteWithoutADeadLink) {
  for (const char* const program : {"/usr/bin/mkdocs", "/usr/bin/doxygen"}) {
    if (!fs::exists(program)) GTEST_SKIP() << program << " is not here";
  }
  Folder folder;
  const std::string site = (folder.path() / "site").string();
  const std::string make = "/usr/bin/python3 '" + (kTop / "scripts/site").string() + "' '" + test::kBuildDir +
                           "/bin/tandem' '" + site + "' >'" + (folder.path() / "log").string() + "' 2>&1";
  ASSERT_EQ(std::system(make.c_str()), 0) << text_of(folder.path() / "log");
  for (const char* const page : {"index.html", "tutorial.html", "parts/robots.html", "interface/index.html"})
    EXPECT_TRUE(fs::exists(fs::path(site) / page)) << page;
  EXPECT_NE(text_of(fs::path(site) / "parts/robots.html").find("A small robot on two wheels"), std::string::npos);
  EXPECT_NE(text_of(fs::path(site) / "search/search_index.json").find("foot-bot"), std::string::npos);
}

TEST(Documents, NameTheVersionThatItIs) {
  Folder folder;
  Tandem tandem({"--version"}, folder.path());
  ASSERT_EQ(tandem.wait(), 0);
  const std::string version = tandem.output().substr(0, tandem.output().find_first_of(" \n"));
  EXPECT_NE(text_of(kTop / "CITATION.cff").find("\nversion: " + version + "\n"), std::string::npos) << version;
  EXPECT_NE(text_of(kTop / "CHANGELOG.md").find("\n## " + version + "\n"), std::string::npos) << version;
}

/// Words of messages in the first column of a table.
TEST(Faq, QuotesMessagesThatThereAre) {
  static const std::regex kQuoted("\n\\| `([^`]+)` \\|");
  std::string sources = text_of(kTop / "tandem");
  for (const char* folder : {"app", "bridges", "controllers", "core", "hal", "mixed_reality", "study", "window"}) {
    for (const auto& entry : fs::recursive_directory_iterator(kTop / folder)) {
      if (entry.path().extension() == ".cpp" || entry.path().extension() == ".js") sources += text_of(entry.path());
    }
  }
  const std::string page = text_of(kTop / "docs/faq.md");
  int quoted = 0;
  for (const std::smatch& message : matches(page, kQuoted)) {
    ++quoted;
    EXPECT_NE(sources.find(message.str(1)), std::string::npos) << message.str(1);
  }
  EXPECT_GT(quoted, 20);
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
