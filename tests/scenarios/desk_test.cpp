// A run with real robots and its desk: preflight, hold, pause, replacement; verdicts come from the robots' own logs.
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <string>

#include "tests/checkout.hpp"
#include "tests/scenarios/free_port.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem::scenarios {
namespace {

constexpr double kPatience_s = 30.0;
constexpr long long kMs = 1'000'000;
const std::string kExperiment = std::string(test::kSourceDir) + "/configs/epuck_mixed.xml";

TEST(Preflight, MovesNothingUnlessToldAndSaysWhatIsInTheWay) {
  const Folder folder;
  Tandem alone({"preflight", kExperiment, "--wait", "4"}, folder.path());
  EXPECT_EQ(alone.wait(), 3) << alone.output() << alone.errors();
  EXPECT_NE(alone.output().find("fail  robot ep0"), std::string::npos) << alone.output();
  EXPECT_NE(alone.output().find("the run would not go well"), std::string::npos) << alone.output();
  EXPECT_NE(alone.errors().find("waiting for robots to answer: 5"), std::string::npos)
      << "after two seconds it says how far it is: " << alone.errors();

  EmulatedEpuck epuck(folder);
  ASSERT_TRUE(epuck.ready());
  Tandem good({"preflight", kExperiment, "--report", "preflight.json"}, folder.path());
  EXPECT_EQ(good.wait(), 0) << good.output() << good.errors();
  EXPECT_NE(good.output().find("the run can begin"), std::string::npos) << good.output();
  EXPECT_NE(text_of(folder.path() / "preflight.json").find("\"check\":\"battery\""), std::string::npos);
  EXPECT_FALSE(epuck.has_moved());

  // A robot that answers too late is not moved; a person tries again then.
  std::string told;
  bool moved = false;
  for (int i = 0; i < 10 && !moved; ++i) {
    const long long from_ns = monotonic_ns();
    Tandem moving({"preflight", kExperiment, "--move", "--yes"}, folder.path());
    moved = moving.wait() == 0;
    told = moving.output() + moving.errors();
    const long long late_ns = epuck.late_ns(from_ns, monotonic_ns());
    if (!moved) {
      ASSERT_GE(late_ns, 100 * kMs) << "its program was not kept from answering: " << told;
    }
  }
  EXPECT_TRUE(moved) << told;
  EXPECT_NE(told.find("by its wheels"), std::string::npos) << told;
  EXPECT_TRUE(epuck.has_moved());
  EXPECT_FALSE(epuck.moves());
  for (const auto& wheels : epuck.wheels()) EXPECT_EQ(wheels.left, -wheels.right) << "it turns on the spot";
}

/// Sees the robot of one emulator's log under the name ep0, from its start to its end.
class Camera {
 public:
  Camera(const Folder& folder, const std::string& port, const std::string& log)
      : process_({"emulate", "tracker", "--link", "udp:127.0.0.1:" + port, "--sees", "ep0=" + log, "--rate", "20",
                  "--clock", "monotonic"},
                 folder.path()) {}

 private:
  Tandem process_;
};

/// The address that a run has printed, for `tandem desk`.
std::string address_of(const Tandem& run) {
  EXPECT_TRUE(eventually([&] { return run.errors().find("?token=") != std::string::npos; }, kPatience_s));
  const std::string text = run.errors();
  const std::size_t at = text.find("http://");
  return at == std::string::npos ? "" : text.substr(at, text.find('\n', at) - at);
}

/// An experiment with one e-puck and a camera, and another e-puck that may wear its tag.
class FirstMotion : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(epuck_.ready() && wrong_.ready());
    std::string text = text_of(kExperiment);
    text.replace(text.find("<tracker source=\"odometry\"/>"), 29, "<tracker source=\"fused\"/>");
    text.replace(text.find("  <physics_engines>"), 0,
                 "  <trackers><udp id=\"cam\" port=\"" + port_ + "\" clock=\"monotonic\"/></trackers>\n");
    file_ = folder_.write("seen.xml", text).string();
  }
  std::string preflight() const {
    Tandem moving({"preflight", file_, "--move", "--yes"}, folder_.path());
    const int code = moving.wait(60.0);
    return std::to_string(code) + " " + moving.output() + moving.errors();
  }
  /// A run that is held before its start, where the desk has it moved until it has turned: one that answers too late is
  /// not moved.
  std::string move_in_held_run() const {
    Tandem held({"run", file_, "--view", "--hold", "--anyway", "--quiet"}, folder_.path());
    const std::string address = address_of(held);
    std::string said;
    for (int i = 0; i < 10 && said.find("turned ") == std::string::npos; ++i) {
      Tandem desk({"desk", address, "move", "ep0"}, folder_.path());
      (void)desk.wait(60.0);
      said = desk.output() + desk.errors();
    }
    held.signal(SIGINT);
    (void)held.wait(60.0);
    return said;
  }
  std::string run(std::vector<std::string> more) const {
    more.insert(more.begin(), {"run", file_, "--set", "framework.experiment.length=2", "--quiet"});
    Tandem driving(more, folder_.path());
    const int code = driving.wait(60.0);
    return std::to_string(code) + " " + driving.errors();
  }
  /// Its tag is on the robot of this folder.
  Camera camera(const Folder& on) const { return {folder_, port_, (on.path() / "witness.jsonl").string()}; }

  const Folder folder_, other_;
  EmulatedEpuck epuck_{folder_, {"--poses", "50"}}, wrong_{other_, {"--poses", "50"}};
  const std::string port_ = std::to_string(free_port(SOCK_DGRAM));
  std::string file_;
};

