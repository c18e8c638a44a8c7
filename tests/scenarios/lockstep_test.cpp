// Runs in lock-step as a user starts them: a hub, and peers in processes of their own.
#include <fstream>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include "tests/checkout.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem::scenarios {
namespace {

using testing::HasSubstr;

const std::string kConfig = std::string(test::kSourceDir) + "/configs/lockstep.xml";

/// The experiment with so many peers and ticks; any port that is free.
std::string experiment(int peers, double seconds, const std::string& time = R"(listen="127.0.0.1:0" timeout="30 s")") {
  std::string text = text_of(kConfig);
  const auto replace = [&text](const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
  };
  replace(R"(listen="127.0.0.1:7654" timeout="30 s")", time);
  replace(R"(length="60")", "length=\"" + std::to_string(seconds) + "\"");
  replace(R"(quantity="2")", "quantity=\"" + std::to_string(peers) + "\"");
  return text;
}

/// A hub that has told where peers connect.
class Hub {
 public:
  Hub(const Folder& folder, const std::string& text, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"run", folder.write("hub.xml", text).string(), "--report", "hub.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    process_ = std::make_unique<Tandem>(arguments, folder.path());
    const std::string mark = "peers connect to ";
    EXPECT_TRUE(eventually(
        [&] {
          return process_->errors().find("\n", process_->errors().find(mark)) != std::string::npos &&
                 process_->errors().find(mark) != std::string::npos;
        },
        20.0))
        << process_->errors();
    const std::string said = process_->errors();
    const std::size_t at = said.find(mark) + mark.size();
    address_ = said.substr(at, said.find('\n', at) - at);
  }
  std::string link() const { return "peer:" + address_; }
  std::string port() const { return address_.substr(address_.rfind(':') + 1); }
  Tandem& process() { return *process_; }

 private:
  std::unique_ptr<Tandem> process_;
  std::string address_;
};

std::string hash_in(const fs::path& report) {
  return json_value(text_of(report), "state_hash");
}

/// The fingerprint at the end of the same in pure simulation.
std::string simulated(const Folder& folder, const std::string& file = "hub.xml") {
  Tandem run({"run", file, "--set", "framework.time.mode=fast", "--report", "pure.json"}, folder.path());
  EXPECT_EQ(run.wait(), 0) << run.errors();
  EXPECT_THAT(run.errors(), HasSubstr("<peer> has no effect"));
  return hash_in(folder.path() / "pure.json");
}

/// With TANDEM_PEER="qemu-arm … build/armel/bin/tandem" and TANDEM_PEER_PLUGINS=build/armel/lib the first of the peers
/// is that program.
class ForeignPeer {
 public:
  ForeignPeer(const std::string& file, const std::string& link) {
    const char* const words = std::getenv("TANDEM_PEER");
    const char* const plugins = std::getenv("TANDEM_PEER_PLUGINS");
    if (words == nullptr) return;
    const std::string command = (plugins != nullptr ? "TANDEM_PLUGIN_PATH=" + std::string(plugins) + " " : "") + words +
                                " robot " + file + " --robot ep0 --link " + link;
    pipe_ = popen(command.c_str(), "r");
  }
  ~ForeignPeer() {
    if (pipe_ != nullptr) {
      EXPECT_EQ(pclose(pipe_), 0);
    }
  }
  bool there() const { return pipe_ != nullptr; }

