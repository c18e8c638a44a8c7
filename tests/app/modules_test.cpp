// The program without its modules, with damaged ones, and with a launcher that builds them: in a folder of its own, in
// which the program finds what a build folder or an installation has beside it.
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <string>
#include <sys/wait.h>

#include "tests/checkout.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem {
namespace {

using scenarios::Folder;
using scenarios::text_of;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

class Modules : public testing::Test {
 protected:
  Modules() {
    fs::create_directories(modules());
    fs::create_directories(folder_.path() / "bin");
    fs::copy_file(built("bin/tandem"), folder_.path() / "bin" / "tandem");
    fs::copy_file(built("lib/libepuck_diffusion.so"), folder_.path() / "lib" / "libepuck_diffusion.so");
  }
  static fs::path built(const std::string& file) { return fs::path(test::kBuildDir) / file; }
  fs::path modules() const { return folder_.path() / "lib" / "modules"; }
  static std::string file_of(const std::string& module) { return "libtandem_" + module + ".so"; }
  void put(const std::string& module) const {
    fs::copy_file(built("lib/modules/" + file_of(module)), modules() / file_of(module));
  }
  /// A launcher that does this with the module named $5 (and says its words).
  void launcher(const std::string& does) const {
    const fs::path script = folder_.write("launcher", "#!/bin/sh\necho \"asked: $*\"\n" + does + "\n");
    fs::permissions(script, fs::perms::owner_all);
    environment_ = "TANDEM_LAUNCHER=" + script.string() + " TANDEM_PRESET=release ";
  }
  struct Ended {
    int code;
    std::string text;  ///< output and errors
  };
  Ended run(const std::string& words) const {
    const std::string at = folder_.path().string();
    const std::string command = "cd '" + at + "' && env -u TANDEM_LAUNCHER " + environment_ + at + "/bin/tandem " +
                                words + " >'" + at + "/said' 2>&1 </dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(folder_.path() / "said")};
  }
  static std::string experiment() { return std::string(test::kSourceDir) + "/configs/epuck_diffusion.xml"; }