TEST_F(FirstMotion, ThatFailsKeepsRunsFromDrivingTheRobotUntilOneIsRight) {
  {
    const Camera wrong = camera(other_);
    std::string said;
    for (int i = 0; i < 10 && said.find("turned ") == std::string::npos; ++i) said = preflight();
    EXPECT_EQ(said[0], '3') << said;
  }
  const Camera right = camera(folder_);
  const std::size_t before = epuck_.wheels().size();
  const std::string refused = run({});
  EXPECT_EQ(refused[0], '3') << refused;
  EXPECT_NE(refused.find("robot 'ep0'"), std::string::npos) << refused;
  EXPECT_NE(refused.find("motion: turned"), std::string::npos) << refused;
  EXPECT_NE(refused.find("--anyway"), std::string::npos) << refused;
  for (std::size_t i = before; i < epuck_.wheels().size(); ++i)
    EXPECT_TRUE(epuck_.wheels()[i].left == 0 && epuck_.wheels()[i].right == 0) << "it was not driven";
  EXPECT_EQ(run({"--anyway"})[0], '0');
  EXPECT_EQ(run({})[0], '3') << "still";
  std::string good;
  for (int i = 0; i < 10 && good[0] != '0'; ++i) good = preflight();  // one that answers too late is not moved
  EXPECT_EQ(good[0], '0') << good;
  EXPECT_EQ(run({})[0], '0');
}

TEST_F(FirstMotion, InAHeldRunIsKeptAsThatOfPreflight) {
  {
    const Camera wrong = camera(other_);
    EXPECT_NE(move_in_held_run().find("fail  robot ep0"), std::string::npos);
  }
  const Camera right = camera(folder_);
  EXPECT_EQ(run({})[0], '3');
  EXPECT_NE(move_in_held_run().find("ok    robot ep0"), std::string::npos);
  EXPECT_EQ(run({})[0], '0');
}

