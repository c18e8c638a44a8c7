// A project of an ARGoS 3 user: built by its own CMake against the compatibility layer, its experiments run in
// simulation, and its libraries drive emulated robots.
#include <cstdlib>
#include <gmock/gmock.h>
#include <sched.h>

#include "tests/checkout.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem {
namespace {

namespace fs = std::filesystem;
using scenarios::Folder;
using scenarios::text_of;
using testing::HasSubstr;

const std::string kHere = std::string(test::kSourceDir) + "/tests/argos_corpus";

/// Runs a shell command in a folder. @returns its exit code; its output is in `log` there.
int shell(const std::string& command, const fs::path& folder) {
  const int status = std::system(("cd '" + folder.string() + "' && (" + command + ") >log 2>&1 </dev/null").c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string build(const std::string& options) {
  return "cmake -S project -B project/build -DCMAKE_PREFIX_PATH='" + std::string(TANDEM_ARGOS_PREFIX) +
         "' -DCMAKE_CXX_COMPILER_LAUNCHER=$(command -v ccache) " + options + " && cmake --build project/build";
}

/// The project, built once as C++11 for all tests.
class ArgosCorpus : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<Folder>();
    fs::copy(kHere + "/project", folder_->path() / "project", fs::copy_options::recursive);
    built_ = shell(build(""), folder_->path()) == 0;
    log_ = text_of(folder_->path() / "log");
    fs::copy_file(std::string(test::kSourceDir) + "/configs/footbot_map.xml", project() / "robots/footbot_map.xml");
  }
  static void TearDownTestSuite() { folder_.reset(); }
  void SetUp() override { ASSERT_TRUE(built_) << log_; }
  static fs::path project() { return folder_->path() / "project"; }

  static inline std::unique_ptr<Folder> folder_;
  static inline bool built_ = false;
  static inline std::string log_;
};

TEST_F(ArgosCorpus, ComesOutAsItsExperimentsSay) {
  const std::string judge =
      "/usr/bin/python3 '" + kHere + "/judge.py' project --tandem '" + test::kBuildDir + "/bin/tandem'";
  EXPECT_EQ(shell(judge, folder_->path()), 0) << text_of(folder_->path() / "log");
}

class ArgosCorpusElsewhere : public testing::TestWithParam<const char*> {};

TEST_P(ArgosCorpusElsewhere, Builds) {
  const Folder folder;
  fs::copy(kHere + "/project", folder.path() / "project", fs::copy_options::recursive);
  EXPECT_EQ(shell(build(std::string("-DCMAKE_CXX_FLAGS=-O0 ") + GetParam()), folder.path()), 0)
      << text_of(folder.path() / "log");
}

INSTANTIATE_TEST_SUITE_P(Ways, ArgosCorpusElsewhere,
                         testing::Values("-DCMAKE_CXX_STANDARD=17 -DCORPUS_FIND=PKGCONFIG",
                                         "-DCMAKE_CXX_STANDARD=20 -DCMAKE_CXX_FLAGS_RELEASE=-Wno-restrict"));

TEST_F(ArgosCorpus, DrivesAnEmulatedEPuckBesideASimulatedOne) {
  const Folder folder;
  scenarios::EmulatedEpuck epuck(folder);
  ASSERT_TRUE(epuck.ready());
  scenarios::Tandem run({"run", "robots/epuck.argos", "--seconds", "3", "--set",
                         "arena.e-puck[ep0].bridge.link=serial:" + (folder.path() / "ep0").string()},
                        project());
  ASSERT_EQ(run.wait(), 0) << run.errors();
  int fastest = 0;
  for (const auto& w : epuck.wheels()) {
    EXPECT_EQ(w.left, w.right);
    fastest = std::max(fastest, w.left);
  }
  EXPECT_NEAR(fastest, 388, 3) << "5 cm/s in steps of 0.129 mm";
  EXPECT_FALSE(epuck.moves());
}

TEST_F(ArgosCorpus, DrivesAnEmulatedFootBot) {
  const Folder folder;
  scenarios::EmulatedFootbot footbot(folder);
  ASSERT_TRUE(footbot.ready());
  const std::string link = "slcan:" + (folder.path() / "fb0").string() + "@1000000";
  scenarios::Tandem robot({"robot", "robots/footbot.argos", "--link", link, "--seconds", "2"}, project());
  ASSERT_EQ(robot.wait(), 0) << robot.errors();
  int fastest = 0;
  for (const auto& w : footbot.wheels()) fastest = std::max(fastest, w.left);
  EXPECT_EQ(fastest, 12) << "5 cm/s in pulses per 5 ms";
  EXPECT_FALSE(footbot.moves());
}

TEST_F(ArgosCorpus, FliesAnEmulatedEyeBot) {
  if (::unshare(CLONE_NEWNET) != 0 || std::system("ip link set lo up && ip route add 224.0.0.0/4 dev lo") != 0)
    GTEST_SKIP() << "this machine does not permit a network of its own (unshare, as root; iproute2)";
  const Folder folder;
  scenarios::EmulatedEyebot eyebot(folder);
  ASSERT_TRUE(eyebot.ready());
  scenarios::Tandem robot({"robot", "robots/eyebot.argos", "--link", scenarios::EmulatedEyebot::kLink}, project());
  const auto is_there = [&] {
    return robot.output().find(".arrived yes") != std::string::npos ||
           robot.errors().find(".arrived yes") != std::string::npos;
  };
  ASSERT_TRUE(scenarios::eventually(is_there, 60.0)) << robot.errors() << eyebot.modes();
  robot.signal(SIGINT);
  ASSERT_EQ(robot.wait(60), 130) << robot.errors();
  EXPECT_THAT(eyebot.modes(), HasSubstr("takeoff"));
  EXPECT_EQ(eyebot.mode(), "idle") << "it has landed";
}

}  // namespace
}  // namespace tandem
