// How runs end: as they should, and when a plug-in takes the program down with it or never returns.
#include <gmock/gmock.h>
#include <map>
#include <sstream>

#include "tests/checkout.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem {
namespace {

using scenarios::eventually;
using scenarios::Folder;
using scenarios::json_value;
using scenarios::Tandem;
using scenarios::text_of;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr int kRobots = 12;

struct Experiment {
  std::string library = "test_trouble";
  std::string label = "troublemaker";
  std::string params = {};
  std::string hook = {};
  int length_s = 2;
  std::string record = {};
};

std::string text(const Experiment& e) {
  return R"(<tandem>
  <framework><experiment length=")" +
         std::to_string(e.length_s) + R"(" ticks_per_second="10" random_seed="7"/></framework>
  <controllers>
    <)" + e.label +
         R"( id="who" library=")" + e.library + R"(">
      <actuators><differential_steering/></actuators>
      <params )" +
         e.params + R"(/>
    </)" +
         e.label +
         R"(>
  </controllers>
  )" + e.hook +
         R"(
  <arena size="4,4,1">
    <distribute>
      <position method="uniform" min="-1,-1,0" max="1,1,0"/>
      <orientation method="uniform" min="0,0,0" max="360,0,0"/>
      <entity quantity="12" max_trials="1000"><e-puck id="ep"><controller config="who"/></e-puck></entity>
    </distribute>
  </arena>
  )" + e.record +
         R"(
</tandem>
)";
}

class Endings : public testing::Test {
 protected:
  std::unique_ptr<Tandem> start(const Experiment& e, const std::vector<std::string>& more = {}) {
    folder_.write("e.xml", text(e));
    folder_.write("t.csv", "old");
    std::vector<std::string> words = {"run", "e.xml", "--report", "r.json", "--trajectory", "t.csv"};
    words.insert(words.end(), more.begin(), more.end());
    return std::make_unique<Tandem>(words, folder_.path());
  }
  std::string report() const { return text_of(folder_.path() / "r.json"); }
  std::string value(const std::string& key) const { return json_value(report(), key); }

  /// Ticks of the trajectory, each of which must have one line for every robot.
  int whole_ticks() const {
    std::istringstream in(text_of(folder_.path() / "t.csv"));
    std::map<int, int> lines;
    std::string line;
    std::getline(in, line);
    EXPECT_EQ(line, "tick,time_s,id,x_m,y_m,z_m,heading_rad");
    while (std::getline(in, line)) {
      EXPECT_EQ(std::count(line.begin(), line.end(), ','), 6) << line;
      ++lines[std::stoi(line)];
    }
    for (const auto& [tick, count] : lines) EXPECT_EQ(count, kRobots) << "tick " << tick;
    return static_cast<int>(lines.size());
  }
  /// Lines of the trajectory while it grows.
  int whole_ticks_so_far() const {
    const std::string all = text_of(folder_.path() / "t.csv.part");
    return static_cast<int>(std::count(all.begin(), all.end(), '\n')) / kRobots;
  }
  /// Of a run that a plug-in ended before the records of tick `tick`.
  void expect_saved(int tick, const std::string& failure) const {
    EXPECT_EQ(value("finished"), "false") << report();
    EXPECT_EQ(value("ended"), "failed");
    EXPECT_THAT(report(), HasSubstr(failure));
    EXPECT_EQ(value("experiment"), "e");
    EXPECT_THAT(report(), testing::EndsWith("}\n"));
    EXPECT_EQ(whole_ticks(), tick);
    EXPECT_FALSE(scenarios::fs::exists(folder_.path() / "t.csv.part"));
    EXPECT_FALSE(scenarios::fs::exists(folder_.path() / "r.json.part"));
  }

  Folder folder_;
};

