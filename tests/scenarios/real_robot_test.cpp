// The command as a user types it, against an emulated robot; verdicts come from the robot's own log.
#include <chrono>
#include <cstdio>
#include <gmock/gmock.h>
#include <memory>

#include "tests/checkout.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem::scenarios {
namespace {

const std::string kConfigs = std::string(test::kSourceDir) + "/configs/";
const std::string kLibraries = std::string(test::kBuildDir) + "/lib/";

std::string printed_by(const std::string& command) {
  std::string text;
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return text;
  char buffer[4096];
  while (const std::size_t n = fread(buffer, 1, sizeof buffer, pipe)) text.append(buffer, n);
  pclose(pipe);
  return text;
}

/// A file for `tandem robot` with a controller of the tests.
std::string robot_file(const std::string& controller, const std::string& params = "",
                       const std::string& timeout = "0.5") {
  return "<tandem><framework><experiment length=\"0\" ticks_per_second=\"20\"/></framework><controllers><" +
         controller +
         " id=\"c\" "
         "library=\"test_controllers\"><actuators><differential_steering/></actuators><sensors><proximity/></"
         "sensors><params " +
         params + "/></" + controller +
         "></controllers><arena size=\"2,2,1\"><e-puck id=\"ep0\"><body position=\"0,0,0\"/><controller config=\"c\"/>"
         "<bridge link=\"serial:ep0\" timeout=\"" +
         timeout + "\"/></e-puck></arena></tandem>";
}

TEST(OneController, RunsInThreeWorldsFromOneFile) {
  Folder folder;
  EmulatedEpuck epuck(folder);
  ASSERT_TRUE(epuck.ready());

  Tandem simulated({"run", kConfigs + "epuck_diffusion.xml", "--seconds", "5", "--report", "simulated.json"},
                   folder.path());
  ASSERT_EQ(simulated.wait(), 0) << simulated.errors();
  Tandem real({"robot", kConfigs + "epuck_robot.xml", "--seconds", "2", "--report", "real.json"}, folder.path());
  ASSERT_EQ(real.wait(), 0) << real.errors();
  Tandem mixed({"run", kConfigs + "epuck_mixed.xml", "--seconds", "2", "--report", "mixed.json", "--set",
                "controllers.obstacle_avoidance.library=obstacle_avoidance"},
               folder.path());
  ASSERT_EQ(mixed.wait(), 0) << mixed.errors();
  std::string mixed_diffusion = text_of(kConfigs + "epuck_mixed.xml");
  for (std::size_t at; (at = mixed_diffusion.find("obstacle_avoidance")) != std::string::npos;)
    mixed_diffusion.replace(at, 18, "epuck_diffusion");
  const std::size_t params = mixed_diffusion.find("<params");
  mixed_diffusion.erase(params, mixed_diffusion.find("/>", params) + 2 - params);
  folder.write("mixed.xml", mixed_diffusion);
  Tandem both({"run", "mixed.xml", "--seconds", "2", "--report", "both.json"}, folder.path());
  ASSERT_EQ(both.wait(), 0) << both.errors();

  const std::string digest = printed_by("sha256sum " + kLibraries + "libepuck_diffusion.so").substr(0, 64);
  ASSERT_EQ(digest.size(), 64U);
  EXPECT_THAT(text_of(folder.path() / "simulated.json"), testing::HasSubstr(digest));
  EXPECT_THAT(text_of(folder.path() / "real.json"), testing::HasSubstr(digest));
  EXPECT_THAT(text_of(folder.path() / "both.json"), testing::HasSubstr(digest));
  EXPECT_TRUE(epuck.has_moved());
  EXPECT_FALSE(epuck.moves());
}

TEST(OneController, NeedsNoSymbolOfAnyWorld) {
  for (const char* name : {"epuck_diffusion", "obstacle_avoidance"}) {
    const std::string symbols = printed_by("nm -DC " + kLibraries + "lib" + name + ".so");
    ASSERT_NE(symbols.find("tandem_plugin"), std::string::npos) << symbols;
    for (const char* world : {"tandem::core", "tandem::bridges", "tandem::mixed_reality", "tandem::app"}) {
      EXPECT_EQ(symbols.find(world), std::string::npos) << name << " knows " << world;
    }
    // Nothing of ours is left open: what it needs comes from the standard library.
    const std::string open = printed_by("nm -DCu " + kLibraries + "lib" + name + ".so");
    EXPECT_EQ(open.find("tandem"), std::string::npos) << open;
  }
}

class EndsStopped : public testing::TestWithParam<int> {};

TEST_P(EndsStopped, OnSignals) {
  Folder folder;
  EmulatedEpuck epuck(folder);
  ASSERT_TRUE(epuck.ready());
  Tandem robot({"robot", kConfigs + "epuck_robot.xml"}, folder.path());
  ASSERT_TRUE(eventually([&] { return epuck.moves(); }, 30.0)) << robot.errors();
  robot.signal(GetParam());
  EXPECT_EQ(robot.wait(), 128 + GetParam()) << robot.errors();
  EXPECT_FALSE(epuck.moves());
}

TEST_P(EndsStopped, OnSignalsInAMixedRun) {
  Folder folder;
  EmulatedEpuck epuck(folder);
  ASSERT_TRUE(epuck.ready());
  Tandem run({"run", kConfigs + "epuck_mixed.xml"}, folder.path());
  ASSERT_TRUE(eventually([&] { return epuck.moves(); }, 30.0)) << run.errors();
  run.signal(GetParam());
  EXPECT_EQ(run.wait(), 128 + GetParam()) << run.errors();
  EXPECT_FALSE(epuck.moves());
}

INSTANTIATE_TEST_SUITE_P(Signals, EndsStopped, testing::Values(SIGINT, SIGTERM));

TEST(Robot, IsRecordedAndWatchedLikeARun) {
  Folder folder;
  EmulatedEpuck epuck(folder);
  ASSERT_TRUE(epuck.ready());
  Tandem robot({"robot", kConfigs + "epuck_robot.xml", "--seconds", "3", "--record", "r.record", "--watch"},
               folder.path());
  ASSERT_EQ(robot.wait(), 0) << robot.errors();
  EXPECT_THAT(robot.errors(), testing::ContainsRegex("t = [1-9].* 1 e-puck"));
  EXPECT_FALSE(epuck.moves());

  Tandem contents({"export", "r.record"}, folder.path());
  ASSERT_EQ(contents.wait(), 0) << contents.errors();
  for (const char* table : {"'pose': ticks 0 to 29, 30 of them, 1 rows", "'sensor proximity'",
                            "'actuator differential_steering'", "'sensor wheel_encoders'", "length"})
    EXPECT_THAT(contents.output(), testing::HasSubstr(table));
  Tandem table({"export", "r.record", "--csv", "poses.csv", "--from", "29"}, folder.path());
  ASSERT_EQ(table.wait(), 0) << table.errors();
  EXPECT_THAT(text_of(folder.path() / "poses.csv"), testing::Not(testing::HasSubstr("ep0,0.000000,0.000000,")))
      << "its wheels say where it went";
  Tandem dump({"export", "r.record", "--dump", "d.csv", "--from", "29"}, folder.path());
  ASSERT_EQ(dump.wait(), 0) << dump.errors();
  EXPECT_THAT(text_of(folder.path() / "d.csv"), testing::ContainsRegex("30,robot ep0,sensor proximity,distance"));
  Tandem picture({"picture", "r.record", "-o", "p.svg"}, folder.path());
  EXPECT_EQ(picture.wait(), 0) << picture.errors();
}

TEST(Robot, IsStoppedWhenTheHubIsKilled) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"robot", kConfigs + "epuck_robot.xml"}, {"run", kConfigs + "epuck_mixed.xml"}}) {
    Folder folder;
    EmulatedEpuck epuck(folder);
    ASSERT_TRUE(epuck.ready());
    Tandem hub(arguments, folder.path());
    ASSERT_TRUE(eventually([&] { return epuck.moves(); }, 30.0)) << hub.errors();
    hub.signal(SIGKILL);
    EXPECT_EQ(hub.wait(), -SIGKILL);
    EXPECT_TRUE(eventually([&] { return !epuck.moves(); }, 5.0)) << epuck.log();
    std::this_thread::sleep_for(std::chrono::seconds(1));  // and it stays so
    EXPECT_FALSE(epuck.moves());
  }
}

