// A program of others that holds a world: built from outside against a checkout, an installed tree, and the packages.
#include <gmock/gmock.h>

#include "tests/checkout.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem {
namespace {

namespace fs = std::filesystem;
using scenarios::Folder;
using scenarios::text_of;
using testing::AllOf;
using testing::HasSubstr;

const std::string kTop = test::kSourceDir, kBuild = test::kBuildDir;
constexpr int kNotTried = 77;  // bare_root.py
const std::string kExperiment = kTop + "/configs/epuck_diffusion.xml";

/// Runs a shell command in a folder. @returns its exit code; what it printed is in `log` there.
int shell(const std::string& command, const fs::path& folder) {
  const std::string all = "cd '" + folder.string() + "' && (" + command + ") >log 2>&1 </dev/null";
  const int status = std::system(all.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string build_lab(const std::string& tandem_dir) {
  return "cp -r '" + kTop +
         "/examples/library' lab && cmake -S lab -B lab/build -DCMAKE_BUILD_TYPE=Debug -DTandem_DIR='" + tandem_dir +
         "' -DCMAKE_CXX_COMPILER_LAUNCHER=$(command -v ccache) && cmake --build lab/build";
}

std::string fingerprint(const std::string& text, std::size_t from = 0) {
  const std::size_t at = text.find("state ", from);
  return at == std::string::npos ? "" : text.substr(at + 6, 16);
}

/// What the command says of the same run.
std::string fingerprint_of_run() {
  const Folder folder;
  scenarios::Tandem run({"run", kExperiment, "--seed", "7", "--steps", "50", "--report", "-"}, folder.path());
  EXPECT_EQ(run.wait(), 0) << run.errors();
  return scenarios::json_value(run.output(), "state_hash").substr(2);
}

TEST(Library, MakesStepsAndLooksIntoAWorldInAProgramOfOthers) {
  const Folder folder;
  ASSERT_EQ(shell(build_lab(kTop + "/cmake") + " && lab/build/lab '" + kExperiment + "' 50 lab.record", folder.path()),
            0)
      << text_of(folder.path() / "log");
  const std::string said = text_of(folder.path() / "log");
  const std::size_t first = said.find("50 ticks"), second = said.find("50 ticks", first + 1);
  ASSERT_NE(second, std::string::npos) << said;
  EXPECT_EQ(fingerprint(said, first), fingerprint_of_run());
  EXPECT_EQ(fingerprint(said, second), fingerprint(said, first)) << "it went back, and the same way again";

  scenarios::Tandem told({"export", "lab.record"}, folder.path());
  EXPECT_EQ(told.wait(), 0) << told.errors();
  EXPECT_THAT(told.output(), AllOf(HasSubstr("seed 7"), HasSubstr("ticks 0 to 49, 50 of them, 50 rows each")));
  EXPECT_EQ(shell("lab/build/lab '" + kExperiment + "' 5 nowhere/lab.record", folder.path()), 1);
  EXPECT_THAT(text_of(folder.path() / "log"), HasSubstr("nowhere/lab.record"));

  folder.write("bad.xml", "<tandem><arena size=\"1,1,1\" colour=\"red\"/></tandem>");
  EXPECT_EQ(shell("lab/build/lab bad.xml", folder.path()), 1);
  EXPECT_THAT(text_of(folder.path() / "log"), HasSubstr("bad.xml:1: error: "));
}

TEST(Library, IsFoundInAnInstalledTree) {
  const Folder folder;
  const std::string prefix = (folder.path() / "prefix").string();
  ASSERT_EQ(shell("cmake --install '" + kBuild + "' --prefix '" + prefix + "'", folder.path()), 0)
      << text_of(folder.path() / "log");
  ASSERT_EQ(shell(build_lab(prefix + "/lib/cmake/Tandem") + " && lab/build/lab '" + kExperiment + "' 50 lab.record",
                  folder.path()),
            0)
      << text_of(folder.path() / "log");
  EXPECT_EQ(fingerprint(text_of(folder.path() / "log")), fingerprint_of_run());
  EXPECT_NE(
      shell("sed -i 's/COMPONENTS core/COMPONENTS cores/' lab/CMakeLists.txt && cmake -S lab -B other -DTandem_DIR='" +
                prefix + "/lib/cmake/Tandem'",
            folder.path()),
      0);
  EXPECT_THAT(text_of(folder.path() / "log"), HasSubstr("There is no component 'cores'"));
}

TEST(Library, RunsInARootThatHasNothingButWhatThePackagesName) {
  const Folder folder;
  const std::string clean = "/usr/bin/python3 '" + kTop + "/tests/library/clean_root.py'";
  ASSERT_EQ(shell("cpack --config '" + kBuild + "/CPackConfig.cmake' -G DEB -B packages", folder.path()), 0)
      << text_of(folder.path() / "log");
  ASSERT_EQ(
      shell(clean + " packages/tandem_*.deb root tandem run /usr/share/tandem/configs/epuck_diffusion.xml --seed 7 "
                    "--steps 50 --picture /tmp/end.png --report -",
            folder.path()),
      0)
      << text_of(folder.path() / "log");
  EXPECT_EQ("0x" + fingerprint_of_run(), scenarios::json_value(text_of(folder.path() / "log"), "state_hash"));
  EXPECT_GT(fs::file_size(folder.path() / "root/tmp/end.png"), 1000U);
  const int code =
      shell("/usr/bin/python3 '" + kTop + "/tests/library/bare_root.py' '" + kTop + "/Containerfile' packages " +
                "run /usr/share/tandem/configs/epuck_diffusion.xml --seed 7 --steps 50 " +
                "-- /usr/bin/python3 -c \"import tandem; print('imported', tandem.__version__)\"",
            folder.path());
  const std::string log = text_of(folder.path() / "log");
  if (code == kNotTried) {
    std::cout << log;  // no archive answers, or there is no mmdebstrap
  } else {
    ASSERT_EQ(code, 0) << log;
    EXPECT_THAT(log, HasSubstr("0x" + fingerprint_of_run()));
    EXPECT_THAT(log, HasSubstr("imported "));
  }
  for (const char* what : {"./usr/include/tandem/core/sim/world.hpp", "./usr/lib/cmake/Tandem/TandemConfig.cmake",
                           "./usr/lib/libtandem.so"}) {
    EXPECT_EQ(shell(std::string("dpkg-deb -c packages/libtandem-dev_*.deb | grep -q ' ") + what + "'", folder.path()),
              0)
        << what;
  }
}

}  // namespace
}  // namespace tandem
