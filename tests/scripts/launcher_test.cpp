// The launcher, on a machine whose commands are replaced by ones that play what a real machine does.
#include <gmock/gmock.h>
#include <sys/wait.h>

#include "tests/checkout.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem {
namespace {

namespace fs = std::filesystem;
using scenarios::Folder;
using scenarios::text_of;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class Launcher : public testing::Test {
 protected:
  void SetUp() override {
    fs::copy_file(fs::path(test::kSourceDir) / "tandem", folder_.path() / "tandem");
    fs::create_directory(folder_.path() / "bin");
    command("dpkg-query", "exit 1");  // nothing is installed
    command("sudo", "exec \"$@\"");
    command("cmake", "exit 1");  // here the test ends
    command("sleep", "");
  }
  void command(const std::string& name, const std::string& script) {
    const fs::path file = folder_.write("bin/" + name, "#!/bin/bash\n" + script + "\n");
    fs::permissions(file, fs::perms::owner_all);
  }
  /// What the launcher says.
  std::string build() {
    const std::string at = folder_.path().string();
    const std::string line = "cd '" + at + "' && PATH=\"$PWD/bin:$PATH\" ./tandem --yes build </dev/null >out 2>&1";
    EXPECT_NE(std::system(line.c_str()), 0);
    return text_of(folder_.path() / "out");
  }
  Folder folder_;
};

TEST_F(Launcher, WaitsForAptsLockAndSaysSo) {
  command("apt-get", R"sh(
    echo "$1" >>calls
    if [ "$(wc -l <calls)" -le 3 ]; then
      echo "E: Could not get lock /var/lib/apt/lists/lock. It is held by process 17 (apt-get)"
      exit 100
    fi)sh");
  const std::string said = build();
  EXPECT_THAT(said, AllOf(HasSubstr("another program holds apt's lock; waiting"), HasSubstr("building failed")));
  EXPECT_EQ(said.find("holds apt's lock"), said.rfind("holds apt's lock")) << "said once";
  EXPECT_EQ(text_of(folder_.path() / "calls"), "update\nupdate\nupdate\nupdate\ninstall\n");
}

TEST_F(Launcher, DoesNotWaitForOtherErrorsOfApt) {
  command("apt-get", "echo \"$1\" >>calls; echo 'E: Unable to locate package'; exit 100");
  EXPECT_THAT(build(), AllOf(HasSubstr("installing failed"), HasSubstr("Unable to locate"), Not(HasSubstr("waiting"))));
  EXPECT_EQ(text_of(folder_.path() / "calls"), "update\n");
}

TEST_F(Launcher, SaysHowFarALongBuildIsWhereThereIsNoTerminal) {
  std::string launcher = text_of(folder_.path() / "tandem");
  for (std::size_t at = 0; (at = launcher.find("SECONDS + 30", at)) != std::string::npos;)
    launcher.replace(at, 12, "SECONDS + 1");  // a second for half a minute
  std::ofstream(folder_.path() / "tandem") << launcher;
  command("apt-get", "");
  command("cmake", "for i in 1 2 3; do echo \"[$i/40] Building x$i\"; /bin/sleep 1.1; done; exit 1");
  EXPECT_THAT(build(), AllOf(HasSubstr("building all (preset release)"), HasSubstr("still building: [2/40]"),
                             HasSubstr("still building: [3/40]")));
}

/// A launcher whose program was built after its sources, and says how it was started.
class BuiltLauncher : public Launcher {
 protected:
  void SetUp() override {
    Launcher::SetUp();
    fs::create_directories(folder_.path() / "build/release/bin");
    const fs::path program = folder_.write("build/release/bin/tandem", "#!/bin/bash\necho \"$0\" \"$@\"\n");
    fs::permissions(program, fs::perms::owner_all);
    fs::create_directory(folder_.path() / "none");
    fs::create_directory(folder_.path() / "find");
    fs::create_symlink("/usr/bin/find", folder_.path() / "find/find");
    folder_.write("build/release/.tandem-built", "");
    const fs::file_time_type built = fs::last_write_time(folder_.path() / "build/release/.tandem-built");
    fs::last_write_time(folder_.path() / "tandem", built - std::chrono::seconds(1));
  }
  /// What `line` prints, begun in the launcher's folder.
  std::string printed(const std::string& line) {
    EXPECT_EQ(std::system(("cd '" + folder_.path().string() + "' && " + line + " >out 2>&1 </dev/null").c_str()), 0)
        << text_of(folder_.path() / "out");
    return text_of(folder_.path() / "out");
  }
  std::string started() const { return fs::canonical(folder_.path()).string() + "/build/release/bin/tandem run a\n"; }
};

TEST_F(BuiltLauncher, CallsNoCommandButFindWhereNothingIsToBeBuilt) {
  EXPECT_EQ(printed("PATH=\"$PWD/find\" /bin/bash ./tandem run a"), started());
  std::system(
      ("cd '" + folder_.path().string() + "' && PATH=\"$PWD/none\" /bin/bash ./tandem run a >out 2>&1").c_str());
  EXPECT_THAT(text_of(folder_.path() / "out"), HasSubstr("find: "))
      << "the measure: a command that is not there is noticed";
}

TEST_F(BuiltLauncher, FindsItsCheckoutByAnyName) {
  fs::create_directory(folder_.path() / "elsewhere");
  fs::create_symlink("../tandem", folder_.path() / "elsewhere/linked");
  fs::create_symlink(".", folder_.path() / "itself");
  EXPECT_EQ(printed("bash tandem run a"), started());
  EXPECT_EQ(printed("(cd elsewhere && CDPATH=/tmp:.. ../tandem run a)"), started());
  EXPECT_EQ(printed("itself/itself/tandem run a"), started());
  EXPECT_EQ(printed("(cd / && \"$OLDPWD/elsewhere/linked\" run a)"), started());
}

TEST_F(BuiltLauncher, InstallsWhatFilmsAndRayTracedPicturesCall) {
  command("apt-get", "echo \"$@\" >>calls");
  for (const char* const name : {"env", "find", "grep", "id", "mktemp", "rm"})
    fs::create_symlink(std::string("/usr/bin/") + name, folder_.path() / "bin" / name);
  const auto called = [this](const std::string& words) {
    fs::remove(folder_.path() / "calls");
    (void)printed("PATH=\"$PWD/bin\" /bin/bash ./tandem --yes run a " + words);
    return text_of(folder_.path() / "calls");
  };
  EXPECT_THAT(called("--film b.webp --film-every 2"), HasSubstr("--no-install-recommends ffmpeg\n"));
  EXPECT_THAT(called("--povray b.png"), HasSubstr("--no-install-recommends povray\n"));
  EXPECT_EQ(called("--film frames/ --povray b.pov --picture b.png"), "");
}

}  // namespace
}  // namespace tandem