TEST(Robot, AControllerThatThrowsLeavesItStopped) {
  Folder folder;
  EmulatedEpuck epuck(folder);
  ASSERT_TRUE(epuck.ready());
  folder.write("thrower.xml", robot_file("thrower"));
  Tandem robot({"robot", "thrower.xml"}, folder.path());
  EXPECT_EQ(robot.wait(), 3);
  EXPECT_NE(robot.errors().find("'ep0' threw at tick 3: lost my way"), std::string::npos) << robot.errors();
  EXPECT_TRUE(epuck.has_moved());
  EXPECT_FALSE(epuck.moves());
}

TEST(Robot, ACommandThatIsNoNumberNeverReachesIt) {
  Folder folder;
  EmulatedEpuck epuck(folder);
  ASSERT_TRUE(epuck.ready());
  folder.write("careless.xml", robot_file("careless"));
  Tandem robot({"robot", "careless.xml", "--seconds", "2", "--report", "r.json"}, folder.path());
  EXPECT_EQ(robot.wait(), 0) << robot.errors();
  EXPECT_GT(std::stoi("0" + json_value(text_of(folder.path() / "r.json"), "commands_not_finite")), 10);
  for (const auto& w : epuck.wheels()) {
    EXPECT_LE(std::abs(w.left), 1000);
    EXPECT_LE(std::abs(w.right), 1000);
  }
  EXPECT_FALSE(epuck.moves());
}

