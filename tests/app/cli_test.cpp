// The command line as a user meets it: exit codes, messages, files.
#include <algorithm>
#include <gtest/gtest.h>
#include <map>
#include <sstream>
#include <sys/stat.h>

#include "app/process/terminal.hpp"
#include "hal/sha256.hpp"
#include "tests/checkout.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem {
namespace {

using scenarios::Folder;
using scenarios::json_value;
using scenarios::Tandem;
using scenarios::text_of;

const std::string kConfigs = std::string(test::kSourceDir) + "/configs/";

TEST(Run, WritesReportPictureAndTrajectory) {
  Folder folder;
  Tandem run({"run", kConfigs + "epuck_diffusion.xml", "--seconds", "3", "--report", "r.json", "--picture", "p.svg",
              "--trajectory", "t.csv"},
             folder.path());
  ASSERT_EQ(run.wait(), 0) << run.errors();
  const std::string report = text_of(folder.path() / "r.json");
  for (const char* key :
       {"experiment", "seed", "threads", "robots", "steps", "virtual_s", "wall_s", "cpu_s", "init_s",
        "ns_per_robot_step", "realtime_factor", "peak_rss_mb", "state_hash", "deadline_misses", "sha256"}) {
    EXPECT_FALSE(json_value(report, key).empty()) << key;
  }
  EXPECT_EQ(json_value(report, "steps"), "30");
  EXPECT_EQ(json_value(report, "robots"), "50");
  EXPECT_EQ(text_of(folder.path() / "p.svg").substr(0, 5), "<?xml");
  EXPECT_EQ(text_of(folder.path() / "t.csv").substr(0, 7), "tick,ti");
  EXPECT_NE(run.output().find("robots"), std::string::npos);
  EXPECT_EQ(run.errors(), "");  // no progress bar where there is no terminal
}

/// The peak of resident memory in the table of a run of `arguments`, in MB; 0: there is none.
double table_MB(const Folder& folder, const std::vector<std::string>& arguments) {
  Tandem run(arguments, folder.path());
  EXPECT_EQ(run.wait(), 0) << run.errors();
  const std::string table = run.output();
  const std::size_t end = table.find(" MB"), begin = table.rfind(' ', end - 1);
  return end == std::string::npos ? 0.0 : std::strtod(table.c_str() + begin, nullptr);
}

TEST(Run, ReadsWholePluginsForReportsAndRecordsAlone) {
  constexpr double kPlugin_MB = 96;
  Folder folder;
  const std::filesystem::path plugin = folder.path() / "libepuck_diffusion.so";
  std::filesystem::copy_file(std::string(test::kBuildDir) + "/lib/libepuck_diffusion.so", plugin);
  std::filesystem::resize_file(plugin, static_cast<std::uintmax_t>(kPlugin_MB * 1e6));
  std::string experiment = text_of(kConfigs + "epuck_diffusion.xml");
  const std::string library = "library=\"epuck_diffusion\"";
  experiment.replace(experiment.find(library), library.size(), "library=\"" + plugin.string() + "\"");
  folder.write("big.xml", experiment);
  const double small_MB = table_MB(folder, {"run", kConfigs + "epuck_diffusion.xml", "--steps", "1"});
  EXPECT_GT(small_MB, 0.0);
  EXPECT_LT(table_MB(folder, {"run", "big.xml", "--steps", "1"}), small_MB + 0.5 * kPlugin_MB);
  EXPECT_GT(table_MB(folder, {"run", "big.xml", "--steps", "1", "--report", "r.json"}), small_MB + 0.5 * kPlugin_MB);
  EXPECT_GT(table_MB(folder, {"run", "big.xml", "--steps", "1", "--record", "r.tdm"}), small_MB + 0.5 * kPlugin_MB);
}

TEST(Run, ReportsWhatRan) {
  Folder folder;
  const std::string experiment = kConfigs + "epuck_diffusion.xml";
  Tandem run({"run", experiment, "--steps", "1", "--report", "-"}, folder.path());
  ASSERT_EQ(run.wait(), 0) << run.errors();
  const std::string report = run.output();
  Tandem version({"--version"}, folder.path());
  ASSERT_EQ(version.wait(), 0);
  EXPECT_EQ(version.output().find(json_value(report, "version")), 0U) << version.output();
  for (const char* key : {"compiler", "build", "processor", "system", "Eigen3", "libtinyxml2"})
    EXPECT_FALSE(json_value(report, key).empty()) << key << " in " << report;
  EXPECT_NE(report.find("\"commit\""), std::string::npos);
  const auto digest = hal::sha256_of_file(experiment);
  ASSERT_TRUE(digest.ok());
  EXPECT_NE(report.find(digest.value()), std::string::npos) << "of the experiment";
  if (const std::string commit = json_value(report, "commit"); !commit.empty()) {
    ASSERT_GE(commit.size(), 40U);
    EXPECT_NE(version.output().find(commit.substr(0, 12)), std::string::npos) << version.output();
  }
}

/// An experiment with one robot whose controller says something in every step.
std::string talking_experiment(const std::string& hook) {
  return R"(<tandem>
  <framework><experiment length="3" ticks_per_second="10" random_seed="1"/></framework>
  <controllers><shown id="c" library="test_controllers">
    <actuators><differential_steering/></actuators><params talks="true"/>
  </shown></controllers>
  )" + hook +
         R"(<arena size="4,4,1"><e-puck id="ep"><body position="0,0,0"/><controller config="c"/></e-puck></arena>
</tandem>)";
}

