// Loop functions, user functions and a program written for ARGoS 3, built as its users build, against this checkout.
#include <algorithm>
#include <gmock/gmock.h>

#include "tests/checkout.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem {
namespace {

namespace fs = std::filesystem;
using scenarios::Folder;
using scenarios::Tandem;
using scenarios::text_of;
using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

const fs::path kTop = test::kSourceDir;
const fs::path kProject = kTop / "tests/compat/argos3/simulator/project";
const std::string kPrefix = std::string(test::kBuildDir) + "/lib";

int shell(const std::string& command, const fs::path& folder) {
  const std::string all = "cd '" + folder.string() + "' && (" + command + ") >log 2>&1 </dev/null";
  const int status = std::system(all.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

class OldCode : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new Folder;
    fs::copy(kProject, folder_->path(), fs::copy_options::recursive);
    built_ = shell(
        "export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1; cmake -S . -B build -DCMAKE_BUILD_TYPE=Debug "
        "-DCMAKE_CXX_FLAGS_DEBUG=-O0 -DCMAKE_PREFIX_PATH='" +
            kPrefix + "' -DCMAKE_CXX_COMPILER_LAUNCHER=$(command -v ccache) && cmake --build build -j 2",
        folder_->path());
    log_ = text_of(folder_->path() / "log");
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  void SetUp() override { ASSERT_EQ(built_, 0) << log_; }

  static const fs::path& path() { return folder_->path(); }
  struct Ended {
    int code;
    std::string out, err;
  };
  static Ended run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "run");
    Tandem tandem(arguments, path());
    const int code = tandem.wait(60.0);
    return {code, tandem.output(), tandem.errors()};
  }
  static std::string state(const std::string& said) { return said.substr(said.find("state "), 27); }
  /// The same experiment with another text in its place.
  static void change(const std::string& file, const std::string& from, const std::string& to, const std::string& as) {
    std::string text = text_of(path() / file);
    ASSERT_NE(text.find(from), std::string::npos);
    text.replace(text.find(from), from.size(), to);
    std::ofstream(path() / as) << text;
  }

 private:
  static inline Folder* folder_ = nullptr;
  static inline int built_ = -1;
  static inline std::string log_;
};

