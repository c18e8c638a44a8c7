// Commands of the program and of plug-ins, as people, shells and manual pages see them.
#include <cstdlib>
#include <gmock/gmock.h>
#include <regex>
#include <set>

#include "tests/checkout.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem {
namespace {

using scenarios::Folder;
using scenarios::Tandem;
using scenarios::text_of;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

const fs::path kPlugins = fs::path(test::kBuildDir) / "tests" / "command_plugins";
const std::string kGood = kPlugins / "good" / "libtest_commands_good.so";
const std::string kSecond = kPlugins / "second" / "libtest_commands_second.so";
const std::string kFaulty = kPlugins / "faulty" / "libtest_commands_faulty.so";

class Commands : public testing::Test {
 protected:
  ~Commands() override { ::unsetenv("TANDEM_PLUGIN_PATH"); }
  /// Plug-ins of these folders are found without being named.
  static void find_in(const std::vector<std::string>& sets) {
    std::string path;
    for (const std::string& set : sets) path += (kPlugins / set).string() + ":";
    ::setenv("TANDEM_PLUGIN_PATH", path.c_str(), 1);
  }
  struct Ended {
    int code;
    std::string output, errors;
  };
  Ended run(const std::vector<std::string>& words) const {
    Tandem tandem(words, folder_.path());
    const int code = tandem.wait(60.0);
    return {code, tandem.output(), tandem.errors()};
  }
  /// What a shell's script prints.
  std::string shell(const std::string& name, const std::string& script) const {
    folder_.write("script", script);
    const std::string command = "cd '" + folder_.path().string() + "' && " + name + " script >printed 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0) << text_of(folder_.path() / "printed");
    return text_of(folder_.path() / "printed");
  }
  Folder folder_;
};

TEST_F(Commands, OfALibraryThatIsNamedTakeWordsAsTheyDescribeThem) {
  Ended done = run({"--plugin", kGood, "test_sum", "1", "2", "--times=2", "--how", "loud"});
  EXPECT_EQ(done.code, 0) << done.errors;
  EXPECT_EQ(done.output, "6!\n");
  done = run({"--plugin", kGood, "test_sum", "1", "--times", "3"});
  EXPECT_EQ(done.code, 2);
  EXPECT_THAT(done.errors, AllOf(HasSubstr("not in range 0.5"), HasSubstr("'tandem test_sum --help'")));
  EXPECT_THAT(run({"--plugin", kGood, "test_sum", "1", "--how", "loud"}).errors, HasSubstr("--times"));
  EXPECT_THAT(run({"--plugin", kGood, "test_sum", "--help"}).output,
              AllOf(HasSubstr("Add numbers."), HasSubstr("--how TEXT:{plain,loud}=plain Needs: --times")));
}

TEST_F(Commands, AndOptionsThatAreMistypedAreNamedWithWhatWasPerhapsMeant) {
  EXPECT_THAT(run({"rnu", "x.xml"}).errors, HasSubstr("there is no command 'rnu'. Did you mean 'run'?"));
  EXPECT_THAT(run({"run", "x.xml", "--sed", "5"}).errors,
              HasSubstr("there is no option '--sed'. Did you mean '--seed'?"));
  EXPECT_THAT(run({"run", "x.xml", "5"}).errors, HasSubstr("'5' is a word too many"));
  EXPECT_THAT(run({"desk", "http://here", "nonsense"}).errors,
              AllOf(HasSubstr("command: 'nonsense' is none of status, preflight, start"), Not(HasSubstr("{"))));
  EXPECT_THAT(run({"desk", "http://here", "pauze"}).errors, HasSubstr("Did you mean 'pause'?"));
}

TEST_F(Commands, OfThePluginFoldersAreFoundListedAndCompleted) {
  EXPECT_THAT(run({"test_sum", "1"}).errors, HasSubstr("there is no command 'test_sum'"));
  find_in({"good"});
  EXPECT_EQ(run({"test_sum", "4", "5"}).output, "9\n");
  EXPECT_THAT(run({"--help"}).output, AllOf(HasSubstr("Add numbers."), HasSubstr("Run an experiment.")));
  EXPECT_THAT(run({"list", "commands"}).output,
              AllOf(HasSubstr("test_sum"), HasSubstr("Add numbers. (libtest_commands_good.so)"),
                    HasSubstr("Build and run the whole test suite.")));
  EXPECT_THAT(run({"completion", "bash"}).output, HasSubstr("test_sum"));
}

TEST_F(Commands, AreListedUnderHeadings) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> groups = {
      {"Simulate", {"run", "check", "picture", "film", "view"}},
      {"Real robots", {"replay", "preflight", "desk", "robot", "inspect", "emulate", "calibrate"}},
      {"Study", {"compare", "export", "sweep", "plot", "fit", "gap"}},
      {"Extend", {"list", "describe", "plugin"}},
      {"Tools", {"upgrade", "completion", "man", "validate", "bench"}},
      {"Further commands", {"test_sum"}}};
  find_in({"good"});
  const std::string help = run({"--help"}).output;
  ASSERT_EQ(run({"man", "pages"}).code, 0);
  const std::string page = text_of(folder_.path() / "pages" / "tandem.1");
  std::size_t at = 0, on_page = 0;
  for (const auto& [heading, commands] : groups) {
    at = help.find("\n" + heading + ":\n", at);
    on_page = page.find(".SS " + heading + "\n", on_page);
    ASSERT_NE(at, std::string::npos) << heading << " in " << help;
    ASSERT_NE(on_page, std::string::npos) << heading << " in " << page;
    const std::string part = help.substr(at, help.find("\n\n", at + 1) - at);
    const std::string part_of_page = page.substr(on_page, page.find("\n.S", on_page + 1) - on_page);
    for (const std::string& command : commands) {
      EXPECT_THAT(part, HasSubstr("\n  " + command + " ")) << heading;
      EXPECT_THAT(part_of_page, HasSubstr("\n.BR tandem\\-" + command + " (1)")) << heading;
    }
  }
  EXPECT_THAT(help, Not(HasSubstr("Subcommands:"))) << "each stands under a heading";
  for (const char* command : {"build", "docs", "format", "package", "python", "test"})
    EXPECT_THAT(help.substr(help.find("The launcher")), HasSubstr(command));
}