TEST(Run, KeepsWhatControllersSayInItsLog) {
  Folder folder;
  folder.write("talk.xml", talking_experiment(""));
  Tandem run({"run", "talk.xml", "--log", "run.log", "--report", "-"}, folder.path());
  ASSERT_EQ(run.wait(), 0) << run.errors();
  const std::string log = text_of(folder.path() / "run.log");
  EXPECT_EQ(log.find("info: robot 'ep' at tick 0: made\nwarning: robot 'ep' at tick 0: step 1\n"), 0U) << log;
  for (int step = 1; step <= 30; ++step) {
    const std::string line =
        "warning: robot 'ep' at tick " + std::to_string(step - 1) + ": step " + std::to_string(step);
    EXPECT_NE(log.find(line + "\n"), std::string::npos) << "nothing is left out: " << line;
  }
  EXPECT_NE(run.errors().find("more messages are in run.log"), std::string::npos) << run.errors();
  EXPECT_NE(run.errors().find("robot 'ep' at tick 0: step 1"), std::string::npos);
  Tandem over({"run", "talk.xml", "--log", "talk.xml"}, folder.path());
  EXPECT_EQ(over.wait(), 1) << "a log would overwrite the experiment";
}

TEST(Run, ReportsWhatHooksMeasuredAndDrawsWhatTheyDrew) {
  Folder folder;
  folder.write("teach.xml", talking_experiment(R"(<loop_functions library="test_hooks" label="teacher"/>)"));
  Tandem run({"run", "teach.xml", "--picture", "end.svg", "--report", "r.json"}, folder.path());
  ASSERT_EQ(run.wait(), 0) << run.errors();
  const std::string report = text_of(folder.path() / "r.json");
  const std::size_t measures = report.find("\"measures\"");
  ASSERT_NE(measures, std::string::npos) << report;
  EXPECT_EQ(std::stod(json_value(report, "steps", measures)), 30.0);
  EXPECT_NE(report.find("libtest_hooks.so"), std::string::npos);
  const std::string picture = text_of(folder.path() / "end.svg");
  EXPECT_NE(picture.find("class=\"sketch\""), std::string::npos);
  EXPECT_NE(picture.find("&lt;drive&gt;</text>"), std::string::npos);
}

TEST(Run, GivesTheSameStateForAnyNumberOfThreadsAndTheSeedThatWasSaid) {
  Folder folder;
  std::string first;
  for (const char* threads : {"0", "2", "3"}) {
    Tandem run({"run", kConfigs + "epuck_benchmark.xml", "--steps", "20", "--threads", threads, "--seed", "5",
                "--report", "-"},
               folder.path());
    ASSERT_EQ(run.wait(), 0) << run.errors();
    const std::string hash = json_value(run.output(), "state_hash");
    if (first.empty()) first = hash;
    EXPECT_EQ(hash, first);
    EXPECT_EQ(json_value(run.output(), "seed"), "5");
  }
}

