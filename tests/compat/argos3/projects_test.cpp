// Projects for ARGoS 3 as their users build them, and libraries of them on robots.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/checkout.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem::scenarios {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::string kLibrary = std::string(test::kBuildDir) + "/tests/argos/libtest_argos_controllers.so";

/// Runs a command of the shell; @returns all that it says, behind its exit code.
std::string shell(const std::string& command) {
  std::string said;
  FILE* const pipe = ::popen(("( " + command + " ) 2>&1").c_str(), "r");
  std::array<char, 4096> piece{};
  while (const std::size_t n = std::fread(piece.data(), 1, piece.size(), pipe)) said.append(piece.data(), n);
  return std::to_string(WEXITSTATUS(::pclose(pipe))) + " " + said;
}

const std::string kAnts = R"(<tandem><framework><experiment length="1" ticks_per_second="10"/></framework><controllers>
<ant id="r" library="built/libred_ants"><actuators><differential_steering/></actuators><params><wheels velocity="3"/></params></ant>
<ant id="b" library="built/libblack_ants"><actuators><differential_steering/></actuators><params><wheels velocity="2"/></params></ant>
</controllers><arena size="4,4,1"><foot-bot id="one"><body position="0,0,0"/><controller config="r"/></foot-bot>
<foot-bot id="two"><body position="0,1,0"/><controller config="b"/></foot-bot></arena></tandem>)";

class ArgosProjects : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(FoundBy, ArgosProjects,
                         testing::Values("CMAKE_PREFIX_PATH=$LIB", "CMAKE_PREFIX_PATH=$LIB/argos3",
                                         "PKG_CONFIG_PATH=$LIB/argos3/lib/pkgconfig BY=-DBY_PKG_CONFIG=ON"),
                         [](const auto& one) {
                           return one.index == 0 ? "TheLibraryFolder" : one.index == 1 ? "ThePrefix" : "PkgConfig";
                         });

TEST_P(ArgosProjects, BuildAndRun) {
  const Folder folder;
  const std::string source = std::string(test::kSourceDir) + "/tests/compat/argos3/project";
  const std::string built = shell("export LIB=" + std::string(test::kBuildDir) + "/lib " + "; export " + GetParam() +
                                  "; cd " + folder.path().string() + " && cmake -S " + source +
                                  " -B built $BY -DCMAKE_BUILD_TYPE=Release && cmake --build built");
  ASSERT_THAT(built, testing::StartsWith("0 ")) << built;
  folder.write("ants.xml", kAnts);
  Tandem run({"run", "ants.xml", "--log", "run.log"}, folder.path());
  ASSERT_EQ(run.wait(120), 0) << run.errors();
  EXPECT_THAT(run.errors(), AllOf(HasSubstr("[one] is of the red ants"), HasSubstr("[two] is of the black ants")))
      << "classes of one name in two libraries are two classes";
}

TEST(ArgosLibraries, ThatWereBuiltForARGoSAreRefusedWithWhatToDo) {
  const Folder folder;
  folder.write("old.cpp", "namespace argos { struct CCI_Old { virtual ~CCI_Old() {} }; } argos::CCI_Old old;\n");
  ASSERT_THAT(shell("cd " + folder.path().string() + " && g++ -shared -fPIC -o libold.so old.cpp"),
              testing::StartsWith("0 "));
  folder.write("e.xml", R"(<tandem><framework><experiment length="1"/></framework><controllers>
<old id="c" library="libold"/></controllers><arena size="4,4,1"><e-puck id="ep0"><body position="0,0,0"/>
<controller config="c"/></e-puck></arena></tandem>)");
  Tandem run({"run", "e.xml"}, folder.path());
  EXPECT_NE(run.wait(60), 0);
  EXPECT_THAT(run.errors(), AllOf(HasSubstr("was built for ARGoS 3"), HasSubstr("CMAKE_PREFIX_PATH")));
}