TEST(Robot, IsStoppedAfterALinkLossAndDrivesAgainWhenAPersonReArmsIt) {
  Folder folder;
  const std::string fault = "hangup@drive+1s+1s";
  EmulatedEpuck epuck(folder, {"--fault", fault});
  ASSERT_TRUE(epuck.ready());
  Tandem robot({"robot", kConfigs + "epuck_robot.xml", "--report", "r.json"}, folder.path());
  ASSERT_TRUE(eventually([&] { return epuck.fault_ns(fault, "end") > 0; }, 40.0)) << robot.errors();
  const long long back_ns = epuck.fault_ns(fault, "end");
  // After the line came back the first thing that the robot obeys is a stop; later it drives again.
  const auto since = [&] {
    auto all = epuck.wheels();
    std::erase_if(all, [&](const auto& w) { return w.t_ns < back_ns; });
    return all;
  };
  ASSERT_TRUE(eventually([&] { return !since().empty(); }, 20.0)) << robot.errors();
  const auto first = since().front();
  EXPECT_TRUE(first.left == 0 && first.right == 0) << first.left << " " << first.right;
  EXPECT_TRUE(waits_for_a_person(robot, [&] { return epuck.moves(); }));
  EXPECT_NE(robot.errors().find("its device was opened anew; 'Version"), std::string::npos) << robot.errors();
  robot.signal(SIGINT);
  EXPECT_EQ(robot.wait(), 130) << robot.errors();
  EXPECT_GE(std::stoi("0" + json_value(text_of(folder.path() / "r.json"), "links_lost")), 1);
  EXPECT_FALSE(epuck.moves());
}