TEST(Run, EndsCleanlyWhenInterrupted) {
  Folder folder;
  Tandem run({"run", kConfigs + "epuck_diffusion.xml", "--set", "framework.experiment.length=0", "--set",
              "framework.time.mode=realtime", "--report", "r.json", "--trajectory", "t.csv"},
             folder.path());
  ASSERT_TRUE(scenarios::eventually([&] { return text_of(folder.path() / "t.csv.part").size() > 1000; }, 20));
  run.signal(SIGINT);
  run.wait();
  EXPECT_NE(run.errors().find("interrupted at tick"), std::string::npos);
  EXPECT_NE(run.output().find("not finished"), std::string::npos);
  const std::string report = text_of(folder.path() / "r.json");
  EXPECT_GT(std::stoi("0" + json_value(report, "steps")), 0);
  EXPECT_EQ(json_value(report, "finished"), "false");
  EXPECT_EQ(json_value(report, "ended"), "interrupted");
}

/// Of the trajectory `file`: ticks that have a line for all of 50 robots, once.
int whole_ticks(const scenarios::fs::path& file) {
  std::istringstream in(text_of(file));
  std::map<std::string, int> lines;
  std::string line;
  std::getline(in, line);
  EXPECT_EQ(line, "tick,time_s,id,x_m,y_m,z_m,heading_rad") << file;
  while (std::getline(in, line)) {
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), 6) << line;
    ++lines[line.substr(0, line.find(','))];
  }
  int whole = 0;
  for (const auto& [tick, robots] : lines) whole += robots == 50 ? 1 : 0;
  EXPECT_EQ(static_cast<int>(lines.size()), whole) << file;
  return whole;
}

TEST(Run, AKilledOneLeavesItsRecordsUpToTheLastSecond) {
  Folder folder;
  folder.write("t.csv", "old");
  Tandem run({"run", kConfigs + "epuck_diffusion.xml", "--set", "framework.experiment.length=0", "--set",
              "framework.time.mode=realtime", "--report", "r.json", "--trajectory", "t.csv"},
             folder.path());
  ASSERT_TRUE(scenarios::eventually([&] { return text_of(folder.path() / "t.csv.part").size() > 1000; }, 20));
  run.signal(SIGKILL);
  EXPECT_EQ(run.wait(), -SIGKILL);
  EXPECT_GT(whole_ticks(folder.path() / "t.csv.part"), 3);
  EXPECT_EQ(text_of(folder.path() / "t.csv"), "old");
}

class BadInput : public testing::Test {
 protected:
  void fails(const std::vector<std::string>& arguments, int code, const std::vector<std::string>& parts) {
    Tandem tandem(arguments, folder_.path());
    EXPECT_EQ(tandem.wait(), code) << tandem.errors();
    for (const std::string& part : parts)
      EXPECT_NE(tandem.errors().find(part), std::string::npos) << "no \"" << part << "\" in:\n" << tandem.errors();
  }
  /// The diffusion experiment with one text replaced.
  std::string changed(const std::string& from, const std::string& to) {
    std::string text = text_of(kConfigs + "epuck_diffusion.xml");
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    if (at != std::string::npos) text.replace(at, from.size(), to);
    folder_.write("e.xml", text);
    return "e.xml";
  }
  Folder folder_;
};

// A pipe that nobody writes into and /dev/zero would keep their reader for ever.
TEST_F(BadInput, OfFilesThatNeverEndIsRefusedAtOnce) {
  const std::string pipe = (folder_.path() / "pipe").string();
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string& path : {pipe, std::string("/dev/zero")}) {
    const std::string what = path == pipe ? "this is a pipe" : "this is a device";
    fails({"run", path}, 1, {what});
    fails({"check", path}, 1, {what});
    fails({"view", path, "--no-browser"}, 1, {what});
    fails({"replay", path}, 1, {what});
    fails({"upgrade", path}, 1, {what});
    fails({"picture", path, "-o", "p.svg"}, 1, {what});
    fails({"run", kConfigs + "epuck_diffusion.xml", "--repeat", path}, 1, {what});
    fails({"sweep", path}, 1, {what});
    fails({"check", changed("<arena size=\"4,4,1\" center=\"0,0,0.5\">",
                            "<arena size=\"4,4,1\" center=\"0,0,0.5\"><floor id=\"f\" source=\"image\" path=\"" + path +
                                "\"/>")},
          1, {"e.xml:", what});
    folder_.write("lua.xml",
                  R"(<tandem><framework><experiment length="1" ticks_per_second="10"/></framework><controllers>
<lua_controller id="walk"><actuators><differential_steering/></actuators><params script=")" +
                      path +
                      R"("/></lua_controller></controllers><arena size="4,4,1"><e-puck id="ep0">
<body position="0,0,0"/><controller config="walk"/></e-puck></arena></tandem>)");
    fails({"run", "lua.xml"}, 1, {"script", what});
  }
}

