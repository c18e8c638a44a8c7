// E-pucks in a network, as a user drives them: through a serial server, and an e-puck2's own radio. Verdicts come from
// the robot's own log.
#include <gmock/gmock.h>

#include "tests/checkout.hpp"
#include "tests/scenarios/free_port.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem::scenarios {
namespace {

using testing::HasSubstr;

const std::string kRobot = std::string(test::kSourceDir) + "/configs/epuck_robot.xml";

class EmulatedEpuckOnTcp : public EmulatedRobot {
 public:
  EmulatedEpuckOnTcp(const Folder& folder, const std::string& robot, const std::string& link,
                     const std::vector<std::string>& more = {})
      : EmulatedRobot(folder, robot, link, more) {}
  /// What a host gives as its link.
  std::string link() const {
    const std::string text = errors();
    const std::size_t at = text.find("--link ") + 7;
    return text.substr(at, text.find(';', at) - at);
  }
};

/// A program of the system, ended with this.
class Program {
 public:
  explicit Program(std::vector<std::string> words) {
    std::vector<char*> argv;
    for (std::string& w : words) argv.push_back(w.data());
    argv.push_back(nullptr);
    if (posix_spawnp(&pid_, argv[0], nullptr, nullptr, argv.data(), environ) != 0) pid_ = -1;
  }
  ~Program() {
    if (pid_ <= 0) return;
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  bool runs() const { return pid_ > 0 && waitpid(pid_, nullptr, WNOHANG) == 0; }

 private:
  pid_t pid_ = -1;
};

bool installed(const std::string& program) {
  for (const char* folder : {"/usr/bin/", "/usr/sbin/", "/bin/", "/sbin/"}) {
    if (fs::exists(folder + program)) return true;
  }
  return false;
}

struct Way {
  std::string name, robot, link;
};

class OverTcp : public testing::TestWithParam<Way> {
 protected:
  std::unique_ptr<EmulatedEpuckOnTcp> emulated(const std::vector<std::string>& more = {}) const {
    auto epuck = std::make_unique<EmulatedEpuckOnTcp>(robot_folder, GetParam().robot, GetParam().link, more);
    EXPECT_TRUE(epuck->ready());
    return epuck;
  }
  Folder robot_folder, hub_folder;
};

TEST_P(OverTcp, IsDrivenAndEndsStopped) {
  const auto epuck = emulated();
  Tandem hub({"robot", kRobot, "--link", epuck->link(), "--seconds", "3"}, hub_folder.path());
  EXPECT_EQ(hub.wait(), 0) << hub.errors();
  EXPECT_TRUE(epuck->has_moved());
  EXPECT_FALSE(epuck->moves()) << epuck->log();
}

TEST_P(OverTcp, IsStoppedWhenTheHubIsKilled) {
  const auto epuck = emulated();
  Tandem hub({"robot", kRobot, "--link", epuck->link()}, hub_folder.path());
  ASSERT_TRUE(eventually([&] { return epuck->moves(); }, 30.0)) << hub.errors();
  hub.signal(SIGKILL);
  EXPECT_EQ(hub.wait(), -SIGKILL);
  EXPECT_TRUE(eventually([&] { return !epuck->moves(); }, 5.0));
  std::this_thread::sleep_for(std::chrono::seconds(1));  // and it stays so
  EXPECT_FALSE(epuck->moves());
}

// The robot hears one host at a time, and the frozen one stays connected.
TEST_P(OverTcp, IsStoppedWhileTheHubIsFrozenAndFoundAgain) {
  const auto epuck = emulated();
  Tandem hub({"robot", kRobot, "--link", epuck->link()}, hub_folder.path());
  ASSERT_TRUE(eventually([&] { return epuck->moves(); }, 30.0)) << hub.errors();
  hub.signal(SIGSTOP);
  EXPECT_TRUE(eventually([&] { return !epuck->moves(); }, 5.0));
  std::this_thread::sleep_for(std::chrono::seconds(1));
  EXPECT_FALSE(epuck->moves());
  hub.signal(SIGCONT);
  EXPECT_TRUE(waits_for_a_person(hub, [&] { return epuck->moves(); }));
  EXPECT_THAT(hub.errors(), HasSubstr("was frozen"));
  hub.signal(SIGINT);
  EXPECT_EQ(hub.wait(), 128 + SIGINT) << hub.errors();
  EXPECT_FALSE(epuck->moves());
}

TEST_P(OverTcp, ComesBackAfterTheConnectionIsLost) {
  const auto epuck = emulated({"--fault", "hangup@drive+2s+1s"});
  Tandem hub({"robot", kRobot, "--link", epuck->link()}, hub_folder.path());
  ASSERT_TRUE(eventually([&] { return epuck->moves(); }, 30.0)) << hub.errors();
  ASSERT_TRUE(eventually([&] { return hub.errors().find("hung up") != std::string::npos; }, 15.0)) << hub.errors();
  EXPECT_TRUE(eventually([&] { return !epuck->moves(); }, 30.0));
  EXPECT_TRUE(waits_for_a_person(hub, [&] { return epuck->moves(); }));
  hub.signal(SIGINT);
  EXPECT_EQ(hub.wait(), 128 + SIGINT) << hub.errors();
  EXPECT_FALSE(epuck->moves());
}

TEST_P(OverTcp, SaysWhatIsWrongWhereNobodyListens) {
  const std::string link = GetParam().name == "radio" ? "epuck-tcp:127.0.0.1:" : "tcp:127.0.0.1:";
  Tandem hub({"robot", kRobot, "--link", link + std::to_string(free_port(SOCK_STREAM))}, hub_folder.path());
  ASSERT_TRUE(eventually([&] { return hub.errors().find("nobody listens there") != std::string::npos; }, 15.0))
      << hub.errors();
  hub.signal(SIGINT);
  hub.wait();
}

INSTANTIATE_TEST_SUITE_P(Ways, OverTcp,
                         testing::Values(Way{"radio", "epuck2", "epuck-tcp-listen:0"},
                                         Way{"serial", "epuck", "tcp-listen:0"},
                                         Way{"serial_of_an_epuck2", "epuck2", "tcp-listen:0"}),
                         [](const auto& way) { return way.param.name; });

TEST(Inspect, ReadsAnEpuck2OverItsRadio) {
  Folder folder;
  EmulatedEpuckOnTcp epuck(folder, "epuck2", "epuck-tcp-listen:0", {"--selector", "15"});
  ASSERT_TRUE(epuck.ready());
  Tandem inspect({"inspect", epuck.link(), "--seconds", "1"}, folder.path());
  EXPECT_EQ(inspect.wait(), 0) << inspect.errors();
  EXPECT_THAT(inspect.output(), HasSubstr("time_of_flight"));
  EXPECT_THAT(inspect.output(), HasSubstr("position=15"));
  EXPECT_FALSE(epuck.has_moved());
}

TEST(Inspect, ReadsAnEpuckBehindASerialServerWhenToldThatItIsOne) {
  Folder folder;
  EmulatedEpuckOnTcp epuck(folder, "epuck", "tcp-listen:0");
  ASSERT_TRUE(epuck.ready());
  Tandem inspect({"inspect", epuck.link(), "--as", "e-puck", "--seconds", "1"}, folder.path());
  EXPECT_EQ(inspect.wait(), 0) << inspect.errors();
  EXPECT_THAT(inspect.output(), HasSubstr("GCtronic"));
  Tandem nobody({"inspect", epuck.link(), "--as", "e-pukc"}, folder.path());
  EXPECT_EQ(nobody.wait(), 1);
  EXPECT_THAT(nobody.errors(), HasSubstr("nobody inspects a 'e-pukc'"));
}

/// Drives an emulated e-puck on a pseudo-terminal through a program that serves it at `port`, kills the hub, and lets a
/// second one drive: the program serves one host at a time.
void drive_through(const std::vector<std::string>& server, int port, Folder& folder, const EmulatedEpuck& epuck) {
  Program program(server);
  const std::string link = "tcp:127.0.0.1:" + std::to_string(port);
  {
    Tandem hub({"robot", kRobot, "--link", link}, folder.path());
    ASSERT_TRUE(eventually([&] { return epuck.moves(); }, 20.0)) << hub.errors();
    ASSERT_TRUE(program.runs());
    hub.signal(SIGKILL);
    hub.wait();
    EXPECT_TRUE(eventually([&] { return !epuck.moves(); }, 5.0)) << epuck.log();
  }
  Tandem again({"robot", kRobot, "--link", link, "--seconds", "2"}, folder.path());
  EXPECT_EQ(again.wait(), 0) << again.errors();
  EXPECT_FALSE(epuck.moves());
}

TEST(SerialServer, Ser2netCarriesAnEpucksBytes) {
  if (!installed("ser2net")) GTEST_SKIP() << "the package ser2net is not installed";
  Folder folder, robot_folder;
  EmulatedEpuck epuck(robot_folder);
  ASSERT_TRUE(epuck.ready());
  const int port = free_port(SOCK_STREAM);
  const fs::path config =
      folder.write("ser2net.yaml", "connection: &epuck\n  accepter: tcp,127.0.0.1," + std::to_string(port) +
                                       "\n  connector: serialdev," +
                                       fs::canonical(robot_folder.path() / "ep0").string() + ",115200n81,local\n");
  drive_through({"ser2net", "-n", "-u", "-c", config.string()}, port, folder, epuck);
}

TEST(SerialServer, SocatCarriesAnEpucksBytes) {
  if (!installed("socat")) GTEST_SKIP() << "the package socat is not installed";
  Folder folder, robot_folder;
  EmulatedEpuck epuck(robot_folder);
  ASSERT_TRUE(epuck.ready());
  const int port = free_port(SOCK_STREAM);
  drive_through({"socat", "TCP-LISTEN:" + std::to_string(port) + ",bind=127.0.0.1,reuseaddr,fork,max-children=1",
                 "FILE:" + fs::canonical(robot_folder.path() / "ep0").string() + ",raw,echo=0,b115200"},
                port, folder, epuck);
}

}  // namespace
}  // namespace tandem::scenarios
