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

}  // namespace
}  // namespace tandem