 private:
  FILE* pipe_ = nullptr;
};

TEST(LockstepRun, HasTheFingerprintOfTheSimulation) {
  const char* const asked = std::getenv("TANDEM_PEERS");
  const int count = asked != nullptr ? std::stoi(asked) : 4;
  Folder folder;
  Hub hub(folder, experiment(count, 30.0));
  std::vector<std::unique_ptr<Tandem>> peers;
  const ForeignPeer board((folder.path() / "hub.xml").string(), hub.link());
  for (int i = board.there() ? 1 : 0; i < count; ++i)
    peers.push_back(std::make_unique<Tandem>(
        std::vector<std::string>{"robot", "hub.xml", "--link", hub.link(), "--robot", "ep" + std::to_string(i)},
        folder.path()));
  ASSERT_EQ(hub.process().wait(120.0), 0) << hub.process().errors();
  const std::string report = text_of(folder.path() / "hub.json");
  EXPECT_EQ(hash_in(folder.path() / "hub.json"), simulated(folder)) << report;
  EXPECT_EQ(json_value(report, "state", report.find("\"lockstep\"")), "in step") << report;
  EXPECT_EQ(json_value(report, "doubled"), "0");
  for (const auto& p : peers) {
    EXPECT_EQ(p->wait(), 0) << p->errors();
    EXPECT_THAT(p->output(), HasSubstr("the run is over"));
    EXPECT_THAT(p->output(), HasSubstr("300 answered"));
  }
  std::cout << count << " peers: 30 s in " << json_value(report, "wall_s") << " s\n";
}

TEST(LockstepRun, TakesAPeerThatWasWrittenFromTheDocumentAlone) {
  Folder folder;
  std::string text = experiment(2, 20.0);
  const std::string own =
      R"(<puppet id="elsewhere" library="puppet"><actuators><differential_steering/><leds/><body_led/><front_led/></actuators>
    <sensors><proximity/><light/><ground/><accelerometer/><microphones/><battery/></sensors></puppet></controllers>)";
  text.replace(text.find("</controllers>"), 14, own);
  text.replace(text.find(R"(config="diffusion"/><peer/>)"), 27, R"(config="elsewhere"/><peer/>)");
  Hub hub(folder, text);
  const std::string script =
      std::string(test::kSourceDir) + "/tests/scenarios/lockstep_peer.py 127.0.0.1 " + hub.port();
  FILE* const first = popen(("python3 " + script + " ep0").c_str(), "r");
  FILE* const second = popen(("python3 " + script + " ep1").c_str(), "r");
  EXPECT_EQ(hub.process().wait(60.0), 0) << hub.process().errors();
  std::array<char, 64> line{};
  ASSERT_NE(std::fgets(line.data(), line.size(), first), nullptr);
  EXPECT_EQ(std::string(line.data()), "200 the run is over\n");
  EXPECT_EQ(pclose(first), 0);
  EXPECT_EQ(pclose(second), 0);
}

TEST(LockstepRun, PreflightNamesThePeerWhoseScriptIsAnother) {
  const Folder folder, board;
  std::string text = experiment(2, 2.0);
  const std::size_t begin = text.find("<epuck_diffusion"), end = text.find("</controllers>");
  text.replace(begin, end - begin,
               R"(<lua_controller id="diffusion"><actuators><differential_steering/></actuators>
      <sensors><proximity/></sensors><params script="drive.lua"/></lua_controller>)");
  const std::string script = "function init() end\nfunction step() robot.wheels.set_velocity(5, 5) end\n";
  folder.write("drive.lua", script);
  board.write("drive.lua", script + "-- of yesterday\n");
  const auto with_port = [&text](const std::string& port) {
    std::string other = text;
    return other.replace(other.find("127.0.0.1:0"), 11, "127.0.0.1:" + port);
  };
  // A port that is free, which the run is to have after the preflight.
  const int found = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  ASSERT_EQ(bind(found, reinterpret_cast<const sockaddr*>(&address), size), 0);
  ASSERT_EQ(getsockname(found, reinterpret_cast<sockaddr*>(&address), &size), 0);
  const std::string port = std::to_string(ntohs(address.sin_port));
  close(found);
  folder.write("hub.xml", with_port(port));
  board.write("hub.xml", with_port(port));
  const std::string link = "peer:tcp:127.0.0.1:" + port;
  Tandem same({"robot", "hub.xml", "--link", link, "--robot", "ep0"}, folder.path());
  Tandem other({"robot", "hub.xml", "--link", link, "--robot", "ep1"}, board.path());

  Tandem preflight({"preflight", "hub.xml", "--wait", "10"}, folder.path());
  EXPECT_EQ(preflight.wait(60.0), 3) << preflight.errors();
  const std::string table = preflight.output();
  EXPECT_THAT(table, testing::ContainsRegex("ok    peer ep0 +link"));
  EXPECT_THAT(table,
              testing::ContainsRegex("ok    peer ep0 +controller +the same here and there: drive.lua with sha256"));
  EXPECT_THAT(table,
              testing::ContainsRegex("fail  peer ep1 +controller +the peer runs the script drive.lua with sha256"));
  EXPECT_EQ(other.wait(10.0), 3) << "the hub refused it";
  EXPECT_THAT(other.errors(), HasSubstr("another controller: the peer runs the script drive.lua"));

  // The one that was good waits for the run; the other is accepted when the file says so.
  Tandem again({"robot", "hub.xml", "--link", link, "--robot", "ep1"}, board.path());
  Tandem run({"run", "hub.xml", "--set", "framework.time.peers.controllers=any", "--report", "hub.json"},
             folder.path());
  EXPECT_EQ(run.wait(60.0), 0) << run.errors();
  EXPECT_THAT(run.errors(), HasSubstr("peer of robot 'ep1' runs another controller"));
  EXPECT_THAT(json_value(text_of(folder.path() / "hub.json"), "differs"), testing::Not(HasSubstr("ep0")));
  EXPECT_EQ(same.wait(10.0), 0) << same.errors();
  EXPECT_EQ(again.wait(10.0), 0) << again.errors();
}