TEST(Robot, SurvivesSilenceGarbageAndRestarts) {
  Folder folder;
  const std::string reset = "reset@drive+5s", drop = "drop=0.002@drive+0s+6s";
  EmulatedEpuck epuck(folder, {"--fault", "silent@drive+1s+1s", "--fault", "garbage@drive+3s+500ms", "--fault", reset,
                               "--fault", drop});
  ASSERT_TRUE(epuck.ready());
  Tandem robot({"robot", kConfigs + "epuck_robot.xml", "--report", "r.json"}, folder.path());
  ASSERT_TRUE(eventually([&] { return epuck.moves(); }, 30.0)) << robot.errors();  // from now on it takes the signal
  const auto drives_on = [&] {
    robot.signal(SIGUSR1);  // a person who re-arms it whenever it waits
    const long long over_ns = epuck.fault_ns(drop, "end");
    return over_ns > 0 && epuck.moves() && epuck.wheels().back().t_ns > over_ns;
  };
  EXPECT_TRUE(eventually(drives_on, 60.0)) << robot.errors() << epuck.log();
  robot.signal(SIGINT);
  EXPECT_EQ(robot.wait(), 130) << robot.errors();
  const std::string report = text_of(folder.path() / "r.json");
  EXPECT_GE(std::stoi("0" + json_value(report, "resynchronised")), 1) << report;
  EXPECT_GE(std::stoi("0" + json_value(report, "restarts")), 1) << report;
  EXPECT_EQ(json_value(report, "state"), "active") << report;
  EXPECT_FALSE(epuck.moves());
}

TEST(Robot, SaysWhatIsWrongWithAPort) {
  Folder folder;
  const auto fails = [&](const std::vector<std::string>& arguments, int code, const std::string& part) {
    Tandem robot(arguments, folder.path());
    EXPECT_EQ(robot.wait(60), code) << robot.errors();
    EXPECT_NE(robot.errors().find(part), std::string::npos) << robot.errors();
  };
  fails({"robot", kConfigs + "epuck_robot.xml", "--link", "serial:/dev/no_such_port"}, 3, "/dev/no_such_port");
  fails({"robot", kConfigs + "epuck_robot.xml", "--link", "serial:ep0@12345"}, 1, "12345");
  fails({"robot", kConfigs + "epuck_robot.xml", "--link", "cereal:ep0"}, 1, "cereal");
  fails({"robot", kConfigs + "epuck_diffusion.xml"}, 1, "<bridge");
  folder.write("plain.txt", "not a port");
  fails({"inspect", "serial:plain.txt"}, 3, "plain.txt");
}

TEST(Robot, AWrongBaudRateIsNamedAndMovesNothing) {
  Folder folder;
  EmulatedEpuck epuck(folder);
  ASSERT_TRUE(epuck.ready());
  Tandem robot({"robot", kConfigs + "epuck_robot.xml", "--link", "serial:ep0@57600"}, folder.path());
  EXPECT_EQ(robot.wait(60), 1);
  EXPECT_NE(robot.errors().find("115200 baud, not with 57600"), std::string::npos) << robot.errors();
  EXPECT_FALSE(epuck.has_moved());
}

TEST(Robot, WithAnotherFirmwareThanTheFileSaysIsRefused) {
  Folder folder;
  EmulatedEpuck epuck(folder);
  ASSERT_TRUE(epuck.ready());
  std::string file = text_of(kConfigs + "epuck_robot.xml");
  file.replace(file.find("firmware=\"auto\""), 15, "firmware=\"webots\"");
  folder.write("webots.xml", file);
  Tandem robot({"robot", "webots.xml"}, folder.path());
  EXPECT_EQ(robot.wait(), 3);
  EXPECT_NE(robot.errors().find("GCtronic', not 'webots'"), std::string::npos) << robot.errors();
  EXPECT_FALSE(epuck.has_moved());
}

