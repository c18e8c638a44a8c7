// scripts/argos-corpus on a small folder.
#include <gmock/gmock.h>
#include <sys/wait.h>

#include "tests/checkout.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem {
namespace {

namespace fs = std::filesystem;
using scenarios::Folder;
using scenarios::json_value;
using scenarios::text_of;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class ArgosCorpusScript : public testing::Test {
 protected:
  /// Calls the script there. @returns its exit code; its output is in `log`.
  int call(const std::string& options) {
    const std::string line = "cd '" + folder_.path().string() + "' && /usr/bin/python3 '" + test::kSourceDir +
                             "/scripts/argos-corpus' . --tandem '" + test::kBuildDir + "/bin/tandem' --seconds 1 " +
                             options + " >log 2>&1 </dev/null";
    const int status = std::system(line.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::string log() const { return text_of(folder_.path() / "log"); }
  void write(const std::string& name, const std::string& controller, const std::string& robot = "e-puck") {
    fs::create_directories((folder_.path() / name).parent_path());
    folder_.write(
        name,
        "<?xml version=\"1.0\"?><argos-configuration><framework><experiment length=\"0\" ticks_per_second=\"10\" "
        "random_seed=\"1\"/></framework><controllers>" +
            controller + "</controllers><arena size=\"2,2,1\"><" + robot +
            " id=\"r\"><body position=\"0,0,0\"/><controller config=\"c\"/></" + robot +
            "></arena><physics_engines><kinematics2d id=\"k\"/></physics_engines></argos-configuration>");
  }
  const std::string kGood =
      "<epuck_diffusion id=\"c\" library=\"epuck_diffusion\"><actuators><differential_steering/></actuators>"
      "<sensors><proximity/></sensors><params/></epuck_diffusion>";
  Folder folder_;
};

TEST_F(ArgosCorpusScript, SaysWhichRunAndWhyTheOthersDoNot) {
  write("a/good.argos", kGood);
  write("b/experiments/good.xml", kGood);
  write("b/experiments/strange.argos", kGood, "kilobot");
  write("b/experiments/scriptless.argos",
        "<lua_controller id=\"c\"><actuators/><sensors/><params script=\"lua/walk.lua\"/></lua_controller>");
  folder_.write("b/broken.argos", "<argos-configuration><framework></argos-configuration>");
  folder_.write("b/other.xml", "<notes/>");
  ASSERT_EQ(call("--json all.json --verbose"), 1) << log();
  EXPECT_THAT(log(), AllOf(HasSubstr("5 experiments of 2 projects: 2 run 1 s, 0 load and do not run, 3 do not load"),
                           HasSubstr("1        1  the script is not there"), HasSubstr("<arena> cannot hold"),
                           HasSubstr("kilobot"), Not(HasSubstr("other.xml"))));
  const std::string json = text_of(folder_.path() / "all.json");
  const auto of = [&](const std::string& file, const char* key) {
    const std::size_t at = json.find("\"file\": \"" + file + "\"");
    return at == std::string::npos ? "missing" : json_value(json, key, at);
  };
  EXPECT_EQ(of("a/good.argos", "outcome"), "runs") << json;
  EXPECT_EQ(of("b/experiments/good.xml", "outcome"), "runs") << json;
  EXPECT_EQ(of("b/experiments/scriptless.argos", "cause"), "the script is not there") << json;
  EXPECT_EQ(of("b/broken.argos", "outcome"), "fails") << json;
  EXPECT_EQ(of("b/broken.argos", "project"), "b") << json;
}

TEST_F(ArgosCorpusScript, RunsAFileInTheFolderFromWhichItsScriptIsFound) {
  write("p/experiments/walk.argos", kGood + "<!-- <params script=\"nowhere.lua\"/> -->");
  folder_.write("p/CMakeLists.txt", "project(walk NONE)\n");
  ASSERT_EQ(call("--json -"), 0) << log();
  EXPECT_EQ(json_value(log(), "folder", log().find("\"file\"")), "p");
  EXPECT_EQ(json_value(log(), "cause"), "");
}

TEST_F(ArgosCorpusScript, LetsScriptsUseFilesWhereThatIsAllowed) {
  folder_.write("notes.lua", "function init() io.open('notes', 'w'):close() end function step() end");
  write("notes.argos",
        "<lua_controller id=\"c\"><actuators/><sensors/><params script=\"notes.lua\"/></lua_controller>");
  EXPECT_EQ(call("--json -"), 1) << log();
  EXPECT_THAT(log(), HasSubstr("--allow-io"));
  EXPECT_EQ(call("--json - --allow-io"), 0) << log();
}

TEST_F(ArgosCorpusScript, SaysThatThereIsNothing) {
  EXPECT_EQ(call(""), 3);
  EXPECT_THAT(log(), HasSubstr("there is no experiment"));
  EXPECT_EQ(call("--no-such-option"), 2);
}

}  // namespace
}  // namespace tandem