TEST_F(Endings, ARunThatCameToItsEndSaysSo) {
  auto run = start({});
  ASSERT_EQ(run->wait(), 0) << run->errors();
  EXPECT_EQ(value("finished"), "true");
  EXPECT_EQ(value("ended"), "length");
  EXPECT_EQ(whole_ticks(), 20);
}

TEST_F(Endings, ARunThatAHookEndedSaysSo) {
  auto run = start({.hook = R"(<loop_functions library="test_hooks" label="diary" path="diary" done_at="7"/>)"});
  ASSERT_EQ(run->wait(), 0) << run->errors();
  EXPECT_EQ(value("finished"), "true");
  EXPECT_EQ(value("ended"), "hook");
  EXPECT_THAT(run->output(), HasSubstr("by a hook at tick 7 of 20"));
}

TEST_F(Endings, AHookThatThrowsEndsTheRunAsFailed) {
  auto run = start({.hook = R"(<loop_functions library="test_hooks" label="diary" path="diary" throw_at="7"/>)"});
  EXPECT_EQ(run->wait(), 3);
  EXPECT_EQ(value("finished"), "false");
  EXPECT_EQ(value("ended"), "failed");
  EXPECT_THAT(run->output(), HasSubstr("not finished"));
}

TEST_F(Endings, EverySignalThatAsksForTheEndEndsItInOrder) {
  for (const int signal : {SIGHUP, SIGQUIT, SIGXCPU, SIGALRM, SIGTERM, SIGINT}) {
    auto run = start({.length_s = 100000}, {"--set", "framework.time.mode=realtime"});  // faster, robots would get away
    ASSERT_TRUE(eventually([&] { return whole_ticks_so_far() > 3; }, 60)) << run->errors();
    run->signal(signal);
    EXPECT_EQ(run->wait(60), 128 + signal) << run->errors();
    EXPECT_EQ(value("ended"), "interrupted") << signal;
    EXPECT_GT(whole_ticks(), 3);
    EXPECT_FALSE(scenarios::fs::exists(folder_.path() / "r.json.part"));
  }
}

TEST_F(Endings, AControllerThatThrewIsNoSuccess) {
  auto run = start({.params = R"(what="throw" robot="ep4")"});
  EXPECT_EQ(run->wait(), 3);
  EXPECT_EQ(value("finished"), "false");
  EXPECT_EQ(value("ended"), "failed");
  EXPECT_THAT(report(), HasSubstr("a controller threw, and the run went on without its robot; the first incident: "
                                  "controller of robot 'ep4' threw at tick 3"));
  EXPECT_EQ(value("controllers_thrown"), "1");
  EXPECT_EQ(whole_ticks(), 20);
  EXPECT_THAT(run->errors(),
              AllOf(HasSubstr("robot 'ep4' threw at tick 3"), HasSubstr("\\x1b[2J"), HasSubstr(" gone")));
  EXPECT_THAT(run->errors() + run->output(), Not(HasSubstr("\033")));
}