TEST(LockstepRun, EndsOnCtrlCWhileItWaits) {
  Folder folder;
  Hub hub(folder, experiment(1, 30.0));
  EXPECT_TRUE(eventually(
      [&] { return hub.process().errors().find("robot 'ep0' (nobody has connected)") != std::string::npos; }, 60.0));
  hub.process().signal(SIGINT);
  EXPECT_EQ(hub.process().wait(60.0), 130);
  Hub second(folder, experiment(2, 30.0));
  Tandem peer({"robot", "hub.xml", "--link", second.link(), "--robot", "ep1"}, folder.path());
  EXPECT_TRUE(eventually(
      [&] { return second.process().errors().find("robot 'ep0' (nobody has connected)") != std::string::npos; }, 60.0))
      << second.process().errors();
  peer.signal(SIGTERM);
  EXPECT_EQ(peer.wait(60.0), 143);
  second.process().signal(SIGTERM);
  EXPECT_EQ(second.process().wait(60.0), 143);
}

TEST(LockstepRun, EndsWithThreeWhenAPeerFreezes) {
  Folder folder;
  Hub hub(folder, experiment(1, 3000.0, R"(listen="127.0.0.1:0" timeout="1.5 s")"));
  Tandem peer({"robot", "hub.xml", "--link", hub.link(), "--robot", "*"}, folder.path());
  ASSERT_TRUE(
      eventually([&] { return peer.errors().find("controls robot 'ep0' of hub, seed 1") != std::string::npos; }, 20.0));
  peer.signal(SIGSTOP);
  EXPECT_EQ(hub.process().wait(10.0), 3);
  EXPECT_THAT(hub.process().errors(), HasSubstr("for 0.8 s: robot 'ep0' (at tcp:127.0.0.1:"));
  EXPECT_THAT(hub.process().errors(), HasSubstr("peers did not answer at tick"));
  peer.signal(SIGCONT);
  EXPECT_EQ(peer.wait(10.0), 3) << "the hub said why";
  EXPECT_THAT(peer.errors(), HasSubstr("the run ended early"));
}