TEST(Desk, StartsPausesAndReplacesARobotFromATerminal) {
  const Folder folder, other;
  EmulatedEpuck epuck(folder), spare(other);
  ASSERT_TRUE(epuck.ready());
  ASSERT_TRUE(spare.ready());
  Tandem run({"run", kExperiment, "--view", "--hold", "--set", "framework.experiment.length=0", "--quiet", "--record",
              "run.record", "--report", "report.json"},
             folder.path());
  const std::string address = address_of(run);
  const auto desk = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"desk", address});
    words.insert(words.end(), {"--who", "anna"});
    Tandem said(words, folder.path());
    const int code = said.wait();
    return std::to_string(code) + " " + said.output() + said.errors();
  };
  EXPECT_NE(desk({"status"}).find("waiting for the start"), std::string::npos);
  EXPECT_EQ(desk({"preflight"}).substr(0, 1), "0");
  EXPECT_FALSE(epuck.has_moved());
  EXPECT_NE(desk({"move"}).find("name it"), std::string::npos);
  EXPECT_NE(desk({"move", "nobody"}).find("name it"), std::string::npos);
  EXPECT_FALSE(epuck.has_moved());
  // On a busy machine the robot may answer too late to be moved; a person tries again then.
  std::string told;
  const auto turned = [&] { return (told = desk({"move", "ep0"})).find("ok    robot ep0") != std::string::npos; };
  EXPECT_TRUE(turned() || turned() || turned()) << told;
  EXPECT_NE(told.find("by its wheels"), std::string::npos) << told;
  EXPECT_TRUE(epuck.has_moved());
  EXPECT_FALSE(epuck.moves());
  for (const auto& wheels : epuck.wheels()) EXPECT_EQ(wheels.left, -wheels.right) << "it turns on the spot";
  const std::string started = desk({"start"});
  EXPECT_EQ(started.substr(0, 1), "0");
  EXPECT_NE(started.find("start: the run has done it"), std::string::npos) << started;
  ASSERT_TRUE(eventually([&] { return epuck.moves(); }, kPatience_s)) << run.errors();

  const std::string paused = desk({"pause"});
  EXPECT_NE(paused.find("pause: the run has done it"), std::string::npos) << paused;
  EXPECT_NE(paused.find("is paused"), std::string::npos) << paused << "how its robots are then";
  EXPECT_TRUE(stands_at_once(epuck));
  EXPECT_NE(desk({"status"}).find("paused"), std::string::npos);
  EXPECT_NE(desk({"move", "ep0"}).find("the run has begun"), std::string::npos);
  EXPECT_EQ(desk({"go"}).substr(0, 1), "0");
  ASSERT_TRUE(eventually([&] { return epuck.moves(); }, kPatience_s));

  const std::string refused = desk({"replace", "nobody", "--link", "serial:x"});
  EXPECT_EQ(refused.substr(0, 1), "1");
  EXPECT_NE(refused.find("the run refuses: "), std::string::npos) << refused;
  EXPECT_EQ(refused.find("has done it"), std::string::npos) << refused;
  const std::string link = "serial:" + (other.path() / "ep0").string();
  EXPECT_EQ(desk({"replace", "ep0", "--link", link, "--as", "ep7"}).substr(0, 1), "0");
  EXPECT_TRUE(stands_at_once(epuck));
  EXPECT_TRUE(eventually([&] { return desk({"status"}).find("waits to be armed; is 'ep7'") != std::string::npos; },
                         kPatience_s))
      << desk({"status"});
  EXPECT_FALSE(spare.has_moved());
  EXPECT_NE(desk({"arm", "ep0"}).find("arm ep0: the run has done it"), std::string::npos);
  EXPECT_TRUE(eventually([&] { return spare.moves(); }, kPatience_s)) << run.errors();
  EXPECT_FALSE(epuck.moves());
  EXPECT_EQ(desk({"estop"}).substr(0, 1), "0");
  EXPECT_TRUE(stands_at_once(spare));

  run.signal(SIGINT);
  EXPECT_EQ(run.wait(), 130) << run.errors();
  EXPECT_FALSE(epuck.moves());
  EXPECT_FALSE(spare.moves());
  Tandem events({"export", "run.record"}, folder.path());
  EXPECT_EQ(events.wait(), 0);
}

/// The experiment with a desk over LCM, in this folder.
std::string with_lcm(const Folder& folder, const std::string& url) {
  std::string text = text_of(kExperiment);
  text.insert(text.rfind("</tandem>"), "<desk lcm=\"" + url + "\" hold=\"true\"/>\n");
  const fs::path file = folder.path() / "lcm.xml";
  std::ofstream(file) << text;
  return file.string();
}

constexpr const char* kTwoKeys = "anna operator 1c5d0c1b2ad64ec09d1b\nben viewer 77ab1b6f6b3c4f5e8d21\n";

std::string keys_file(const Folder& folder, const std::string& text) {
  const fs::path file = folder.path() / "desk.keys";
  std::ofstream(file) << text;
  fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write);
  return file.string();
}