  Folder folder_;
  mutable std::string environment_;
};

TEST_F(Modules, AreNotNeededForARunOfSimulatedRobots) {
  const Ended done = run("run " + experiment() + " --steps 5 --report -");
  EXPECT_EQ(done.code, 0) << done.text;
  EXPECT_THAT(done.text, HasSubstr("\"state_hash\""));
}

TEST_F(Modules, ThatAreMissingAreNamedWithWhatWouldBuildThem) {
  for (const std::string& words :
       std::vector<std::string>{"sweep s.xml", "view " + experiment(), "robot r.xml", "fit r.rec"}) {
    const Ended done = run(words);
    EXPECT_EQ(done.code, 1) << words << done.text;
    EXPECT_THAT(done.text, AllOf(HasSubstr("is not here"), HasSubstr("./tandem build module "))) << words;
  }
  const Ended mixed = run("check " + std::string(test::kSourceDir) + "/configs/epuck_mixed.xml");
  EXPECT_EQ(mixed.code, 1);
  EXPECT_THAT(mixed.text, HasSubstr("module 'real'"));
  EXPECT_EQ(run("run " + experiment() + " --steps 5 --picture p.svg").code, 1);
  folder_.write("engine.xml",
                "<tandem><arena size=\"4,4,1\"/><physics_engines><dynamics2d id=\"d\"/></physics_engines></tandem>");
  const Ended engine = run("check engine.xml");
  EXPECT_EQ(engine.code, 1);
  EXPECT_THAT(engine.text, HasSubstr("module 'dynamics'"));
  folder_.write("typo.xml",
                "<tandem><arena size=\"4,4,1\"/><physics_engines><dynamic2d id=\"d\"/></physics_engines></tandem>");
  EXPECT_THAT(run("list engines").text, AllOf(HasSubstr("kinematics2d"), HasSubstr("dynamics3d; NOT BUILT")));
  const std::vector<std::pair<std::string, std::string>> lists = {
      {"bridges", "real"}, {"trackers", "real"}, {"layers", "pictures"}, {"elements", "study"}};
  for (const auto& [kind, module] : lists)
    EXPECT_THAT(run("list " + kind).text, HasSubstr(kind + " of the module '" + module + "'"));
  EXPECT_THAT(run("list controllers").text,
              AllOf(HasSubstr("\n  epuck_diffusion"), HasSubstr("NOT BUILT, until a file names them: "),
                    HasSubstr("footbot_foraging"), Not(HasSubstr(", epuck_diffusion"))));
  EXPECT_THAT(run("describe dynamics3d").text, HasSubstr("module 'dynamics'"));
  EXPECT_THAT(run("check typo.xml").text, HasSubstr("Did you mean 'dynamics2d'?")) << "it is known before it is there";
}

TEST_F(Modules, AreListedAndTheirCommandsAreInHelpWhetherTheyAreBuiltOrNot) {
  const Ended list = run("list modules"), help = run("--help");
  EXPECT_THAT(list.text, AllOf(HasSubstr("study"), HasSubstr("NOT BUILT")));
  EXPECT_THAT(help.text, AllOf(HasSubstr("sweep"), HasSubstr("validate"), HasSubstr("emulate")));
  for (const char* module : {"dynamics", "live", "pictures", "real", "window", "study", "lab", "argos3"}) put(module);
  const Ended all = run("list modules");
  EXPECT_THAT(all.text, AllOf(HasSubstr("lab"), Not(HasSubstr("NOT BUILT")), Not(HasSubstr("warning"))))
      << "all load, beside one another";
  for (const char* kind : {"emulators", "bridges", "trackers", "layers", "elements"})
    EXPECT_THAT(run(std::string("list ") + kind).text, AllOf(HasSubstr(":\n  "), Not(HasSubstr("of the module"))))
        << "it is of the table of modules";
  EXPECT_THAT(run("list emulators").text, HasSubstr("footbot"));
}

TEST_F(Modules, AreBuiltByTheLauncherWhenACommandNamesThem) {
  launcher("cp " + built("lib/modules").string() + "/libtandem_$5.so lib/modules/");
  const Ended first = run("run " + experiment() + " --steps 5 --quiet --picture p.svg");
  EXPECT_EQ(first.code, 0) << first.text;
  EXPECT_THAT(first.text, AllOf(HasSubstr("building the module 'pictures'"),
                                HasSubstr("asked: --preset release build module pictures")));
  EXPECT_TRUE(fs::exists(folder_.path() / "p.svg"));
  const Ended again = run("run " + experiment() + " --steps 5 --quiet --picture q.svg");
  EXPECT_EQ(again.code, 0);
  EXPECT_EQ(again.text, "") << "it is there now";
}

TEST_F(Modules, AndControllersOfTheCheckoutAreBuiltWhenAFileNamesThem) {
  fs::remove(folder_.path() / "lib" / "libepuck_diffusion.so");
  launcher("cp " + built("lib").string() + "/lib$5.so lib/");
  const Ended done = run("run " + experiment() + " --steps 5 --quiet");
  EXPECT_EQ(done.code, 0) << done.text;
  EXPECT_THAT(done.text, HasSubstr("asked: --preset release build plugin epuck_diffusion"));
}

TEST_F(Modules, ThatCannotBeBuiltEndTheirCommandAlone) {
  launcher("echo 'the compiler is out' >&2; exit 1");
  const Ended done = run("sweep s.xml");
  EXPECT_EQ(done.code, 1);
  EXPECT_THAT(done.text, AllOf(HasSubstr("the compiler is out"), HasSubstr("could not be built")));
  EXPECT_EQ(run("run " + experiment() + " --steps 5 --quiet").code, 0);
}

TEST_F(Modules, ThatDoNotFitAreRefusedBeforeTheyAreLoaded) {
  put("study");
  fs::resize_file(modules() / file_of("study"), 5000);
  const Ended cut = run("sweep s.xml");
  EXPECT_EQ(cut.code, 1);
  EXPECT_THAT(cut.text, AllOf(HasSubstr("module 'study'"), HasSubstr("Build it again: ./tandem build module study")));
  fs::remove(modules() / file_of("study"));
  fs::copy_file(built("tests/hal_plugins/libtest_hal_stale.so"), modules() / file_of("study"));
  const Ended stale = run("sweep s.xml");
  EXPECT_EQ(stale.code, 1);
  EXPECT_THAT(stale.text, AllOf(HasSubstr("does not fit this program"), HasSubstr("./tandem build module study")));
  const Ended list = run("list modules");
  EXPECT_EQ(list.code, 0) << "what does not load is told, and left out";
  EXPECT_THAT(list.text, HasSubstr("warning: module 'study'"));
}

TEST_F(Modules, ThatAreDeletedWhileARunIsOnServeItToItsEnd) {
  put("live");
  put("pictures");
  fs::create_directories(folder_.path() / "lib" / "render");
  fs::copy_file(built("lib/render/libtandem_render.so"), folder_.path() / "lib" / "render" / "libtandem_render.so");
  const auto script = folder_.write("script", "cd '" + folder_.path().string() + "'\nbin/tandem run '" + experiment() +
                                                  "' --quiet --seconds 2 --watch --film frames/ --film-every 5 &\n"
                                                  "for i in $(seq 200); do [ -d frames ] && break; sleep 0.02; done\n"
                                                  "rm lib/modules/*\nwait $!\n");
  const std::string said = (folder_.path() / "said").string();
  const int status =
      std::system(("env -u TANDEM_LAUNCHER bash '" + script.string() + "' >'" + said + "' 2>&1 </dev/null").c_str());
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << text_of(said);
}

}  // namespace
}  // namespace tandem