TEST_F(OldCode, HasTheTickOfArgos) {
  const Ended ended = run({"order.argos"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  const std::vector<std::string> told = {
      "Init clock=0 at=-1000 seen=0 steps=0 its_clock=0",
      "PreStep clock=1 at=-1000 seen=0 steps=0 its_clock=0",
      "PostStep clock=1 at=-1000 seen=-1000 steps=1 its_clock=1",
      "IsExperimentFinished clock=1 at=-1000 seen=-1000 steps=1 its_clock=1",
      "PreStep clock=2 at=-990 seen=-1000 steps=1 its_clock=1",
      "PostStep clock=2 at=-990 seen=-990 steps=2 its_clock=2",
      "PostExperiment clock=2 at=-990 seen=-990 steps=2 its_clock=2",
  };
  std::string text;
  for (const std::string& line : told) text += line + "\n";
  EXPECT_THAT(ended.out, HasSubstr(text)) << "acts and moves before PreStep; ends by Terminate";
  EXPECT_THAT(ended.out, testing::EndsWith("\nDestroy\n")) << "when the world goes, after the report";
}

TEST_F(OldCode, PaintsTheFloorBeforeSensorsLookAtIt) {
  const Ended ended = run({"floor.argos"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_THAT(ended.out, AllOf(HasSubstr("wrong 0 dark 6"), HasSubstr("colour 255"))) << "in every third of 20 ticks";
}

TEST_F(OldCode, AddsMovesAndRemovesEntities) {
  const Ended ended = run({"garden.argos"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_THAT(ended.out, ContainsRegex("checks [3-9][0-9], wrong 0"));
  EXPECT_THAT(ended.err, Not(HasSubstr("WRONG")));
  EXPECT_THAT(ended.out, AllOf(HasSubstr("arena 4,4,2 at 0,0,1 from -2,-2,0"),
                               HasSubstr("\"stone\": an entity of type \"box\" has this id already"),
                               HasSubstr("there is no controller with id 'nobody'; there are: walk"),
                               HasSubstr("outside the arena"), HasSubstr("there are no entities of type \"unicorn\""),
                               HasSubstr("it has no component \"wings\"; it has: controller[controller_0]"),
                               HasSubstr("\"body\" of entity \"new0\" is of another class")));
  EXPECT_EQ(state(run({"garden.argos", "--threads", "3"}).out), state(ended.out)) << "for any number of threads";
}

TEST_F(OldCode, SaysWhatItThrewAndDoesNothingByHalves) {
  const Ended init = run({"faulty.argos"});
  EXPECT_EQ(init.code, 3);
  EXPECT_THAT(init.err, AllOf(HasSubstr("hook 'faulty' threw in before_run"), HasSubstr("cannot begin"),
                              HasSubstr("the garden is closed")));
  EXPECT_THAT(init.out, AllOf(Not(HasSubstr("stepped")), Not(HasSubstr("destroyed")))) << "nothing half made is called";
  change("faulty.argos", "where=\"Init\"", "where=\"PostStep\"", "late.argos");
  const Ended late = run({"late.argos"});
  EXPECT_EQ(late.code, 3);
  EXPECT_THAT(late.err, HasSubstr("hook 'faulty' threw in after_step at tick 0: out of water"));
  change("faulty.argos", "where=\"Init\"", "where=\"Destroy\"", "stuck.argos");
  const Ended stuck = run({"stuck.argos"});
  EXPECT_EQ(stuck.code, 0) << stuck.err;
  EXPECT_THAT(stuck.err, HasSubstr("in Destroy() of the loop functions: the gate is stuck"));
  change("faulty.argos", "where=\"Init\"", "", "missing.argos");
  EXPECT_THAT(run({"missing.argos"}).err, HasSubstr("'where' of <loop_functions>"));
  change("faulty.argos", "label=\"faulty\"", "label=\"faulti\"", "label.argos");
  const Ended label = run({"label.argos"});
  EXPECT_EQ(label.code, 1);
  EXPECT_THAT(label.err, AllOf(HasSubstr("has no hook 'faulti'"), HasSubstr("order, floor, garden, faulty")));
}

TEST_F(OldCode, DrawsIntoPictures) {
  const Ended ended = run({"drawing.argos", "--picture", "end.svg"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_THAT(text_of(path() / "end.svg"), AllOf(HasSubstr("hat of fb"), HasSubstr("over all")));
  EXPECT_THAT(ended.out, AllOf(HasSubstr("hat at -1000\n"), HasSubstr("hat at -810\n"))) << "where the robot is";
  change("drawing.argos", "library=\"build/libold_loops\" label=\"drawing\"",
         "library=\"build/none\" label=\"drawing\"", "undrawn.argos");
  const Ended undrawn = run({"undrawn.argos"});
  EXPECT_EQ(undrawn.code, 0) << "a view's functions are no reason not to run";
  EXPECT_THAT(undrawn.err, HasSubstr("user_functions are left out"));
}

TEST_F(OldCode, LetsControllersLookAtTheSpaceOnAnyThread) {
  const Ended one = run({"crowd.argos"});
  EXPECT_EQ(one.code, 0) << one.err;
  EXPECT_THAT(one.err, Not(HasSubstr("WRONG"))) << "without loop functions, too";
  for (int i = 0; i < 5; ++i) {
    const Ended many = run({"crowd.argos", "--threads", "4"});
    EXPECT_EQ(many.code, 0) << many.err;
    EXPECT_THAT(many.err, Not(HasSubstr("WRONG")));
    EXPECT_EQ(state(many.out), state(one.out));
  }
}

TEST_F(OldCode, RunsTrialsInAProgramOfItsOwn) {
  ASSERT_EQ(shell("build/trials trials.argos", path()), 0) << text_of(path() / "log");
  const std::string said = text_of(path() / "log");
  EXPECT_THAT(said, HasSubstr("longest 20 seed 124"));
  // Acting precedes moving: 19 of 20 ticks move it, by 1 cm at 10 cm/s.
  EXPECT_THAT(said, ContainsRegex("trial 0 clock 20 at -810 ends 1 resets 1 drawn"));
  EXPECT_THAT(said, ContainsRegex("trial 1 clock 20 at -620 ends 2 resets 2 drawn"));
  EXPECT_THAT(said, ContainsRegex("trial 2 clock 20 at -810 ends 3 resets 3 drawn"));
  const auto drawn = [&](const std::string& trial) {
    const std::string rest = said.substr(said.find("trial " + trial));
    return rest.substr(rest.find("drawn"), rest.find('\n') - rest.find("drawn"));
  };
  EXPECT_EQ(drawn("0"), drawn("1")) << "a reset begins with the same random numbers";
  EXPECT_NE(drawn("0"), drawn("2")) << "with another seed, with others";
  const std::string first = said.substr(said.find("first ") + 6, said.find('\n') - said.find("first ") - 6);
  EXPECT_THAT(first, ContainsRegex("^[0-9]+$"));
  EXPECT_THAT(said, HasSubstr("again " + first + "\n")) << "an experiment that is loaded again repeats";
  EXPECT_EQ(shell("build/trials nowhere.argos", path()), 1);
  EXPECT_THAT(text_of(path() / "log"), AllOf(HasSubstr("failed: "), HasSubstr("nowhere.argos")));
}

TEST_F(OldCode, LinksProgramsByPkgConfig) {
  ASSERT_EQ(shell("g++ -std=c++11 trials.cpp -o by_name -Lbuild -ltrials_loop -lold_controllers -Wl,-rpath,$PWD/build "
                  "$(PKG_CONFIG_PATH='" +
                      kPrefix + "/argos3/lib/pkgconfig' pkg-config --cflags --libs argos3_simulator_program)",
                  path()),
            0)
      << text_of(path() / "log");
  EXPECT_EQ(shell("./by_name nowhere.argos", path()), 1);
  EXPECT_THAT(text_of(path() / "log"), HasSubstr("nowhere.argos"));
}

// --- headers ---

/// What the compiler says of these lines in a function, after these headers.
std::string compiled(const std::string& headers, const std::string& lines, const std::string& standard, int& code) {
  const Folder folder;
  std::ofstream(folder.path() / "a.cpp") << headers << "\nvoid use();\nvoid use() {\n" << lines << "\n}\n";
  code = shell("g++ -std=" + standard + " -Wall -Wextra -Wpedantic -Werror -fsyntax-only -I '" +
                   (kTop / "compat/argos3/include").string() + "' a.cpp",
               folder.path());
  return text_of(folder.path() / "log");
}

constexpr const char* kAll = R"(
#include <argos3/core/simulator/argos_command_line_arg_parser.h>
#include <argos3/core/simulator/loop_functions.h>
#include <argos3/core/simulator/query_plugins.h>
#include <argos3/core/simulator/visualization/default_visualization.h>
#include <argos3/core/utility/plugins/dynamic_loading.h>
#include <argos3/plugins/robots/e-puck/simulator/epuck_entity.h>
#include <argos3/plugins/robots/eye-bot/simulator/eyebot_entity.h>
#include <argos3/plugins/robots/foot-bot/simulator/footbot_entity.h>
#include <argos3/plugins/simulator/entities/box_entity.h>
#include <argos3/plugins/simulator/entities/cylinder_entity.h>
#include <argos3/plugins/simulator/entities/light_entity.h>
#include <argos3/plugins/simulator/media/rab_medium.h>
#include <argos3/plugins/simulator/visualizations/qt-opengl/qtopengl_user_functions.h>
#include <QPainter>
using namespace argos;
)";

TEST(OldHeaders, CompileWithoutWarningsInAllStandards) {
  for (const char* standard : {"c++11", "c++14", "c++17", "c++20"}) {
    int code = -1;
    const std::string said = compiled(kAll, "", standard, code);
    EXPECT_EQ(code, 0) << standard << "\n" << said;
  }
}

TEST(OldHeaders, NameWhatIsNotThereAndWhatToUse) {
  const std::vector<std::pair<std::string, std::string>> asked = {
      {"glBegin(4);", "draw with DrawPolygon"},
      {"CSimulator::GetInstance().GetSpace().GetEntity(\"a\").GetParent().GetComponent<CEmbodiedEntity>(\"body\")"
       ".GetPhysicsModel(0);",
       "bodies belong to Tandem's engines"},
      {"CFootBotEntity f(\"a\", \"b\"); f.GetProximitySensorEquippedEntity();", "ask the controller for its sensor"},
      {"CSimulator::GetInstance().SetRealTimeClock(true);", "set <time mode="},
      {"struct S { ENABLE_VTABLE(); };", "describe a robot kind instead"},
      {"} REGISTER_PHYSICS_ENGINE(CMine, \"mine\"); void other() {", "make a Tandem plug-in"}};
  for (const auto& [lines, message] : asked) {
    int code = -1;
    EXPECT_THAT(compiled(kAll, lines, "c++11", code), HasSubstr(message)) << lines;
    EXPECT_NE(code, 0) << lines;
  }
}

}  // namespace
}  // namespace tandem