TEST(Desk, OverLcmIsForThoseWhoHaveAKeyByTheirRole) {
  const Folder folder;
  EmulatedEpuck epuck(folder);
  ASSERT_TRUE(epuck.ready());
  const std::string url = "udpm://239.255.76.69:7669?ttl=0";
  const std::string keys = keys_file(folder, kTwoKeys);
  Tandem run({"run", with_lcm(folder, url), "--set", "framework.experiment.length=0", "--quiet", "--record",
              "run.record", "--log", "run.log", "--desk-keys", keys},
             folder.path());
  const auto desk = [&](std::vector<std::string> words, const std::string& with) {
    words.insert(words.begin(), {"desk", "lcm:" + url});
    words.insert(words.end(), {"--keys", with});
    Tandem said(words, folder.path());
    const int code = said.wait();
    return std::to_string(code) + " " + said.output() + said.errors();
  };
  std::string told;
  ASSERT_TRUE(eventually(
      [&] {
        return (told = desk({"status", "--who", "anna"}, keys)).find("waiting for the start") != std::string::npos;
      },
      kPatience_s))
      << told << run.errors();
  const Folder other;
  const std::string wrong = keys_file(other, "anna operator ffffffffffffffffffff\n");
  EXPECT_EQ(desk({"start", "--who", "anna"}, wrong).substr(0, 1), "3");
  told = desk({"start", "--who", "ben"}, keys);
  EXPECT_EQ(told.substr(0, 1), "1");
  EXPECT_NE(told.find("needs an operator"), std::string::npos) << told;
  EXPECT_FALSE(epuck.has_moved());
  EXPECT_EQ(desk({"start", "--who", "anna"}, keys).substr(0, 1), "0");
  ASSERT_TRUE(eventually([&] { return epuck.moves(); }, kPatience_s)) << run.errors();
  EXPECT_EQ(desk({"estop", "--who", "ben"}, keys).substr(0, 1), "0");
  EXPECT_TRUE(stands_at_once(epuck));

  run.signal(SIGINT);
  EXPECT_EQ(run.wait(), 130) << run.errors();
  const std::string record = text_of(folder.path() / "run.record"), log = text_of(folder.path() / "run.log");
  EXPECT_NE(record.find(R"("do":"estop","who":"ben","by":{"role":"viewer","address":"lcm"})"), std::string::npos);
  EXPECT_NE(log.find("'ben' (viewer, lcm): estop"), std::string::npos) << log;
  EXPECT_NE(log.find("'anna' (operator, lcm): play"), std::string::npos) << log;
  EXPECT_NE(log.find("'ben' (viewer, lcm): play: refused: 'ben' is a viewer"), std::string::npos) << log;
  EXPECT_EQ(log.find("ffffffff"), std::string::npos);
}

TEST(Desk, TellsInPreflightWhoMayCommandOverLcm) {
  const Folder folder;
  const std::string file = with_lcm(folder, "udpm://239.255.76.72:7672?ttl=0"), keys = keys_file(folder, kTwoKeys);
  const auto preflight = [&] {
    Tandem said({"preflight", file, "--wait", "0", "--listen", "0.1", "--desk-keys", keys}, folder.path());
    EXPECT_EQ(said.wait(), 3) << "its robot is not there";
    return said.output() + said.errors();
  };
  EXPECT_THAT(preflight(),
              testing::ContainsRegex("ok +desk udpm://[^ ]+ +keys +anna \\(operator\\), ben \\(viewer\\)"));
  fs::permissions(keys, fs::perms::others_read, fs::perm_options::add);
  EXPECT_THAT(preflight(), testing::ContainsRegex("fail +desk udpm://[^ ]+ +keys +.*desk.keys"));
}

TEST(Desk, OverLcmWithoutKeysIsForThisUserOnThisMachine) {
  const Folder folder, elsewhere;
  EmulatedEpuck epuck(folder);
  ASSERT_TRUE(epuck.ready());
  const std::string url = "udpm://239.255.76.70:7670?ttl=0";
  const std::string before = std::getenv("XDG_RUNTIME_DIR") != nullptr ? std::getenv("XDG_RUNTIME_DIR") : "";
  ::setenv("XDG_RUNTIME_DIR", folder.path().c_str(), 1);
  ::setenv("XDG_CONFIG_HOME", folder.path().c_str(), 1);
  Tandem run({"run", with_lcm(folder, url), "--set", "framework.experiment.length=0", "--quiet"}, folder.path());
  const auto status = [&] {
    Tandem said({"desk", "lcm:" + url, "status"}, folder.path());
    const int code = said.wait();
    return std::to_string(code) + " " + said.output() + said.errors();
  };
  std::string told;
  EXPECT_TRUE(eventually([&] { return (told = status()).substr(0, 1) == "0"; }, kPatience_s)) << told << run.errors();
  ::setenv("XDG_RUNTIME_DIR", elsewhere.path().c_str(), 1);
  told = status();
  EXPECT_EQ(told.substr(0, 1), "3");
  EXPECT_NE(told.find("--keys FILE"), std::string::npos) << told;
  before.empty() ? ::unsetenv("XDG_RUNTIME_DIR") : ::setenv("XDG_RUNTIME_DIR", before.c_str(), 1);
  ::unsetenv("XDG_CONFIG_HOME");
  run.signal(SIGINT);
  EXPECT_EQ(run.wait(), 130) << run.errors();
  EXPECT_FALSE(epuck.has_moved());
}

}  // namespace
}  // namespace tandem::scenarios