TEST(LockstepRun, OverASerialLine) {
  Folder folder;
  // Two ends of a serial line: both pseudo-terminals are opened as devices, and joined here.
  const auto open_pty = [](std::string& name) {
    const int master = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
    grantpt(master);
    unlockpt(master);
    name = ptsname(master);
    return master;
  };
  std::string hubs, peers;
  const int to_hub = open_pty(hubs), to_peer = open_pty(peers);
  std::atomic<bool> over{false};
  std::thread wire([&] {
    int garbled = 0;
    std::array<char, 4096> bytes;
    while (!over) {
      bool idle = true;
      for (const auto& [from, to] : {std::pair(to_hub, to_peer), std::pair(to_peer, to_hub)}) {
        const ssize_t n = read(from, bytes.data(), bytes.size());
        if (n <= 0) continue;
        idle = false;
        if (++garbled % 40 == 0) bytes[static_cast<std::size_t>(n) / 2] ^= 0x10;  // a line that is not quite clean
        for (ssize_t done = 0; done < n;) {
          const ssize_t now = write(to, bytes.data() + done, static_cast<std::size_t>(n - done));
          if (now > 0) done += now;
        }
      }
      if (idle) std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
  });
  std::string text = experiment(1, 6.0);
  text.replace(text.find("<distribute>"), 12,
               R"(<e-puck id="me"><body position="0.5,0.1,0"/><controller config="diffusion"/><peer link="serial:)" +
                   hubs + R"(@115200"/></e-puck><distribute>)");
  text.replace(text.find("<peer/>"), 7, "");
  folder.write("hub.xml", text);
  Tandem hub({"run", "hub.xml", "--report", "hub.json"}, folder.path());
  Tandem peer({"robot", "hub.xml", "--link", "peer:serial:" + peers + "@115200", "--robot", "me"}, folder.path());
  EXPECT_EQ(hub.wait(60.0), 0) << hub.errors() << peer.errors();
  EXPECT_EQ(peer.wait(10.0), 0) << peer.errors();
  over = true;
  wire.join();
  close(to_hub);
  close(to_peer);
  const std::string report = text_of(folder.path() / "hub.json");
  EXPECT_EQ(hash_in(folder.path() / "hub.json"), simulated(folder)) << report;
  EXPECT_GT(std::stoi(json_value(report, "asked_again")), 0) << "frames were garbled: " << report;
}

TEST(LockstepRun, DrivesAFootbotThroughItsBusFasterThanRealTime) {
  Folder folder;
  std::string text = text_of(std::string(test::kSourceDir) + "/configs/footbot_diffusion.xml");
  const std::size_t robot = text.find("<foot-bot");
  ASSERT_NE(robot, std::string::npos);
  const std::size_t framework = text.find("</framework>");
  text.insert(text.find("</foot-bot>", robot),
              "<peer link=\"emulated:" + std::string(test::kSourceDir) + "/configs/footbot_map.xml\"/>");
  text.insert(framework, R"(<time mode="lockstep"/>)");
  text.replace(text.find(R"(quantity="30")"), 13, R"(quantity="2")");
  folder.write("fb.xml", text);
  std::string first;
  for (const char* report : {"a.json", "b.json"}) {
    Tandem run({"run", "fb.xml", "--seconds", "20", "--report", report}, folder.path());
    ASSERT_EQ(run.wait(60.0), 0) << run.errors();
    const std::string said = text_of(folder.path() / report);
    EXPECT_EQ(json_value(said, "state", said.find("\"lockstep\"")), "in step") << said;
    EXPECT_LT(std::stod(json_value(said, "wall_s")), 20.0);
    if (first.empty()) first = hash_in(folder.path() / report);
    EXPECT_EQ(hash_in(folder.path() / report), first) << "twice the same";
  }
}

TEST(LockstepRun, SaysWhatIsWrongWithAFile) {
  Folder folder;
  std::string text = experiment(1, 3.0);
  text.replace(text.find("<peer/>"), 7, R"(<peer link="tcp:localhost:1"/>)");
  folder.write("a.xml", text);
  Tandem distributed({"check", "a.xml"}, folder.path());
  EXPECT_EQ(distributed.wait(), 1);
  EXPECT_THAT(distributed.errors(), HasSubstr("distributed robots leave it out"));
  text = experiment(1, 3.0);
  text.replace(text.find("<peer/>"), 7, "");
  folder.write("b.xml", text);
  Tandem nobody({"check", "b.xml"}, folder.path());
  EXPECT_EQ(nobody.wait(), 1);
  EXPECT_THAT(nobody.errors(), HasSubstr("'lockstep' has nobody to wait for"));
  Tandem no_hub({"robot", kConfig, "--link", "peer:tcp:127.0.0.1"}, folder.path());
  EXPECT_EQ(no_hub.wait(), 1);
  EXPECT_THAT(no_hub.errors(), HasSubstr("no port"));
}

}  // namespace
}  // namespace tandem::scenarios