TEST_F(Commands, OfOneNameAreRefusedWithBothFiles) {
  Ended twice = run({"--plugin", kSecond, "run", "x.xml"});
  EXPECT_EQ(twice.code, 1);
  EXPECT_THAT(twice.errors, AllOf(HasSubstr("registers the command 'run' a second time"), HasSubstr("tandem"),
                                  HasSubstr("libtest_commands_second.so")));
  find_in({"good", "faulty"});
  twice = run({"test_sum", "1"});
  EXPECT_EQ(twice.code, 1);
  EXPECT_THAT(twice.errors, AllOf(HasSubstr("'test_sum' a second time"), HasSubstr("libtest_commands_good.so"),
                                  HasSubstr("libtest_commands_faulty.so")));
  find_in({"second"});
  EXPECT_THAT(run({"run", "nowhere.xml"}).errors, AllOf(HasSubstr("nowhere.xml"), Not(HasSubstr("second"))))
      << "the program's own commands ask no folder";
}

TEST_F(Commands, ThatFailAreNamedAndEndWithThree) {
  const std::map<std::string, std::string> reasons = {
      {"test_throws", "it broke"}, {"test_fails", "no paper"}, {"test_odd", "77, which is no exit code"}};
  for (const auto& [name, reason] : reasons) {
    const Ended ended = run({"--plugin", kGood, name});
    EXPECT_EQ(ended.code, 3) << name;
    EXPECT_THAT(ended.errors, AllOf(HasSubstr("command '" + name + "' (library '"), HasSubstr(reason)));
  }
}

TEST_F(Commands, AreJudged) {
  EXPECT_EQ(run({"plugin", "check", kGood}).code, 0);
  const Ended faulty = run({"plugin", "check", kFaulty});
  EXPECT_EQ(faulty.code, 1);
  EXPECT_THAT(faulty.output, AllOf(HasSubstr("fault       command 'test_twice', line: "),
                                   HasSubstr("fault       command 'test_twice', documents: it has no summary")));
}