TEST_F(Endings, AMessageOfAnyLengthIsCut) {
  auto run = start({.params = R"(what="long" robot="ep4")"}, {"--log", "run.log"});
  EXPECT_EQ(run->wait(), 3);
  EXPECT_LT(run->errors().size(), 20'000U);
  EXPECT_LT(report().size(), 50'000U);
  EXPECT_LT(text_of(folder_.path() / "run.log").size(), 20'000U);
  EXPECT_THAT(report(), HasSubstr("20000003 bytes in all"));
}

TEST_F(Endings, NoMessageForgesALineOfTheLogOrTurnsTheTerminal) {
  auto run = start({.params = R"(what="forge" robot="ep4")"}, {"--log", "run.log"});
  EXPECT_EQ(run->wait(), 3);
  for (const std::string& text : {run->errors(), text_of(folder_.path() / "run.log")}) {
    EXPECT_THAT(text, HasSubstr("    error: the arena burns"));
    EXPECT_EQ(text.find("\nerror: the arena burns"), std::string::npos) << text;
    EXPECT_EQ(text.find("\u202E"), std::string::npos);
    EXPECT_THAT(text, HasSubstr("\\u202eback"));
  }
}

TEST_F(Endings, AnObserverThatFailsIsNamedOnceAndTheRunGoesOn) {
  for (const std::string what : {"fail", "throw"}) {
    auto run = start({.hook = "<plugins library=\"test_trouble\"/>",
                      .record = "<record><onlooker what=\"" + what + "\"/></record>"});
    EXPECT_EQ(run->wait(), 3);
    EXPECT_EQ(value("finished"), "true");
    EXPECT_EQ(whole_ticks(), 20);
    const std::string errors = run->errors();
    const std::string who = "error: observer 'onlooker' (library '";
    ASSERT_THAT(errors, AllOf(HasSubstr(who), HasSubstr(what == "fail" ? "cannot bear to look" : "threw: "),
                              HasSubstr("the run goes on without it")));
    EXPECT_EQ(errors.find(who), errors.rfind(who)) << errors;
  }
  auto early = start({.hook = "<plugins library=\"test_trouble\"/>",
                      .record = "<record><onlooker what=\"throw\" early=\"true\"/></record>"});
  EXPECT_EQ(early->wait(), 1);
  EXPECT_THAT(early->errors(), HasSubstr("e.xml:17: error:"));
}

TEST_F(Endings, ACrashOfAnObserverNamesIt) {
  auto run =
      start({.hook = "<plugins library=\"test_trouble\"/>", .record = "<record><onlooker what=\"memory\"/></record>"});
  EXPECT_EQ(run->wait(), 3);
  EXPECT_THAT(run->errors(), HasSubstr("observer 'onlooker' (library '"));
}

TEST_F(Endings, APartOfARunThatFailsIsNamedAndTheOthersFinish) {
  const auto with = [](const std::string& what) {
    return Experiment{.hook = "<plugins library=\"test_trouble\"/>",
                      .record = "<run><joiner what=\"" + what + "\" at=\"5\"/></run>"};
  };
  for (const std::string what : {"before", "throw", "finish"}) {
    auto run = start(with(what));
    EXPECT_EQ(run->wait(), 3) << what;
    EXPECT_EQ(whole_ticks(), what == "finish" ? 20 : 5) << "what was written until then stays";
    EXPECT_THAT(run->errors(), HasSubstr("error: part 'joiner', "));
    EXPECT_EQ(value("ended"), "failed");
    EXPECT_THAT(value("failure"), HasSubstr("part 'joiner'"));
  }
  auto join = start(with("join"));
  EXPECT_EQ(join->wait(), 3);
  EXPECT_THAT(join->errors(), HasSubstr("error: part 'joiner', join: will not join"));
  auto crash = start(with("memory"));
  EXPECT_EQ(crash->wait(), 3);
  EXPECT_THAT(crash->errors(), HasSubstr("part 'joiner' (library '"));
}

TEST_F(Endings, APartMayEndARun) {
  auto run = start({.hook = "<plugins library=\"test_trouble\"/>"},
                   {"--set", "run.joiner.what=end", "--set", "run.joiner.at=7"});
  EXPECT_EQ(run->wait(), 0) << run->errors();
  EXPECT_EQ(value("ended"), "part");
  EXPECT_EQ(value("finished"), "true");
  EXPECT_EQ(whole_ticks(), 7);
  EXPECT_THAT(run->output(), HasSubstr("by a part at tick 7 of 20"));
}

TEST_F(Endings, ASpeedThatIsHardlyMeantAsksForItsUnitOnce) {
  auto run = start({.library = "test_controllers", .label = "drive", .params = R"(left="20" right="20")"});
  EXPECT_EQ(run->wait(), 0);
  const std::string said = run->errors();
  EXPECT_THAT(said, AllOf(HasSubstr("commanded 20 m/s at tick 0"), HasSubstr("did you mean cm/s?")));
  EXPECT_EQ(said.find("did you mean"), said.rfind("did you mean")) << said;
  EXPECT_THAT(report(), HasSubstr("did you mean cm/s?"));
}

TEST_F(Endings, ASpeedThatARobotCannotDriveIsNamedWithWhatItCanOnce) {
  auto run = start({.library = "test_controllers", .label = "drive", .params = R"(left="0.2" right="0.2")"});
  EXPECT_EQ(run->wait(), 0);
  const std::string said = run->errors();
  EXPECT_THAT(said,
              AllOf(HasSubstr("commanded 0.2 m/s at tick 0, where 0.1"), HasSubstr("a parameter without a unit")));
  EXPECT_EQ(said.find("commanded"), said.rfind("commanded")) << said;
  EXPECT_EQ(said.find("did you mean cm/s?"), std::string::npos) << said;
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they have handlers of their own
TEST_F(Endings, ACrashNamesControllerRobotAndTickAndKeepsTheRecords) {
  const std::map<std::string, std::string> kinds = {
      {"memory", "SIGSEGV"},         {"divide", "SIGFPE"},
      {"abort", "SIGABRT"},          {"instruction", "SIGILL"},
      {"stack", "SIGSEGV"},          {"exit", "called exit(0)"},
      {"quick_exit", "called exit"}, {"noexcept", "lost in \\x1b[2Jspace"},
      {"_exit", "called _exit(0)"},  {"_Exit", "called _exit(0)"}};
  for (const auto& [what, word] : kinds) {
    auto run = start({.params = "what=\"" + what + "\" robot=\"ep4\""});
    EXPECT_EQ(run->wait(), 3) << what;
    EXPECT_THAT(run->errors(), AllOf(HasSubstr("error: controller 'who' (library 'test_trouble') of robot 'ep4'"),
                                     HasSubstr("at tick 3"), HasSubstr(word)));
    expect_saved(3, "of robot 'ep4' at tick 3");
  }
}

TEST_F(Endings, AnImmediateExitOnAThreadOfAPluginsOwnIsNoEndWithoutAWord) {
  auto run = start({.params = R"(what="_exit on a thread" robot="ep4")"});
  EXPECT_EQ(run->wait(), 3);
  EXPECT_THAT(run->errors(), HasSubstr("called _exit(0)"));
  expect_saved(3, "called _exit(0)");
}

TEST_F(Endings, AChildOfAPluginMayExitAsItLikes) {
  auto run = start({.params = R"(what="child" robot="ep4")"});
  EXPECT_EQ(run->wait(), 0) << run->errors();
  EXPECT_EQ(value("finished"), "true");
}

TEST_F(Endings, ACrashOnAnotherThreadIsNamedToo) {
  std::string experiment = text({.params = R"(what="stack" robot="ep4100")"});
  experiment.replace(experiment.find("quantity=\"12\""), 13, "quantity=\"4200\"");
  experiment.replace(experiment.find("size=\"4,4,1\""), 12, "size=\"44,44,1\"");
  experiment.replace(experiment.find("min=\"-1,-1,0\" max=\"1,1,0\""), 25, "min=\"-20,-20,0\" max=\"20,20,0\"");
  folder_.write("e.xml", experiment);
  Tandem run({"run", "e.xml", "--threads", "3", "--report", "r.json"}, folder_.path());
  EXPECT_EQ(run.wait(), 3);
  EXPECT_THAT(run.errors(), AllOf(HasSubstr("of robot 'ep4100' at tick 3"), HasSubstr("SIGSEGV")));
  EXPECT_EQ(value("finished"), "false");
}

TEST_F(Endings, AThreadOfAPluginThatThrowsIsNoFaultOfTheProgram) {
  auto run = start({.params = R"(what="thread" robot="ep4")"});
  EXPECT_EQ(run->wait(), 3);
  EXPECT_THAT(run->errors(),
              AllOf(HasSubstr("error: plug-in 'libtest_trouble.so', on a thread of its own, threw where"),
                    HasSubstr("lost in \\x1b[2Jspace")));
  EXPECT_EQ(value("ended"), "failed");
}

TEST_F(Endings, ACrashOfAHookNamesItAndItsMoment) {
  auto run = start({.hook = R"(<loop_functions library="test_trouble" label="trouble" what="memory" at="5"/>)"});
  EXPECT_EQ(run->wait(), 3);
  EXPECT_THAT(run->errors(),
              HasSubstr("error: hook 'trouble' (library 'test_trouble') in after_step at tick 5 crashed"));
  expect_saved(5, "in after_step at tick 5");
}

TEST_F(Endings, ACrashBeforeTheFirstTickIsNamed) {
  auto controller = start({.params = R"(what="memory" early="true" robot="ep4")"});
  EXPECT_EQ(controller->wait(), 3);
  EXPECT_THAT(controller->errors(), HasSubstr("of robot 'ep4', while it was made, crashed: SIGSEGV"));
  auto hook = start({.hook = R"(<loop_functions library="test_trouble" label="trouble" what="exit" early="true"/>)"});
  EXPECT_EQ(hook->wait(), 3);
  EXPECT_THAT(hook->errors(), HasSubstr("hook 'trouble' (library 'test_trouble'), while it was made, called exit(0)"));
  EXPECT_EQ(text_of(folder_.path() / "t.csv"), "old");
  Tandem check({"check", "e.xml"}, folder_.path());
  EXPECT_EQ(check.wait(), 3);
}
#endif

TEST_F(Endings, AControllerThatDoesNotReturnWithinTheLimitEndsTheRun) {
  auto run = start({.params = R"(what="loop" robot="ep4")"}, {"--step-timeout", "0", "--step-limit", "0.3"});
  EXPECT_EQ(run->wait(60), 3);
  EXPECT_THAT(run->errors(), AllOf(HasSubstr("controller 'who' (library 'test_trouble') of robot 'ep4' at tick 3"),
                                   HasSubstr("the --step-limit")));
  expect_saved(3, "did not return within");
}

TEST_F(Endings, AControllerThatDoesNotReturnIsNamedAndTheFirstCtrlCEndsTheRun) {
  for (const char* threads : {"0", "2"}) {
    auto run = start({.params = R"(what="loop" robot="ep4")"}, {"--step-timeout", "0.2", "--threads", threads});
    ASSERT_TRUE(eventually([&] { return run->errors().find("has not returned") != std::string::npos; }, 20))
        << run->errors();
    EXPECT_THAT(run->errors(), HasSubstr("controller 'who' (library 'test_trouble') of robot 'ep4' at tick 3 has not "
                                         "returned for 0."));
    run->signal(SIGINT);
    EXPECT_EQ(run->wait(), 3);
    expect_saved(3, "of robot 'ep4' at tick 3 did not return");
    EXPECT_EQ(value("steps"), "3");
  }
}

TEST_F(Endings, AHookThatDoesNotReturnIsNamedAndTheFirstCtrlCEndsTheRun) {
  auto run = start({.hook = R"(<loop_functions library="test_trouble" label="trouble" what="loop" at="5"/>)"},
                   {"--step-timeout", "0.2"});
  run->signal(0);
  ASSERT_TRUE(eventually([&] { return run->errors().find("has not returned") != std::string::npos; }, 20));
  run->signal(SIGTERM);
  EXPECT_EQ(run->wait(), 3);
  expect_saved(5, "hook 'trouble' (library 'test_trouble') in after_step at tick 5 did not return");
}

TEST_F(Endings, ACtrlCBeforeTheTimeIsOverCountsToo) {
  auto run = start({.params = R"(what="loop" early="true")"}, {"--step-timeout", "0.5"});
  ASSERT_TRUE(eventually([&] { return run->errors().find("has not returned") != std::string::npos; }, 20));
  EXPECT_THAT(run->errors(), HasSubstr("while it was made, has not returned"));
  run->signal(SIGINT);
  EXPECT_EQ(run->wait(), 3);
  EXPECT_EQ(text_of(folder_.path() / "t.csv"), "old");
}

/// `tandem robot`, whose controller takes the program with it, or never returns.
class RobotEndings : public testing::Test {
 protected:
  std::unique_ptr<Tandem> start(const std::string& params, const std::vector<std::string>& more = {}) {
    ::setenv("XDG_RUNTIME_DIR", folder_.path().c_str(), 1);
    folder_.write("e.xml", R"(<tandem><framework><experiment length="0" ticks_per_second="10"/></framework><controllers>
<troublemaker id="who" library="test_trouble"><actuators><differential_steering/></actuators><params )" +
                               params + R"(/></troublemaker></controllers><arena size="4,4,1"><e-puck id="ep0">
<body position="0,0,0"/><controller config="who"/><bridge link="serial:ep0"/></e-puck></arena></tandem>)");
    folder_.write("r.json", "old");
    std::vector<std::string> words = {"robot", "e.xml", "--report", "r.json"};
    words.insert(words.end(), more.begin(), more.end());
    return std::make_unique<Tandem>(words, folder_.path());
  }
  std::string report() const { return text_of(folder_.path() / "r.json"); }
  void expect_saved(const std::string& failure) const {
    EXPECT_EQ(json_value(report(), "finished"), "false") << report();
    EXPECT_EQ(json_value(report(), "ended"), "failed");
    EXPECT_EQ(json_value(report(), "robot"), "ep0");
    EXPECT_THAT(report(), AllOf(HasSubstr(failure), testing::EndsWith("}\n")));
    EXPECT_FALSE(scenarios::fs::exists(folder_.path() / "r.json.part"));
    EXPECT_TRUE(eventually([&] { return !epuck_.moves(); }, 20)) << epuck_.log();
  }

  Folder folder_;
  scenarios::EmulatedEpuck epuck_{folder_};
};

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST_F(RobotEndings, ACrashNamesControllerRobotAndTickAndKeepsAReport) {
  for (const auto& [what, word] :
       std::map<std::string, std::string>{{"memory", "SIGSEGV"}, {"exit", "called exit(0)"}}) {
    auto robot = start("what=\"" + what + "\" at=\"9\"");
    EXPECT_EQ(robot->wait(60), 3);
    const std::string who = "controller 'who' (library 'test_trouble') of robot 'ep0' at tick 9";
    EXPECT_THAT(robot->errors(), AllOf(HasSubstr("error: " + who), HasSubstr(word)));
    expect_saved(who);
  }
  EXPECT_TRUE(epuck_.has_moved());
}

TEST_F(RobotEndings, ACrashBeforeTheFirstTickIsNamed) {
  auto robot = start(R"(what="memory" early="true")");
  EXPECT_EQ(robot->wait(), 3);
  EXPECT_THAT(robot->errors(), HasSubstr("of robot 'ep0', while it was made, crashed: SIGSEGV"));
  EXPECT_EQ(report(), "old");
}
#endif

TEST_F(RobotEndings, AControllerThatDoesNotReturnIsNamedAndTheFirstCtrlCEndsIt) {
  auto robot = start(R"(what="loop" at="9")", {"--step-timeout", "0.3"});
  const std::string who = "controller 'who' (library 'test_trouble') of robot 'ep0' at tick 9";
  ASSERT_TRUE(eventually([&] { return robot->errors().find(who + " has not returned") != std::string::npos; }, 30))
      << robot->errors();
  robot->signal(SIGINT);
  EXPECT_EQ(robot->wait(), 3);
  expect_saved(who + " did not return");
  EXPECT_EQ(json_value(report(), "steps"), "9");
}

}  // namespace
}  // namespace tandem