TEST_F(BadInput, IsNamedWithItsLineAndWhatToDo) {
  fails({"run", "nosuch.xml"}, 1, {"nosuch.xml: error: there is no such file"});
  fails({"run", "."}, 1, {"folder"});
  folder_.write("broken.xml", "<tandem>\n<framework>\n</tandem>\n");
  fails({"check", "broken.xml"}, 1, {"broken.xml:", "XML"});
  fails({"check", changed("<e-puck id=\"ep\"><controller config=\"diffusion\"/></e-puck>",
                          "<e-pukc id=\"ep\"><controller config=\"diffusion\"/></e-pukc>")},
        1, {"e.xml:", "e-pukc", "Did you mean"});
  fails({"check", changed("implementation=\"noisy\" noise_level", "implementation=\"nosiy\" noise_level")}, 1,
        {"nosiy", "noisy"});
  fails({"check", changed("<proximity", "<proximitty")}, 1, {"proximitty", "Did you mean"});
  fails({"check", changed("noise_level=\"0.02\"", "noise_levle=\"0.02\"")}, 1, {"noise_levle", "noise_level"});
  fails({"check", changed("<proximity implementation=\"noisy\" noise_level=\"0.02\"/>", "<light/>")}, 1,
        {"proximity", "does not list"});
  fails({"check", changed("library=\"epuck_diffusion\"", "library=\"no_such\"")}, 1,
        {"e.xml:", "no_such", "looked for"});
  fails({"check", changed("config=\"diffusion\"", "config=\"difusion\"")}, 1, {"difusion"});
  fails({"check", changed("quantity=\"50\" max_trials=\"1000\"", "quantity=\"50000\" max_trials=\"20\"")}, 1,
        {"e.xml:", "of 50000", "max_trials"});
  fails({"check", changed("ticks_per_second=\"10\"", "ticks_per_second=\"0\"")}, 1, {"e.xml:", "ticks_per_second"});
  fails({"check", changed("size=\"4,4,1\"", "size=\"-4,4,1\"")}, 1, {"e.xml:", "size"});
  fails({"check", changed("velocity=\"5 cm/s\"", "velocity=\"5 kg\"")}, 1, {"kg", "cm/s"});
  fails({"check", changed("<kinematics2d id", "<kinematics3d id")}, 1, {"kinematics3d", "kinematics2d"});
  fails({"check", kConfigs + "epuck_diffusion.xml", "--set", "framework.experiment.lenght=3"}, 1, {"lenght", "length"});
}

