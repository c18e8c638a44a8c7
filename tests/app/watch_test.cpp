// `run --watch` on a pseudo-terminal, as a person sees and uses it; and its layout on screens of any size.
#include <gmock/gmock.h>
#include <regex>

#include "app/live/watch_page.hpp"
#include "app/real/real_robots.hpp"
#include "tests/app/pseudo_terminal.hpp"

namespace tandem {
namespace {

using scenarios::eventually;
using scenarios::Folder;
using scenarios::json_value;
using scenarios::OnTerminal;
using scenarios::Tandem;
using scenarios::text_of;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const std::string kConfigs = std::string(test::kSourceDir) + "/configs/";
const std::string kExperiment = kConfigs + "epuck_diffusion.xml";

/// A run without an end of its own, as fast as possible.
std::vector<std::string> endless(std::vector<std::string> more = {}) {
  std::vector<std::string> all = {
      "run", kExperiment, "--watch", "--set", "framework.experiment.length=0", "--set", "framework.time.mode=fast"};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

long tick_on(OnTerminal& run) {
  run.read_all();
  std::smatch found;
  const std::string text = run.screen.text();
  return std::regex_search(text, found, std::regex("tick ([0-9]+)")) ? std::stol(found[1]) : -1;
}

// --- on a terminal ---

TEST(Watch, ShowsTheRunAndEndsInOrderWithQ) {
  Folder folder;
  OnTerminal run(endless({"--report", "r.json"}), folder.path());
  ASSERT_TRUE(run.shows({"t = ", "real time", "50 e-puck", "no incidents", "robot", "ep0", "space pause"}))
      << run.screen.text() << run.screen.before;
  ASSERT_TRUE(eventually([&] { return tick_on(run) > 10; }, 20.0));
  EXPECT_FALSE(run.screen.cursor());
  run.type("q");
  EXPECT_EQ(run.wait(), 0);
  EXPECT_TRUE(run.restored());
  EXPECT_FALSE(run.screen.strange()) << "nothing but what every terminal knows, and no line too long";
  EXPECT_THAT(run.screen.before, HasSubstr("interrupted at tick"));
  EXPECT_EQ(json_value(text_of(folder.path() / "r.json"), "ended"), "interrupted");
}

TEST(Watch, KeysHoldTheRunStepItAndSetItsSpeed) {
  Folder folder;
  OnTerminal run(endless(), folder.path());
  ASSERT_TRUE(run.shows({"unpaced"})) << run.screen.before;
  run.type("-");
  ASSERT_TRUE(run.shows({"10 × real time asked"})) << run.screen.text();
  run.type("--");
  ASSERT_TRUE(run.shows({"2 × real time asked"})) << run.screen.text();
  run.type(" ");
  ASSERT_TRUE(run.shows({"paused"})) << run.screen.text();
  const long at = tick_on(run);
  for (int i = 1; i <= 3; ++i) {
    run.type(".");
    EXPECT_TRUE(run.shows({"tick " + std::to_string(at + i) + "  paused"})) << at << "\n" << run.screen.text();
  }
  run.type(" ");
  EXPECT_TRUE(eventually([&] { return tick_on(run) > at + 5; }, 20.0));
  run.type("+++");
  EXPECT_TRUE(run.shows({"unpaced"})) << run.screen.text();
  run.type("q");
  EXPECT_EQ(run.wait(), 0);
}

TEST(Watch, RunsInRealTimeUnlessTheFileOrTheCommandSaysElse) {
  Folder folder;
  const std::vector<std::string> words = {"run", kExperiment, "--watch", "--set", "framework.experiment.length=0"};
  OnTerminal run(words, folder.path());
  ASSERT_TRUE(run.shows({"1 × real time asked"})) << run.screen.text() << run.screen.before;
  run.type("q");
  EXPECT_EQ(run.wait(), 0);
  std::vector<std::string> faster = words;
  faster.insert(faster.end(), {"--speed", "5"});
  OnTerminal fast(faster, folder.path());
  ASSERT_TRUE(fast.shows({"5 × real time asked"})) << fast.screen.text();
  fast.type("q");
  EXPECT_EQ(fast.wait(), 0);
}

TEST(Watch, ShowsAMapOfTheArenaWhereThereIsRoom) {
  Folder folder;
  const auto file = folder.write("map.xml", R"(<tandem version="1">
  <framework><experiment length="0" ticks_per_second="10" random_seed="1"/><time mode="realtime"/></framework>
  <controllers><troublemaker id="t" library="test_trouble"><actuators><differential_steering/></actuators>
    <params what="throw" at="5"/></troublemaker></controllers>
  <arena size="4,2,1"><e-puck id="ep"><body position="-1.9,0.9,0"/><controller config="t"/></e-puck>
    <box id="b" size="0.2,2,0.5" movable="false"><body position="1.9,0,0"/></box></arena>
</tandem>)");
  OnTerminal run({"run", file.string(), "--watch"}, folder.path(), 60, 24);
  ASSERT_TRUE(run.shows({"+- 4 x 2 m ---", "| x ", "#|", "x  stopped", "#  fixed"})) << run.screen.text();
  EXPECT_THAT(run.screen.text(), Not(HasSubstr("movable"))) << "what is not there";
  run.resize(60, 9);
  EXPECT_TRUE(eventually(
      [&] {
        run.read_all();
        const std::string text = run.screen.text();
        return text.find("ep ") != std::string::npos && text.find("4 x 2 m") == std::string::npos;
      },
      10.0))
      << run.screen.text();
  run.type("q");
  EXPECT_EQ(run.wait(), 3);
  EXPECT_FALSE(run.screen.strange());

  Tandem lines({"run", file.string(), "--watch", "--seconds", "2", "--quiet"}, folder.path());
  EXPECT_EQ(lines.wait(), 3);
  EXPECT_THAT(lines.errors(), AllOf(HasSubstr("1 e-puck"), Not(HasSubstr("4 x 2 m")))) << "no terminal, no map";
}

TEST(Watch, ShowsARecordAsItShowsARun) {
  Folder folder;
  Tandem run({"run", kExperiment, "--seconds", "5", "--record", "r.record", "--set", "record.ports=proximity"},
             folder.path());
  ASSERT_EQ(run.wait(), 0) << run.errors();
  OnTerminal record({"view", "r.record", "--watch", "--watch-port", "proximity", "--no-browser", "--paused"},
                    folder.path());
  ASSERT_TRUE(record.shows({"tick 0  paused", "50 e-puck", "ep0", "no reading", "space pause"}))
      << record.screen.text() << record.screen.before;
  EXPECT_THAT(record.screen.text(), Not(HasSubstr("incidents"))) << "nobody has counted them";
  record.type("..");
  EXPECT_TRUE(record.shows({"tick 2  paused", "range"})) << record.screen.text();
  EXPECT_THAT(record.screen.text(), Not(HasSubstr("no reading")));
  record.type("/ep7\r");
  EXPECT_TRUE(
      eventually([&] { return tick_on(record) == 2 && record.screen.text().find("ep0 ") == std::string::npos; }, 20.0))
      << record.screen.text();
  record.type(" ");
  EXPECT_TRUE(record.shows({"tick 50  paused"})) << record.screen.text() << "at its end";
  record.type("q");
  EXPECT_EQ(record.wait(), 0);
  EXPECT_TRUE(record.restored());
  Tandem wrong({"view", "r.record", "--watch", "--watch-robots", "gina", "--no-browser"}, folder.path());
  EXPECT_EQ(wrong.wait(), 1);
  EXPECT_THAT(wrong.errors(), HasSubstr("no robot fits 'gina'"));
}

TEST(Watch, RobotsAndPortsAreChosenWhileItIsPausedToo) {
  Folder folder;
  OnTerminal run(endless({"--watch-robots", "ep1,ep2*", "--watch-port", "proximity"}), folder.path(), 160);
  ASSERT_TRUE(run.shows({"ep1 ", "ep25", "distance [", "] m"})) << run.screen.text() << run.screen.before;
  EXPECT_THAT(run.screen.text(), Not(HasSubstr("ep30")));
  run.type(" ");
  ASSERT_TRUE(run.shows({"paused"}));
  run.type("/ep30x\177 ep31\r");
  ASSERT_TRUE(run.shows({"ep30", "ep31"})) << run.screen.text();
  EXPECT_THAT(run.screen.text(), Not(HasSubstr("ep25")));
  run.type("\t");
  ASSERT_TRUE(run.shows({"actuator"})) << run.screen.text();
  run.type("/nobody\r");
  ASSERT_TRUE(run.shows({"no robot fits"})) << run.screen.text();
  run.type("/\r");
  ASSERT_TRUE(run.shows({"ep0 ", "(1 to "})) << run.screen.text();
  run.type("\033[6~");
  EXPECT_TRUE(eventually(
      [&] {
        run.read_all();
        return run.screen.text().find("ep0 ") == std::string::npos;
      },
      10.0));
  run.type("q");
  EXPECT_EQ(run.wait(), 0);
}

TEST(Watch, DrawsScreensOfAnySizeAnew) {
  Folder folder;
  OnTerminal run(endless(), folder.path(), 80, 24);
  ASSERT_TRUE(run.shows({"space pause"}));
  using Size = std::pair<int, int>;
  for (const Size& size : {Size{200, 60}, {40, 10}, {20, 5}, {100, 30}}) {
    run.resize(size.first, size.second);
    const auto drawn = [&] {
      run.read_all();
      return run.screen.line(0).find("epuck") == 0 &&
             (size.second < 6 || run.screen.text().find("ep0") != std::string::npos);
    };
    EXPECT_TRUE(eventually(drawn, 10.0)) << size.first << " × " << size.second << "\n" << run.screen.text();
  }
  run.type("q");
  EXPECT_EQ(run.wait(), 0);
}

TEST(Watch, LeavesTheTerminalAsItWasHoweverTheRunEnds) {
  for (const int signal : {SIGINT, SIGTERM}) {
    Folder folder;
    OnTerminal run(endless(), folder.path());
    ASSERT_TRUE(run.shows({"ep0"}));
    EXPECT_FALSE(run.restored());
    if (signal == SIGINT)
      run.type("\003");  // Ctrl-C
    else
      run.signal(signal);
    EXPECT_EQ(run.wait(), 128 + signal);
    EXPECT_TRUE(run.restored());
  }
}

TEST(Watch, ATerminalThatIsClosedEndsTheRunInOrder) {
  for (const bool watched : {true, false}) {
    Folder folder;
    std::vector<std::string> words = endless({"--report", "r.json", "--trajectory", "t.csv"});
    if (!watched) std::erase(words, "--watch");
    OnTerminal run(words, folder.path());
    ASSERT_TRUE(eventually(
        [&] {
          run.read_all();
          return text_of(folder.path() / "t.csv.part").size() > 10000;
        },
        60));
    run.hang_up();
    EXPECT_EQ(run.wait(60), 128 + SIGHUP);
    EXPECT_EQ(json_value(text_of(folder.path() / "r.json"), "ended"), "interrupted");
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "t.csv.part"));
  }
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they have handlers of their own
TEST(Watch, ACrashLeavesTheTerminalAsItWasAndIsTold) {
  Folder folder;
  const auto file = folder.write("trouble.xml", R"(<tandem version="1">
  <framework><experiment length="0" ticks_per_second="10" random_seed="1"/><time mode="realtime"/></framework>
  <controllers><troublemaker id="t" library="test_trouble"><actuators><differential_steering/></actuators>
    <params what="memory" at="40"/></troublemaker></controllers>
  <arena size="4,4,1"><e-puck id="ep"><body position="0,0,0"/><controller config="t"/></e-puck></arena>
</tandem>)");
  OnTerminal crashing({"run", file.string(), "--watch"}, folder.path());
  EXPECT_TRUE(crashing.shows({"ep "})) << crashing.screen.before;
  EXPECT_EQ(crashing.wait(), 3);
  EXPECT_TRUE(crashing.restored());
  EXPECT_THAT(crashing.screen.before, HasSubstr("crashed: SIGSEGV"));
}
#endif

TEST(Watch, CtrlZGivesTheTerminalBackAndFgGoesOn) {
  Folder folder;
  OnTerminal run(endless({"--set", "framework.time.mode=realtime"}), folder.path());
  ASSERT_TRUE(run.shows({"ep0"}));
  run.type("\032");
  ASSERT_TRUE(eventually([&] { return run.suspended(); }, 10.0));
  EXPECT_TRUE(run.restored());
  run.signal(SIGCONT);
  EXPECT_TRUE(run.shows({"ep0", "space pause"})) << "drawn anew";
  run.type("q");
  EXPECT_EQ(run.wait(), 0);
  EXPECT_TRUE(run.restored());
}

TEST(Watch, MessagesAreOnTheScreenAndAfterIt) {
  Folder folder;
  const auto file = folder.write("trouble.xml", R"(<tandem version="1">
  <framework><experiment length="0" ticks_per_second="10" random_seed="1"/><time mode="realtime"/></framework>
  <controllers><troublemaker id="t" library="test_trouble"><actuators><differential_steering/></actuators>
    <params what="throw" at="5"/></troublemaker></controllers>
  <arena size="4,4,1"><e-puck id="ep"><body position="0,0,0"/><controller config="t"/></e-puck></arena>
</tandem>)");
  OnTerminal run({"run", file.string(), "--watch"}, folder.path(), 120, 24);
  EXPECT_TRUE(run.shows({"incidents: 1 controllers stopped", "robot 'ep' threw at tick", "\\x1b[2J"}))
      << run.screen.text() << run.screen.before;
  run.type("q");
  EXPECT_EQ(run.wait(), 3);
  EXPECT_THAT(run.screen.before, HasSubstr("robot 'ep' threw at tick")) << "it is not lost with the screen";
}

TEST(Watch, UsesNoColorWhereNoneIsWanted) {
  Folder folder;
  OnTerminal run(endless(), folder.path(), 80, 24, {{"NO_COLOR", "1"}});
  ASSERT_TRUE(run.shows({"ep0"}));
  run.type("q");
  EXPECT_EQ(run.wait(), 0);
  EXPECT_FALSE(run.screen.colors());
}

TEST(Watch, RealRobotsHaveLinesOfTheirOwnAndArePaused) {
  Folder folder;
  scenarios::EmulatedEpuck epuck(folder);
  ASSERT_TRUE(epuck.ready());
  OnTerminal run({"run", kConfigs + "epuck_mixed.xml", "--watch"}, folder.path(), 120, 30);
  ASSERT_TRUE(run.shows({"ep0          drives    age", "round trip", "1 × real time asked"}))
      << run.screen.text() << run.screen.before;
  run.type(" ");
  EXPECT_TRUE(run.shows({"ep0          stands", "paused"})) << run.screen.text();
  run.type(" ");
  EXPECT_TRUE(run.shows({"ep0          drives"})) << run.screen.text();
  run.type("\032");
  ASSERT_TRUE(eventually([&] { return run.suspended(); }, 20.0));
  EXPECT_TRUE(run.restored()) << "it stops its robot first, then itself";
  run.signal(SIGCONT);
  EXPECT_TRUE(run.shows({"ep0 ", "age"})) << run.screen.text();
  epuck.signal(SIGSTOP);
  EXPECT_TRUE(run.shows({"ep0          stands"})) << run.screen.text();
  epuck.signal(SIGCONT);
  run.type("q");
  EXPECT_NE(run.wait(), -1000);
  EXPECT_TRUE(run.restored());
}

TEST(Watch, TheNewestMessagesAreShownHoweverManyThereWere) {
  Folder folder;
  folder.write("talk.lua", "function step() log('busy') end");
  const auto file = folder.write("talkative.xml", R"(<tandem version="1">
  <framework><experiment length="0" ticks_per_second="10" random_seed="1"/></framework>
  <controllers><lua_controller id="d"><actuators><differential_steering/></actuators><params script="talk.lua"/>
    </lua_controller></controllers>
  <arena size="2,2,1"><e-puck id="ep"><body position="0,0,0"/><controller config="d"/></e-puck></arena>
</tandem>)");
  OnTerminal run({"run", file.string(), "--watch", "--set", "framework.time.mode=realtime"}, folder.path(), 120, 24);
  ASSERT_TRUE(run.shows({"space pause"})) << run.screen.before;  // before, the terminal may edit what is typed
  run.type("++++");
  ASSERT_TRUE(run.shows({"unpaced"})) << run.screen.text();
  // The screen is not drawn at every tick: the newest message is of one of those that it has passed.
  const auto newest = [&] {
    run.read_all();
    const std::string text = run.screen.text();
    const std::string mark = "robot 'ep' at tick ";
    const std::size_t at = text.rfind(mark);
    std::smatch found;
    const std::string line = at == std::string::npos ? "" : text.substr(at, text.find('\n', at) - at);
    return std::regex_search(line, found, std::regex("at tick ([0-9]+): busy")) ? std::stol(found[1]) : -1;
  };
  ASSERT_TRUE(eventually([&] { return newest() >= 200; }, 20.0)) << run.screen.text() << run.screen.before;
  run.type("q");
  EXPECT_EQ(run.wait(), 0);
  const std::string left = run.screen.before;
  EXPECT_LE(std::count(left.begin(), left.end(), '\n'), 60);
  EXPECT_THAT(left, HasSubstr("more messages"));
}

// --- elsewhere ---

TEST(Watch, PrintsALineASecondWhereThereIsNoTerminal) {
  Folder folder;
  Tandem run(endless({"--set", "framework.time.mode=realtime"}), folder.path());
  EXPECT_TRUE(eventually(
      [&] {
        const std::string said = run.errors();
        return std::count(said.begin(), said.end(), '\n') >= 2;
      },
      20.0));
  run.signal(SIGINT);
  EXPECT_EQ(run.wait(), 130);
  EXPECT_THAT(run.errors(),
              AllOf(HasSubstr("t = "), HasSubstr("50 e-puck"), HasSubstr("no incidents"), Not(HasSubstr("\033"))));
}

TEST(Watch, ChangesNoBitOfTheRun) {
  Folder folder;
  const auto hash = [&](const std::string& report) {
    return json_value(text_of(folder.path() / report), "state_hash");
  };
  Tandem plain({"run", kExperiment, "--seconds", "30", "--report", "plain.json", "--quiet"}, folder.path());
  ASSERT_EQ(plain.wait(60.0), 0);
  OnTerminal watched({"run", kExperiment, "--seconds", "30", "--report", "watched.json", "--quiet", "--watch",
                      "--watch-port", "proximity", "--set", "framework.time.mode=fast"},
                     folder.path());
  watched.type(" ..- ++");
  ASSERT_EQ(watched.wait(60.0), 0) << watched.screen.before;
  EXPECT_FALSE(hash("plain.json").empty());
  EXPECT_EQ(hash("watched.json"), hash("plain.json"));
}

TEST(Watch, RefusesRobotsAndPortsThatAreNotThere) {
  Folder folder;
  const auto fails = [&](const std::vector<std::string>& more, int code, const std::string& part) {
    Tandem run(endless(more), folder.path());
    EXPECT_EQ(run.wait(), code);
    EXPECT_THAT(run.errors(), HasSubstr(part));
  };
  fails({"--watch-robots", "fb*"}, 1, "no robot fits 'fb*'");
  fails({"--watch-port", "proximty"}, 1, "took no port 'proximty'; they took: ");
  Tandem without({"run", kExperiment, "--watch-port", "proximity"}, folder.path());
  EXPECT_EQ(without.wait(), 2);
}

// --- the layout ---

app::WatchPage page_of(std::size_t robots) {
  app::WatchPage page;
  page.experiment = "a";
  page.moment.kinds = {{"e-puck", robots}};
  page.moment.chosen = robots;
  for (std::size_t i = 0; i < robots; ++i) {
    app::WatchMoment::Robot robot;
    robot.id = "ep" + std::to_string(i);
    robot.kind = "e-puck";
    robot.values = "mode search ↑";
    page.moment.robots.push_back(robot);
  }
  for (int i = 0; i < 10; ++i) page.messages.push_back("message " + std::to_string(i));
  return page;
}

TEST(WatchPage, HasExactlyAsManyLinesAsTheScreenAndTheKeysBeneath) {
  for (const std::size_t robots : {0U, 1U, 200U}) {
    const app::WatchPage page = page_of(robots);
    for (const std::size_t lines : {1U, 2U, 4U, 5U, 6U, 13U, 14U, 24U, 100U}) {
      const auto laid = app::lay_out(page, {80, lines});
      EXPECT_EQ(laid.size(), lines) << robots;
      EXPECT_THAT(laid.back().text, lines > 1 ? HasSubstr("q end") : HasSubstr("")) << lines;
      EXPECT_LE(app::rows_of(page, {80, lines}), lines);
    }
  }
}

TEST(WatchPage, ShowsRealRobotsAndWhyTheyStand) {
  app::WatchPage page = page_of(3);
  mixed_reality::RealRobotStatus gina, bert;
  gina.id = "gina";
  gina.trouble = "no answer";
  gina.state = "link lost";
  gina.reading_age_s = 1.5;
  gina.round_trip_s = 0.0123;
  bert.id = "bert";
  bert.driving = true;
  bert.state = "driving";
  bert.reading_age_s = 0.02;
  bert.battery = 0.5;
  page.moment.real = app::lines_of({gina, bert});
  page.moment.roll = {{"gina", core::Presence::Unreachable, "link lost"}, {"bert", core::Presence::Drives, ""}};
  std::string text;
  for (const auto& line : app::lay_out(page, {120, 24})) text += line.text + "\n";
  EXPECT_THAT(text, AllOf(HasSubstr("gina         stands    age   1500 ms  round trip  12.3 ms  link lost; no answer"),
                          HasSubstr("bert         drives    age     20 ms"), HasSubstr("battery  50 %")));
  EXPECT_THAT(app::summary(page),
              AllOf(HasSubstr("not reached, at rest before: gina (link lost)"), HasSubstr("drives: bert")));
}

TEST(WatchPage, CutsTextsByCharacters) {
  EXPECT_EQ(app::cut_to("abc", 3), "abc");
  EXPECT_EQ(app::cut_to("abcd", 3), "ab…");
  EXPECT_EQ(app::cut_to("äöüß", 3), "äö…");
  EXPECT_EQ(app::cut_to("äöü", 3), "äöü");
  EXPECT_EQ(app::cut_to("a", 0), "");
}

}  // namespace
}  // namespace tandem