TEST_F(Commands, OfTheLauncherAreThoseThatItHas) {
  const std::string launcher = text_of(fs::path(test::kSourceDir) / "tandem");
  std::set<std::string> has, listed;
  const std::string cases = launcher.substr(launcher.rfind("case ${1:-} in"));
  static const std::regex kLabel("\n  ([a-z]+)\\)");
  for (std::sregex_iterator at(cases.begin(), cases.end(), kLabel), end; at != end; ++at) has.insert((*at)[1]);
  std::string output = run({"list", "commands"}).output;
  output = output.substr(output.find("commands of the launcher"));
  static const std::regex kListed("\n  ([a-z]+) ");
  for (std::sregex_iterator at(output.begin(), output.end(), kListed), end; at != end; ++at) listed.insert((*at)[1]);
  EXPECT_EQ(has, listed);
  const Ended test = run({"test"});
  EXPECT_EQ(test.code, 2);
  EXPECT_THAT(test.errors, HasSubstr("'test' is a command of the launcher"));
}

/// What bash offers behind these words, the last of which is being typed.
class BashCompletion : public Commands {
 protected:
  std::vector<std::string> offers(const std::vector<std::string>& words) {
    folder_.write("completion", run({"completion", "bash"}).output);
    std::string line;
    for (const std::string& word : words) line += " '" + word + "'";
    std::istringstream in(shell("bash", "set -u; . ./completion; COMP_WORDS=(tandem" + line +
                                            "); COMP_CWORD=" + std::to_string(words.size()) +
                                            "; _tandem; printf '%s\\n' \"${COMPREPLY[@]}\""));
    std::vector<std::string> all;
    for (std::string word; std::getline(in, word);) all.push_back(word);
    return all;
  }
};

TEST_F(BashCompletion, OffersCommandsOptionsChoicesNamesAndFiles) {
  EXPECT_THAT(offers({""}), AllOf(Contains("run"), Contains("plugin"), Contains("build"), Not(Contains("new"))));
  EXPECT_THAT(offers({"plugin", ""}), testing::UnorderedElementsAre("new", "check"));
  EXPECT_THAT(offers({"run", "--se"}), testing::UnorderedElementsAre("--seconds", "--seed", "--set"));
  EXPECT_THAT(offers({"plugin", "new", "x", "--kind", "en"}), testing::ElementsAre("engine"));
  EXPECT_THAT(offers({"plot", "t.sqlite", "--show", "=", "b"}), testing::ElementsAre("box"));
  EXPECT_THAT(offers({"bench", "--engine", "kinematics2d,dynamics3"}), testing::ElementsAre("kinematics2d,dynamics3d"));
  EXPECT_THAT(offers({"describe", "foot-b"}), testing::ElementsAre("foot-bot"));
  folder_.write("first run.xml", "");
  EXPECT_THAT(offers({"run", "--seed", "3", "fir"}), testing::ElementsAre("first run.xml"));
  EXPECT_THAT(offers({"desk", "http://x", "est"}), testing::ElementsAre("estop"));
}

TEST_F(Commands, ZshReadsItsCompletion) {
  folder_.write("completion", run({"completion", "zsh"}).output);
  EXPECT_EQ(shell("zsh -f", "autoload -U compinit && compinit -u -d ./dump && . ./completion && print $_comps[tandem]"),
            "_tandem\n");
}

TEST_F(Commands, HaveManualPagesWithoutFault) {
  ASSERT_EQ(run({"man", "pages"}).code, 0);
  int pages = 0;
  for (const auto& page : fs::directory_iterator(folder_.path() / "pages")) {
    ++pages;
    EXPECT_EQ(shell("bash", "mandoc -T lint -W error '" + page.path().string() + "'"), "") << page.path();
  }
  EXPECT_GT(pages, 35);
  EXPECT_THAT(text_of(folder_.path() / "pages/tandem-run.1"),
              AllOf(HasSubstr("\\fB\\-\\-threads\\fR \\fINUMBER\\fR"), HasSubstr("From 0 to 1024.")));
  EXPECT_THAT(text_of(folder_.path() / "pages/tandem.1"), HasSubstr(".BR tandem\\-plugin (1)"));
}

}  // namespace
}  // namespace tandem