TEST(MixedRun, TellsInItsRecordWhichSlotsOfItsScheduleWereLeftOutAndWhen) {
  Folder folder;
  EmulatedEpuck epuck(folder);
  ASSERT_TRUE(epuck.ready());
  const auto date_ns = [] {
    return std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count();
  };
  const long long before_ns = date_ns();
  Tandem run({"run", kConfigs + "epuck_mixed.xml", "--seconds", "3", "--quiet", "--record", "run.record", "--report",
              "run.json", "--hub-fault", "stall@1s+0.45s"},
             folder.path());
  ASSERT_EQ(run.wait(), 0) << run.errors();
  const std::string record = text_of(folder.path() / "run.record");
  const std::string mark = "\"kind\":\"skipped\"";
  long long slots = 0;
  for (std::size_t at = record.find(mark); at != std::string::npos; at = record.find(mark, at + 1)) {
    slots += std::stoll(json_value(record, "slots", at));
    const long long unix_ns = std::stoll(json_value(record, "unix_ns", at));
    EXPECT_GT(unix_ns, before_ns);
    EXPECT_LT(unix_ns, date_ns());
  }
  EXPECT_GE(slots, 3) << "0.45 s are slots of 0.1 s";
  EXPECT_EQ(std::to_string(slots), json_value(text_of(folder.path() / "run.json"), "skipped_slots"));
}

TEST(Inspect, ReadsEverythingAndMovesNothing) {
  Folder folder;
  EmulatedEpuck epuck(folder, {"--firmware", "epuck2"});
  ASSERT_TRUE(epuck.ready());
  Tandem inspect({"inspect", "serial:ep0", "--seconds", "1"}, folder.path());
  ASSERT_EQ(inspect.wait(), 0) << inspect.errors();
  EXPECT_NE(inspect.output().find("Version 2.0 January 2018 GCtronic"), std::string::npos) << inspect.output();
  EXPECT_NE(inspect.output().find("proximity:"), std::string::npos);
  EXPECT_FALSE(epuck.has_moved());
}

TEST(Inspect, WaitsForARobotThatIsSilentWhileItIsLookedAtAndAnswersAgain) {
  Folder folder;
  EmulatedEpuck epuck(folder, {"--fault", "silent@3s+2s"});
  ASSERT_TRUE(epuck.ready());
  Tandem inspect({"inspect", "serial:ep0", "--seconds", "4"}, folder.path());  // its end lies in the silence
  EXPECT_EQ(inspect.wait(60.0), 0) << inspect.output() << inspect.errors();
  EXPECT_NE(inspect.output().find("active"), std::string::npos) << inspect.output();
  EXPECT_FALSE(epuck.has_moved());
}

TEST(Emulator, MayLiveInASimulatedArena) {
  Folder folder;
  folder.write(
      "arena.xml",
      "<tandem><framework><experiment length=\"0\" ticks_per_second=\"20\" random_seed=\"1\"/></framework><controllers>"
      "<puppet id=\"p\" "
      "library=\"puppet\"><actuators><differential_steering/><leds/><body_led/><front_led/></"
      "actuators><sensors><proximity/><light/>"
      "<ground/><accelerometer/><microphones/><battery/></sensors></puppet></controllers><arena size=\"2,2,1\"><box "
      "id=\"wall\" size=\"0.1,2,0.5\">"
      "<body position=\"0.15,0,0\"/></box><e-puck id=\"body\"><body position=\"0,0,0\"/><controller "
      "config=\"p\"/></e-puck></arena></tandem>");
  EmulatedEpuck epuck(folder, {"--arena", "arena.xml"});
  ASSERT_TRUE(epuck.ready());
  // The wall is 6.5 cm ahead of the rim.
  Tandem inspect({"inspect", "serial:ep0", "--seconds", "1"}, folder.path());
  ASSERT_EQ(inspect.wait(), 0) << inspect.errors();
  const std::string output = inspect.output();
  const std::size_t at = output.find("distance=[");
  ASSERT_NE(at, std::string::npos) << output;
  EXPECT_NEAR(std::stod(output.substr(at + 10)), 0.1 / 0.9563 - 0.035, 0.001) << output;
}

}  // namespace
}  // namespace tandem::scenarios
