// `tandem plugin check` finds what is wrong with plug-ins, and `tandem plugin new` makes some without fault.
#include <gmock/gmock.h>
#include <map>

#include "tests/checkout.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem {
namespace {

using scenarios::Folder;
using scenarios::json_value;
using scenarios::Tandem;
using scenarios::text_of;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

const std::string kFaulty = std::string(test::kBuildDir) + "/tests/broken_plugins/libtest_faulty.so";
const fs::path kUnusable = fs::path(test::kBuildDir) / "tests" / "hal_plugins";

class PluginCheck : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const Folder folder;
    Tandem check({"plugin", "check", kFaulty}, folder.path());
    code_ = check.wait(60.0);
    output_ = check.output();
    errors_ = check.errors();
  }
  /// The lines that find a fault in this part.
  static std::string faults_of(const std::string& part) {
    std::string faults;
    std::istringstream in(output_);
    for (std::string line; std::getline(in, line);) {
      if (line.starts_with("fault ") && line.find(" " + part + ", ") != std::string::npos) faults += line + "\n";
    }
    return faults;
  }
  static std::string faults_of_sensor(const std::string& name) {
    return faults_of("device 'sensor " + name + " default'");
  }
  static int code_;
  static std::string output_, errors_;
};
int PluginCheck::code_ = -1;
std::string PluginCheck::output_, PluginCheck::errors_;

TEST_F(PluginCheck, EndsWithOneWhereThereAreFaults) {
  EXPECT_EQ(code_, 1) << errors_;
  EXPECT_THAT(output_, HasSubstr(" faults\n"));
}

TEST_F(PluginCheck, FindsNothingWrongWithWhatIsBlameless) {
  EXPECT_EQ(faults_of_sensor("blameless"), "");
  EXPECT_EQ(faults_of("port 'sensor blameless'"), "");
  EXPECT_THAT(output_, HasSubstr("good        device 'sensor blameless default', threads: the same bits again"));
  EXPECT_THAT(output_, HasSubstr("good        device 'sensor blameless default', checkpoints"));
  EXPECT_THAT(output_, HasSubstr("good        device 'sensor blameless default', memory"));
}

TEST_F(PluginCheck, FindsStateThatNoCheckpointHolds) {
  EXPECT_THAT(faults_of_sensor("hidden_state"),
              AllOf(HasSubstr("checkpoints: a run that goes back to tick 20"), HasSubstr("sensor hidden_state value"),
                    HasSubstr("outside of the columns")));
}

TEST_F(PluginCheck, FindsAllocationsInSteps) {
  EXPECT_THAT(faults_of_sensor("allocation"), HasSubstr("memory: 1440 allocations by `new` in 15 ticks"))
      << "96 robots, each in every tick";
}

TEST_F(PluginCheck, FindsWhatDependsOnThreads) {
  EXPECT_THAT(faults_of_sensor("threads"),
              AllOf(HasSubstr("threads: with 2 threads the run differs"), HasSubstr("sensor threads value: 1 and 2")));
}

TEST_F(PluginCheck, FindsChanceThatTheSeedDoesNotDetermine) {
  EXPECT_THAT(faults_of_sensor("chance"), HasSubstr("repeats: a second run with the same seed differs"));
}

TEST_F(PluginCheck, FindsReadingsThatAreNone) {
  EXPECT_THAT(faults_of_sensor("no_stamp"),
              HasSubstr("readings: those of 96 robots are never there: call core::stamp"));
  EXPECT_THAT(faults_of_sensor("not_finite"), HasSubstr("readings: of r0, no finite number"));
}

TEST_F(PluginCheck, FindsStateThatDoesNotDescribeItself) {
  EXPECT_THAT(faults_of_sensor("loose_state"),
              HasSubstr("state: bytes 4 to 11 of the column 'loose_state' change, and no field describes them"));
}

TEST_F(PluginCheck, FindsWhatIsNotDocumented) {
  EXPECT_THAT(faults_of("port 'sensor no_text'"), HasSubstr("documents: what these fields are is not said: value"));
  EXPECT_THAT(faults_of("robot 'runaway'"), HasSubstr("documents: it has no summary"));
}

TEST_F(PluginCheck, FindsLimitsThatLetAnythingThrough) {
  EXPECT_THAT(faults_of("port 'actuator unlimited'"), HasSubstr("limits: it lets through what is no finite number"));
}

TEST_F(PluginCheck, FindsEnginesThatMoveWhatIsNotTheirs) {
  EXPECT_THAT(faults_of("engine 'pusher'"), HasSubstr("motion: it moves a robot whose pose is set from outside"));
}

TEST_F(PluginCheck, FindsBridgesWhoseRobotsNobodyStops) {
  EXPECT_THAT(faults_of("bridge 'runaway'"), AllOf(HasSubstr("stopper: nobody stops such robots"),
                                                   HasSubstr("links: it accepts the link 'nonsense'")));
}

TEST_F(PluginCheck, FindsPartsThatTouchOtherRobots) {
  EXPECT_THAT(faults_of("coupling 'meddling'"), HasSubstr("bystanders: robots that have nothing to do with it"));
}

TEST_F(PluginCheck, FindsThreadsThatStartWhileABridgeIsLoaded) {
  const Folder folder;
  const std::string library = std::string(test::kBuildDir) + "/tests/broken_plugins/libtest_crawler_threaded.so";
  Tandem check({"plugin", "check", library}, folder.path());
  EXPECT_EQ(check.wait(60.0), 1);
  EXPECT_THAT(check.output(), HasSubstr("guardian: it starts a thread while it is loaded"));
}