TEST(ArgosCommand, ShowsWhatTheFileShows) {
  const Folder folder;
  const auto command = [&](const std::string& visualization) {
    folder.write("e.argos", "<argos-configuration><!-- <a/> -->\n" + visualization + "</argos-configuration>");
    return shell("cd " + folder.path().string() + " && TANDEM_PROGRAM=/bin/echo " + std::string(test::kBuildDir) +
                 "/lib/argos3/bin/argos3 -c e.argos");
  };
  EXPECT_EQ(command("<visualization>\n<qt-opengl/></visualization>"), "0 view e.argos\n");
  EXPECT_EQ(command("<!-- off --><visualization><!--\n<qt-opengl/> --></visualization>"), "0 run e.argos\n");
}

TEST(ArgosLibraries, AreListedLikeOthers) {
  const Folder folder;
  Tandem describe({"describe", kLibrary}, folder.path());
  describe.wait(60);
  Tandem list({"list", "modules"}, folder.path());
  EXPECT_EQ(list.wait(60), 0);
  EXPECT_THAT(list.output(), HasSubstr("argos3"));
}

TEST(ArgosLibraries, DriveAnEpuck) {
  const Folder folder;
  const EmulatedEpuck epuck(folder);
  folder.write("e.xml", R"(<tandem><framework><experiment length="0" ticks_per_second="10"/></framework><controllers>
<epuck_walker id="c" library=")" +
                            kLibrary + R"("><actuators><differential_steering/></actuators><sensors><epuck_proximity/>
</sensors><params velocity="5"/></epuck_walker></controllers><arena size="4,4,1"><e-puck id="ep0">
<body position="0,0,0"/><controller config="c"/><bridge link="serial:ep0"/></e-puck></arena></tandem>)");
  Tandem run({"robot", "e.xml", "--seconds", "2"}, folder.path());
  EXPECT_EQ(run.wait(60), 0) << run.errors();
  EXPECT_TRUE(epuck.has_moved());
  EXPECT_TRUE(eventually([&] { return !epuck.moves(); }, 20)) << epuck.log();
}

TEST(ArgosLibraries, DriveAFootbot) {
  const Folder folder;
  const EmulatedFootbot footbot(folder);
  ASSERT_TRUE(footbot.ready());
  folder.write("e.xml", R"(<tandem><framework><experiment length="0" ticks_per_second="10"/></framework><controllers>
<footbot_walker id="c" library=")" +
                            kLibrary + R"("><actuators><differential_steering/></actuators><sensors>
<footbot_proximity/></sensors><params velocity="5"/></footbot_walker></controllers><arena size="4,4,1">
<foot-bot id="fb0"><body position="0,0,0"/><controller config="c"/><bridge link="slcan:fb0@1000000" map=")" +
                            std::string(test::kSourceDir) +
                            R"(/configs/footbot_map.xml"/></foot-bot></arena></tandem>)");
  Tandem run({"robot", "e.xml", "--seconds", "2"}, folder.path());
  EXPECT_EQ(run.wait(60), 0) << run.errors();
  EXPECT_TRUE(footbot.has_moved());
}

TEST(ArgosLibraries, AreStoppedByNameWhenTheyThrowOnARobot) {
  const Folder folder;
  const EmulatedEpuck epuck(folder);
  folder.write("e.xml", R"(<tandem><framework><experiment length="0" ticks_per_second="10"/></framework><controllers>
<thrower id="c" library=")" +
                            kLibrary + R"("><actuators><differential_steering/></actuators>
<params when="step" what="argos"/></thrower></controllers><arena size="4,4,1"><e-puck id="ep0">
<body position="0,0,0"/><controller config="c"/><bridge link="serial:ep0"/></e-puck></arena></tandem>)");
  Tandem run({"robot", "e.xml"}, folder.path());
  EXPECT_EQ(run.wait(60), 3);
  EXPECT_THAT(run.errors(), AllOf(HasSubstr("of robot 'ep0' threw"), HasSubstr("the outer reason in step")));
}

}  // namespace
}  // namespace tandem::scenarios