TEST_F(BadInput, IsAllToldAtOnce) {
  std::string text = text_of(kConfigs + "epuck_diffusion.xml");
  const auto replace = [&](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  replace("ticks_per_second=\"10\"", "ticks_per_second=\"ten\"");
  replace("<kinematics2d id", "<kinematics3d id");
  replace("delta=\"0.1\"", "delta=\"0.1\" dleta=\"3\"");
  replace("size=\"0.3,0.3,0.3\"", "size=\"0.3,0.3\"");
  folder_.write("e.xml", text);
  fails({"check", "e.xml"}, 1, {"ten", "kinematics3d", "0.3,0.3"});
}

TEST_F(BadInput, WrongUsageHasItsOwnCode) {
  fails({}, 2, {"subcommand"});
  fails({"rnu"}, 2, {"rnu", "--help"});
  fails({"run"}, 2, {"experiment", "tandem run --help"});
  fails({"run", kConfigs + "epuck_diffusion.xml", "--seconds", "-3"}, 2, {"seconds", "too small"});
  fails({"emulate", "tracker", "--link", "udp:127.0.0.1:9", "--sees", "a=b", "--sees", "c=d"}, 2, {"--sees", "twice"});
  fails({"bench", "walking"}, 2, {"diffusion"});
  fails({"emulate", "r2d2", "--link", "pty:x"}, 2, {"epuck"});
  fails({"emulate", "epuck", "--link", "pty:x", "--fault", "explode@3s"}, 1, {"explode"});
  fails({"emulate", "footbot", "--link", "pty:x", "--fault", "missing=wings"}, 1, {"wings", "left-motor"});
  fails({"emulate", "footbot", "--link", "pty:x", "--fault", "deaf@drvie+2s"}, 1, {"'drvie'", "@drive+5s"});
  fails({"emulate", "footbot", "--link", "pty:x", "--firmware", "v6"}, 1, {"v6", "v5"});
  fails({"emulate", "eyebot", "--link", "pty:x"}, 1, {"pty:x", "lcm:udpm://"});
  fails({"emulate", "eyebot", "--link", "lcm:memq://", "--fault", "explode@3s"}, 1, {"explode", "no-position@5s+3s"});
  fails({"emulate", "eyebot", "--link", "lcm:memq://", "--name", "eb/0"}, 1, {"eb/0"});
  fails({"emulate", "eyebot", "--link", "lcm:memq://", "--count", "0"}, 1, {"--count 0"});
  fails({"emulate", "eyebot", "--link", "lcm:memq://", "--clock", "slow"}, 1, {"synced"});
  fails({"list", "dragons"}, 2, {"controllers"});
  fails({"describe", "proximitty"}, 1, {"proximity"});
}

TEST_F(BadInput, AFailureWhileRunningHasItsOwnCode) {
  fails({"run", kConfigs + "epuck_diffusion.xml", "--report", "-", "--seconds", "1", "--picture", "p.png"}, 0, {});
  // Without walls robots leave the arena.
  std::string text = text_of(kConfigs + "epuck_diffusion.xml");
  for (const char* wall : {"wall_north", "wall_south", "wall_east", "wall_west"}) {
    const std::size_t begin = text.find(std::string("<box id=\"") + wall);
    text.erase(begin, text.find("</box>", begin) + 6 - begin);
  }
  folder_.write("open.xml", text);
  fails({"run", "open.xml", "--report", "r.json", "--trajectory", "t.csv"}, 3, {"left the arena", "escape="});
  EXPECT_EQ(json_value(text_of(folder_.path() / "r.json"), "finished"), "false");
  EXPECT_GT(text_of(folder_.path() / "t.csv").size(), 1000U);  // records are flushed
}

TEST_F(BadInput, OutputsThatCannotBeWrittenAreRefusedBeforeTheRun) {
  const std::string experiment = changed("length=\"", "length=\"");
  for (const char* option : {"--report", "--trajectory"}) {
    fails({"run", experiment, option, "/no/such/folder/file"}, 1,
          {"/no/such/folder/file", "No such file or directory"});
    fails({"run", experiment, option, "."}, 1, {"it is a folder"});
    fails({"run", experiment, option, "e.xml"}, 1, {"overwrite the experiment"});
    fails({"run", experiment, option, folder_.path().string() + "/./e.xml"}, 1, {"overwrite the experiment"});
  }
  EXPECT_EQ(text_of(folder_.path() / "e.xml"), text_of(kConfigs + "epuck_diffusion.xml"));
  fails({"run", experiment, "--picture", "/no/such/folder/p.svg"}, 1, {"/no/such/folder/p.svg"});
  fails({"run", experiment, "--picture", "p.gif"}, 1, {"p.gif", ".png", ".pdf"});
  fails({"run", experiment, "--report", "x", "--trajectory", "./x"}, 1, {"the trajectory and the report"});
  EXPECT_FALSE(scenarios::fs::exists(folder_.path() / "x"));
}

TEST_F(BadInput, TheReportOfARealRobotIsOpenedBeforeItIsDriven) {
  const std::string experiment = kConfigs + "epuck_robot.xml";
  fails({"robot", experiment, "--report", "/no/such/folder/r.json"}, 1, {"/no/such/folder/r.json", "No such file"});
  fails({"robot", experiment, "--report", experiment}, 1, {"overwrite the experiment"});
}

TEST_F(BadInput, AFullDeviceIsTold) {
  const std::string experiment = kConfigs + "epuck_diffusion.xml";
  fails({"run", experiment, "--seconds", "1", "--report", "/dev/full"}, 3, {"report", "No space left"});
  fails({"run", experiment, "--seconds", "1", "--trajectory", "/dev/full"}, 3,
        {"trajectory", "No space left", "lost from tick"});
  scenarios::fs::create_symlink("/dev/full", folder_.path() / "p.svg");
  fails({"run", experiment, "--seconds", "1", "--picture", "p.svg"}, 3, {"picture", "No space left"});
}

TEST(Terminal, GetsNoControlCharactersOfOthers) {
  EXPECT_EQ(app::printable("Zürich\t50 %\n"), "Zürich\t50 %\n");
  EXPECT_EQ(app::printable("\033]0;title\007\033[2J"), "\\x1b]0;title\\x07\\x1b[2J");
  EXPECT_EQ(app::printable("a\rb\x7f"), "a\\x0db\\x7f");
  EXPECT_EQ(app::printable("\xc2\x9b"
                           "31m \xff \xc3"),
            "\\xc2\\x9b31m \\xff \\xc3");
  EXPECT_EQ(app::printable("\xed\xa0\x80 \xc0\xaf \xf5\x80\x80\x80 \xf0\x9f\xa4\x96"),
            "\\xed\\xa0\\x80 \\xc0\\xaf \\xf5\\x80\\x80\\x80 \xf0\x9f\xa4\x96");
}

TEST(ListAndDescribe, CoverWhatThereIs) {
  Folder folder;
  Tandem list({"list"}, folder.path());
  ASSERT_EQ(list.wait(), 0);
  for (const char* name :
       {"epuck_diffusion", "obstacle_avoidance", "kinematics2d", "e-puck", "proximity", "range_and_bearing"}) {
    EXPECT_NE(list.output().find(name), std::string::npos) << name;
  }
  for (const char* name : {"epuck_diffusion", "obstacle_avoidance", "proximity", "range_and_bearing", "arena",
                           "distribute", "e-puck", "foot-bot", "eye-bot", "differential_steering"}) {
    Tandem describe({"describe", name}, folder.path());
    EXPECT_EQ(describe.wait(), 0) << name << describe.errors();
    EXPECT_GT(describe.output().size(), 60U) << name;
  }
}

TEST(Configs, AllAreGood) {
  Folder folder;
  int checked = 0;
  for (const auto& file : scenarios::fs::directory_iterator(kConfigs)) {
    if (file.path().extension() != ".xml") continue;
    Tandem check({"check", file.path().string()}, folder.path());
    EXPECT_EQ(check.wait(), 0) << file.path() << check.errors();
    ++checked;
  }
  EXPECT_GE(checked, 5);
}

TEST(Golden, TheBenchmarkKeepsItsBits) {
  // A change of these hashes changes everybody's results: it needs a reason in its commit.
  Folder folder;
  Tandem bench({"bench", "diffusion", "--robots", "1000", "--ticks", "100"}, folder.path());
  ASSERT_EQ(bench.wait(), 0) << bench.errors();
  EXPECT_EQ(json_value(bench.output(), "state_hash"), "0xa5225a2a54f9f5e1");
  Tandem run({"run", kConfigs + "epuck_diffusion.xml", "--report", "-"}, folder.path());
  ASSERT_EQ(run.wait(), 0) << run.errors();
  EXPECT_EQ(json_value(run.output(), "state_hash"), "0x9c94997a70a7c5dc");
}

TEST(Compare, FindsRunsWithOtherThreadsEqual) {
  Folder folder;
  Tandem compare({"compare", kConfigs + "epuck_benchmark.xml", "--threads-a", "0", "--threads-b", "2", "--steps", "5"},
                 folder.path());
  EXPECT_EQ(compare.wait(), 0) << compare.errors();
  EXPECT_EQ(compare.output(), "equal at 6 moments, the last one tick 5\n");
}

TEST(Compare, NamesTheFirstTickAndTheValuesThatDiffer) {
  Folder folder;
  Tandem compare({"compare", kConfigs + "epuck_diffusion.xml", "--set-b", "controllers.epuck_diffusion.params.alpha=3"},
                 folder.path());
  EXPECT_EQ(compare.wait(), 4) << compare.errors();
  const std::string said = compare.output();
  EXPECT_NE(said.find("B: " + kConfigs + "epuck_diffusion.xml --set controllers.epuck_diffusion.params.alpha=3\n"),
            std::string::npos)
      << said;
  EXPECT_NE(said.find("equal until tick 7\ntick 8: 1 value differs\n"), std::string::npos) << said;
  EXPECT_NE(said.find("robot ep8  actuator differential_steering  right  0.05  -\n"), std::string::npos) << said;
}

TEST(Compare, TellsWhichOneEndedBeforeTheOther) {
  Folder folder;
  Tandem compare({"compare", kConfigs + "epuck_diffusion.xml", "--set-b", "framework.experiment.length=1"},
                 folder.path());
  EXPECT_EQ(compare.wait(), 4) << compare.errors();
  EXPECT_EQ(compare.output(), "equal until tick 10; then only B ended: its time was over\n");
}

TEST(Compare, TakesADumpForARun) {
  Folder folder;
  const std::string experiment = kConfigs + "epuck_diffusion.xml";
  for (const char* seed : {"1", "2"}) {
    Tandem run({"run", experiment, "--seed", seed, "--steps", "7", "--dump", std::string(seed) + ".csv", "--dump-every",
                "3", "--quiet"},
               folder.path());
    ASSERT_EQ(run.wait(), 0) << run.errors();
  }
  EXPECT_EQ(text_of(folder.path() / "1.csv").substr(0, 34), "tick,who,what,field,value\n3,world,");
  Tandem equal({"compare", experiment, "1.csv", "--seed", "1"}, folder.path());
  EXPECT_EQ(equal.wait(), 0) << equal.output() << equal.errors();
  EXPECT_EQ(equal.output(), "equal at 3 moments, the last one tick 7\n");
  Tandem other({"compare", "1.csv", "2.csv"}, folder.path());
  EXPECT_EQ(other.wait(), 4) << other.output() << other.errors();
  EXPECT_NE(other.output().find("\ntick 3: "), std::string::npos) << other.output();
  EXPECT_NE(other.output().find(" seed "), std::string::npos) << other.output();
  folder.write("bad.csv", "tick,who,what,field,value\n3,world,world,seed,1\nthree,world\n");
  Tandem bad({"compare", "bad.csv", "1.csv"}, folder.path());
  EXPECT_EQ(bad.wait(), 1) << bad.output();
  EXPECT_NE(bad.errors().find("bad.csv:3"), std::string::npos) << bad.errors();
}

TEST(Bench, MeasuresEveryRunAfresh) {
  Folder folder;
  Tandem bench({"bench", "diffusion", "--robots", "4000,100,4000", "--ticks", "5"}, folder.path());
  ASSERT_EQ(bench.wait(), 0) << bench.errors();
  const std::string lines = bench.output();
  ASSERT_EQ(std::count(lines.begin(), lines.end(), '\n'), 3) << lines;
  const std::size_t second = lines.find('\n') + 1;
  const std::size_t third = lines.find('\n', second) + 1;
  EXPECT_LT(std::stod(json_value(lines, "peak_rss_mb", second)), std::stod(json_value(lines, "peak_rss_mb")));
  EXPECT_GT(std::stod(json_value(lines, "bytes_per_robot", third)), 100.0);
  EXPECT_EQ(json_value(lines, "state_hash", third), json_value(lines, "state_hash"));
}

TEST(Bench, EndsWhenInterrupted) {
  Folder folder;
  Tandem bench({"bench", "diffusion", "--robots", "1,100000", "--ticks", "20000"}, folder.path());
  ASSERT_TRUE(scenarios::eventually([&] { return !bench.output().empty(); }, 10)) << bench.errors();
  bench.signal(SIGTERM);  // to the program alone, which tells the process that runs the second size
  EXPECT_EQ(bench.wait(20), 143) << bench.errors();
  const std::string lines = bench.output();
  EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 1) << lines;  // a part of a benchmark is none
}

}  // namespace
}  // namespace tandem