TEST_F(PluginCheck, IsReadByPrograms) {
  const Folder folder;
  Tandem check({"plugin", "check", kFaulty, "--json"}, folder.path());
  EXPECT_EQ(check.wait(60.0), 1);
  EXPECT_EQ(json_value(check.output(), "good"), "false");
  const std::size_t at =
      check.output().find("\"part\":\"device 'sensor hidden_state default'\",\"what\":\"checkpoints\"");
  EXPECT_NE(at, std::string::npos) << check.output();
}

TEST_F(PluginCheck, SaysWhyALibraryCannotBeLoadedAndNeverCrashes) {
  const Folder folder;
  const std::map<std::string, std::string> reasons = {{"no_plugin", "has no note"},
                                                      {"stale", "built against"},
                                                      {"past_note", "another form than in tandem"},
                                                      {"unresolved", "nobody has its symbol"},
                                                      {"throws", "threw"},
                                                      {"null_type", "type"},
                                                      {"half_type", "lacks functions"}};
  for (const auto& [name, reason] : reasons) {
    Tandem check({"plugin", "check", (kUnusable / ("libtest_hal_" + name + ".so")).string()}, folder.path());
    EXPECT_EQ(check.wait(), 1) << name;
    EXPECT_THAT(check.output(), AllOf(HasSubstr("fault       library"), HasSubstr("loads: "), HasSubstr(reason)))
        << name;
  }
  Tandem nowhere({"plugin", "check", "libnowhere.so"}, folder.path());
  EXPECT_EQ(nowhere.wait(), 1);
  EXPECT_THAT(nowhere.output(), HasSubstr("is not there"));
  Tandem inside({"plugin", "check", std::string(test::kBuildDir) + "/lib/libepuck_diffusion.so"}, folder.path());
  EXPECT_EQ(inside.wait(60.0), 0) << inside.output();
  Tandem flying({"plugin", "check", std::string(test::kBuildDir) + "/lib/libeyebot_circle.so"}, folder.path());
  EXPECT_EQ(flying.wait(60.0), 0) << "lists of the engine that grow are no fault of the controller\n"
                                  << flying.output();
}

TEST(PluginNew, MakesFoldersThatBuildRunAndAreWithoutFault) {
  const Folder folder;
  const std::vector<std::string> kinds = {"device",   "actuator", "controller", "hook",   "engine", "medium",
                                          "observer", "part",     "layer",      "bridge", "command"};
  std::string all = "cmake_minimum_required(VERSION 3.25)\nproject(all_kinds LANGUAGES CXX)\nenable_testing()\n";
  for (const std::string& kind : kinds) {
    Tandem made({"plugin", "new", "my_" + kind, "--kind", kind}, folder.path());
    ASSERT_EQ(made.wait(), 0) << made.errors();
    EXPECT_TRUE(fs::exists(folder.path() / ("my_" + kind) / "README.md"));
    EXPECT_TRUE(fs::exists(folder.path() / ("my_" + kind) / ".github" / "workflows" / "build.yml"));
    all += "add_subdirectory(my_" + kind + ")\n";
  }
  folder.write("CMakeLists.txt", all);
  const std::string command = "cd '" + folder.path().string() +
                              "' && export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1 && (cmake -S . -B build "
                              "-DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O0 -DTandem_DIR='" +
                              test::kSourceDir + "/cmake' -DTandem_PROGRAM='" + test::kBuildDir +
                              "/bin/tandem' -DCMAKE_CXX_COMPILER_LAUNCHER=$(command -v ccache) && "
                              "cmake --build build -j 2 && ctest --test-dir build --output-on-failure) >log 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << text_of(folder.path() / "log");
  EXPECT_THAT(text_of(folder.path() / "log"), HasSubstr("100% tests passed, 0 tests failed out of 22"));
}

TEST(PluginNew, TwoOfOneKindStandSideBySide) {
  const Folder folder;
  for (const std::string name : {"frog", "toad"}) {
    Tandem made({"plugin", "new", name, "--kind", "medium"}, folder.path());
    ASSERT_EQ(made.wait(), 0) << made.errors();
  }
  EXPECT_THAT(text_of(folder.path() / "frog/frog.cpp"),
              AllOf(HasSubstr("\"frog_chirper\""), Not(HasSubstr("\"chirper\""))));
  EXPECT_THAT(text_of(folder.path() / "toad/toad.xml"),
              AllOf(HasSubstr("<toad_chirper/>"), HasSubstr("build/libtoad")));
}

TEST(PluginNew, RefusesNamesThatWillNotDoAndFoldersThatAreThere) {
  const Folder folder;
  for (const std::string name : {"Greenhouse", "9lives", "two words", "../up", "test", "a-b"}) {
    Tandem refused({"plugin", "new", name}, folder.path());
    EXPECT_EQ(refused.wait(), 2) << name;
    EXPECT_THAT(refused.errors(), HasSubstr("is no name for a plug-in")) << name;
  }
  fs::create_directory(folder.path() / "greenhouse");
  Tandem there({"plugin", "new", "greenhouse"}, folder.path());
  EXPECT_EQ(there.wait(), 1);
  EXPECT_THAT(there.errors(), HasSubstr("'greenhouse' is there already"));
  Tandem kind({"plugin", "new", "shed", "--kind", "teleporter"}, folder.path());
  EXPECT_EQ(kind.wait(), 2);
  EXPECT_THAT(kind.errors(), AllOf(HasSubstr("device"), HasSubstr("observer")));
  EXPECT_FALSE(fs::exists(folder.path() / "shed"));
}

}  // namespace
}  // namespace tandem
