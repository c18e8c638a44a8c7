// The examples of docs/plugins.md, built in another folder as an outsider does it, and run.
#include <algorithm>
#include <cmath>
#include <gmock/gmock.h>
#include <map>

#include "tests/checkout.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem {
namespace {

using scenarios::Folder;
using scenarios::json_value;
using scenarios::Tandem;
using scenarios::text_of;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

const fs::path kExamples = fs::path(test::kSourceDir) / "examples" / "plugins";
const std::string kProgram = std::string(test::kBuildDir) + "/bin/tandem";

/// Runs a shell command in a folder. @returns its exit code; what it printed is in `log` there.
int shell(const std::string& command, const fs::path& folder) {
  const std::string all = "cd '" + folder.string() + "' && (" + command + ") >log 2>&1 </dev/null";
  const int status = std::system(all.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// Little optimisation: what an example calls is what takes the time, and that is the program's.
std::string configure(const std::string& tandem_dir, const std::string& program) {
  return "export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1; "
         "cmake -S . -B build -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O0 -DTandem_DIR='" +
         tandem_dir + "' -DTandem_PROGRAM='" + program + "' -DCMAKE_CXX_COMPILER_LAUNCHER=$(command -v ccache)";
}

class Examples : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new Folder;
    fs::copy(kExamples, folder_->path(), fs::copy_options::recursive);
    built_ = shell(configure(std::string(test::kSourceDir) + "/cmake", kProgram) + " && cmake --build build -j 2",
                   folder_->path());
    log_ = text_of(folder_->path() / "log");
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  void SetUp() override { ASSERT_EQ(built_, 0) << log_; }

  static const fs::path& path() { return folder_->path(); }
  static void run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "run");
    Tandem tandem(arguments, path());
    ASSERT_EQ(tandem.wait(60.0), 0) << tandem.errors();
  }
  static std::string hash_of(const std::string& experiment, const std::string& threads) {
    Tandem tandem({"run", experiment, "--threads", threads, "--report", "-"}, path());
    EXPECT_EQ(tandem.wait(60.0), 0) << tandem.errors();
    return json_value(tandem.output(), "state_hash");
  }
  /// An example's experiment with each `from` as `to`, under another name.
  static std::string changed(const std::string& experiment,
                             const std::vector<std::pair<std::string, std::string>>& how) {
    std::string text = text_of(path() / experiment);
    for (const auto& [from, to] : how) {
      EXPECT_NE(text.find(from), std::string::npos) << from;
      for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
        text.replace(at, from.size(), to);
    }
    return folder_->write("changed_" + experiment, text).filename().string();
  }
  /// Mean over all robots, at each tick of a trajectory, of what `value(x, y)` makes of their places.
  template <class Value>
  static std::map<long, double> means(const std::string& csv, Value&& value) {
    std::map<long, std::pair<double, int>> sums;
    std::ifstream in(path() / csv);
    std::string line;
    std::getline(in, line);  // the header
    while (std::getline(in, line)) {
      std::istringstream cells(line);
      std::vector<std::string> row;
      for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell);
      auto& [sum, count] = sums[std::stol(row.at(0))];
      sum += value(std::stod(row.at(3)), std::stod(row.at(4)));
      ++count;
    }
    std::map<long, double> all;
    for (const auto& [tick, s] : sums) all[tick] = s.first / s.second;
    return all;
  }

  static Folder* folder_;
  static int built_;
  static std::string log_;
};
Folder* Examples::folder_ = nullptr;
int Examples::built_ = -1;
std::string Examples::log_;

TEST_F(Examples, ARobotWithItsSensorFitsOn150Lines) {
  const std::string source = text_of(kExamples / "temperature.cpp");
  EXPECT_LE(std::count(source.begin(), source.end(), '\n'), 150);
}

TEST_F(Examples, TheThermometersReadTheFieldThatTheFileDeclares) {
  run({"temperature.xml", "--quiet"});
  const auto from_stove = means("temperature.csv", [](double x, double y) { return std::hypot(x - 1.0, y - 1.0); });
  EXPECT_GT(from_stove.begin()->second, 1.5);
  EXPECT_LT(from_stove.rbegin()->second, 0.5 * from_stove.begin()->second) << "they look for the stove";
  // Where the stove stands elsewhere, they go elsewhere.
  run({changed("temperature.xml", {{"stove=\"1,1,0\"", "stove=\"-2,0,0\""}}), "--quiet"});
  const auto from_there = means("temperature.csv", [](double x, double y) { return std::hypot(x + 2.0, y); });
  EXPECT_LT(from_there.rbegin()->second, 0.6 * from_there.begin()->second);
  Tandem wrong({"check", changed("temperature.xml", {{"heat=\"60\"", "heat=\"-1\""}})}, path());
  EXPECT_EQ(wrong.wait(), 1);
  EXPECT_THAT(wrong.errors(), AllOf(HasSubstr("changed_temperature.xml:11: error:"), HasSubstr("heat")));
}

TEST_F(Examples, ARobotFromAFileCarriesThePartOfAPlugin) {
  const std::string kinds = R"(<kinds><kind name="beetle" like="e-puck" summary="An e-puck with a thermometer.">
    <thermometer ahead="3 cm" source="chosen"/></kind></kinds>
  <framework>)";
  const std::string file =
      changed("temperature.xml", {{"<framework>", kinds}, {"<gardener ", "<beetle "}, {"</gardener>", "</beetle>"}});
  run({file, "--quiet"});
  const auto from_stove = means("temperature.csv", [](double x, double y) { return std::hypot(x - 1.0, y - 1.0); });
  EXPECT_LT(from_stove.rbegin()->second, 0.7 * from_stove.begin()->second);
}

/// The values of one field of the crate by tick, from a dump.
std::map<long, double> of_crate(const std::string& dump, const std::string& field) {
  std::map<long, double> values;
  std::istringstream in(dump);
  for (std::string line; std::getline(in, line);) {
    const std::string key = ",object crate,body," + field + ",";
    const std::size_t at = line.find(key);
    if (at != std::string::npos) values[std::stol(line)] = std::stod(line.substr(at + key.size()));
  }
  return values;
}

TEST_F(Examples, TheLiftRaisesTheBoxCarriesItAndPutsItDown) {
  run({"lift.xml", "--quiet", "--dump", "lift_state.csv", "--dump-every", "10", "--record", "lift.record", "--picture",
       "lift.svg", "--picture-at", "50", "--povray", "lift.pov"});
  const std::string dump = text_of(path() / "lift_state.csv");
  EXPECT_THAT(dump, HasSubstr(",robot p,lift,target,0.05")) << "its state is dumped as everybody's";
  auto low_m = of_crate(dump, "z_low"), x_m = of_crate(dump, "x");
  ASSERT_EQ(low_m.size(), 10U);
  EXPECT_NEAR(low_m[20], 0.05, 1e-3);
  EXPECT_NEAR(low_m[70], 0.05, 1e-3);
  EXPECT_NEAR(x_m[20], 0.26, 1e-3);
  EXPECT_NEAR(x_m[70], 0.76, 0.01) << "50 steps at 0.1 m/s";
  EXPECT_NEAR(low_m[100], 0.0, 1e-3);
  EXPECT_NEAR(x_m[100], x_m[80], 1e-3) << "the robot went back without it";

  const std::string lifted = text_of(path() / "lift-000050.svg"), down = text_of(path() / "lift.svg");
  const auto fork = [](const std::string& svg) {
    return svg.substr(std::min(svg.size(), svg.find("<rect class=\"fork\"")), 120);
  };
  EXPECT_THAT(fork(lifted), Not(HasSubstr("fill=\"#ffffff\""))) << "it holds something";
  EXPECT_THAT(fork(down), HasSubstr("fill=\"#ffffff\""));
  EXPECT_THAT(text_of(path() / "lift.pov"), HasSubstr("translate <0, 0, 0>")) << "the fork is down";
  Tandem of_record({"picture", "lift.record", "--at", "50", "-o", "again.svg"}, path());
  ASSERT_EQ(of_record.wait(), 0) << of_record.errors();
  EXPECT_EQ(text_of(path() / "again.svg"), lifted);
}

TEST_F(Examples, TheLiftIsRefusedWhereTheEngineHasNoJoints) {
  const std::string file =
      changed("lift.xml", {{"dynamics3d", "kinematics2d"}, {"movable=\"true\"", "movable=\"false\""}});
  Tandem refused({"run", file}, path());
  EXPECT_EQ(refused.wait(), 1);
  EXPECT_THAT(refused.errors(), AllOf(HasSubstr("robot 'p' has a lift, but its engine"), HasSubstr("dynamics3d")));
}

TEST_F(Examples, TheEngineMovesBodiesByItsOwnRule) {
  const std::string file =
      changed("river.xml", {{"</arena>", "</arena><record><trajectory path=\"river.csv\"/></record>"}});
  run({file, "--quiet"});
  const auto x_m = means("river.csv", [](double x, double) { return x; });
  EXPECT_NEAR(x_m.rbegin()->second - x_m.begin()->second, 0.66, 0.25)
      << "2/3 of the current, on average over the width";
  const std::string whole = text_of(path() / "river.csv");
  run({changed(file, {{"width=\"4\"", "width=\"4\" regions=\"4x2\""}}), "--quiet", "--threads", "4"});
  EXPECT_EQ(text_of(path() / "river.csv"), whole) << "bodies that do not touch are moved alike in any region";
}

TEST_F(Examples, TheMediumCarriesSignalsByDistance) {
  run({"chirp.xml", "--quiet"});
  const auto from_middle = means("chirp.csv", [](double x, double y) { return std::hypot(x, y); });
  EXPECT_LT(from_middle.rbegin()->second, from_middle.begin()->second) << "they gather";
  run({changed("chirp.xml",
               {{"<actuators><chirper/>", "<actuators><chirper implementation=\"default\" medium=\"air\"/>"}}),
       "--quiet"});
}

TEST_F(Examples, TheObserverWritesWhatItSees) {
  run({"spread.xml", "--quiet"});
  const std::string csv = text_of(path() / "spread.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 21);
  EXPECT_THAT(csv, AllOf(testing::StartsWith("tick,robots,spread_m\n0,30,"), HasSubstr("\n190,30,")));
  Tandem clash({"run", "spread.xml", "--trajectory", "spread.csv"}, path());
  EXPECT_EQ(clash.wait(), 1) << "two outputs in one file";
  Tandem nowhere({"run", changed("spread.xml", {{"spread.csv", "no/such/folder.csv"}})}, path());
  EXPECT_EQ(nowhere.wait(), 1);
  EXPECT_THAT(nowhere.errors(), HasSubstr("changed_spread.xml:17: error: cannot write the spread"));
  Tandem unknown({"check", changed("spread.xml", {{"<spread ", "<sprawl "}})}, path());
  EXPECT_EQ(unknown.wait(), 1);
  EXPECT_THAT(unknown.errors(), AllOf(HasSubstr("sprawl"), HasSubstr("spread")));
}

TEST_F(Examples, TheLayerDrawsOverPictures) {
  run({"crowd.xml", "--quiet", "--picture", "crowd.svg", "--picture-at", "1", "--picture-layers", "crowd,proximity"});
  const std::string svg = text_of(path() / "crowd-000001.svg");
  const std::size_t sketch = svg.find("<g class=\"sketch\"");
  ASSERT_NE(sketch, std::string::npos);
  EXPECT_NE(svg.find("r=\"0.05\" stroke=\"#d55e00\"", sketch), std::string::npos) << "robots that are close";
  EXPECT_NE(svg.find("<polyline", sketch), std::string::npos) << "rays";
  run({"crowd.xml", "--quiet", "--picture", "plain.svg"});
  EXPECT_EQ(text_of(path() / "plain.svg").find("<g class=\"sketch\""), std::string::npos);
}

TEST_F(Examples, GiveTheSameBitsForAnyNumberOfThreads) {
  for (const std::string name :
       {"temperature", "lift", "waltz", "doorman", "river", "chirp", "spread", "stillness", "crowd", "buggy"}) {
    const std::string first = hash_of(name + ".xml", "0");
    EXPECT_FALSE(first.empty()) << name;
    EXPECT_EQ(hash_of(name + ".xml", "2"), first) << name;
  }
}

TEST_F(Examples, AreListedAndDescribedWithWhereTheyComeFrom) {
  std::vector<std::string> list = {"list"};
  for (const std::string name :
       {"temperature", "lift", "waltz", "doorman", "river", "chirp", "spread", "stillness", "crowd", "buggy"})
    list.insert(list.end(), {"--plugin", "build/lib" + name + ".so"});
  Tandem listed(list, path());
  ASSERT_EQ(listed.wait(), 0) << listed.errors();
  EXPECT_THAT(listed.output(),
              AllOf(HasSubstr("libtemperature.so: 1 controller, 1 device, 1 field, 1 part, 1 port, 1 robot"),
                    HasSubstr("libriver.so: 1 engine"), HasSubstr("libspread.so: 1 observer"),
                    HasSubstr("libstillness.so: 1 run_part"), HasSubstr("libcrowd.so: 1 layer"),
                    HasSubstr("libbuggy.so: 1 bridge, 2 controllers, 1 emulator, 1 robot, 1 stopper")));
  EXPECT_THAT(listed.output(), HasSubstr("How far robots are spread, as CSV. (libspread.so)"));
  Tandem described({"describe", "spread", "--plugin", "build/libspread.so"}, path());
  ASSERT_EQ(described.wait(), 0) << described.errors();
  EXPECT_THAT(described.output(), AllOf(HasSubstr("<spread> in <record>"), HasSubstr("Ticks between rows.")));
}

TEST_F(Examples, AreWithoutFault) {
  for (const std::string name :
       {"temperature", "lift", "waltz", "doorman", "river", "chirp", "spread", "stillness", "crowd", "buggy"}) {
    Tandem check({"plugin", "check", "build/lib" + name + ".so"}, path());
    EXPECT_EQ(check.wait(60.0), 0) << check.output() << check.errors();
    EXPECT_THAT(check.output(), HasSubstr(", 0 faults"));
  }
}

/// The emulated buggy, as a process of its own.
class EmulatedBuggy : public scenarios::EmulatedRobot {
 public:
  explicit EmulatedBuggy(const Folder& folder)
      : EmulatedRobot(folder, "buggy", "pty:buggy0", {"--plugin", "build/libbuggy.so"}) {}
};

TEST_F(Examples, TheSameControllerDrivesTheRealRobot) {
  EmulatedBuggy robot(*folder_);
  ASSERT_TRUE(robot.ready());
  Tandem real({"run", "buggy_real.xml", "--seconds", "3", "--report", "real.json"}, path());
  ASSERT_EQ(real.wait(60.0), 0) << real.errors();
  EXPECT_TRUE(robot.has_moved());
  EXPECT_FALSE(robot.moves()) << "stopped at the end";
  const auto wheels = robot.wheels();
  EXPECT_TRUE(std::any_of(wheels.begin(), wheels.end(), [](const auto& w) { return w.left == 100 && w.right == 140; }))
      << "what the simulated one drives with, in mm/s";
  EXPECT_EQ(robot.end(), 0);
}

TEST_F(Examples, TheGuardianStopsTheRealRobotWhenItsHubDies) {
  EmulatedBuggy robot(*folder_);
  ASSERT_TRUE(robot.ready());
  Tandem real({"run", "buggy_real.xml", "--seconds", "60"}, path());
  ASSERT_TRUE(scenarios::eventually([&] { return robot.moves(); }, 30.0)) << real.errors();
  real.signal(SIGKILL);
  EXPECT_EQ(real.wait(), -SIGKILL);
  EXPECT_TRUE(scenarios::eventually([&] { return !robot.moves(); }, 10.0));
  EXPECT_THAT(robot.log(), testing::Not(HasSubstr("stopped by itself"))) << "told to, before its own time-out";
}

TEST(FreshCheckout, ItsLauncherBuildsTheControlInterfaceThatAControllerLinks) {
  Folder folder;
  const fs::path checkout = folder.path() / "checkout", project = folder.path() / "project";
  const fs::path built = checkout / "build/release/hal/libtandem_hal.a";
  fs::create_directories(built.parent_path());
  for (const char* const part : {"cmake", "hal"})
    fs::copy(fs::path(test::kSourceDir) / part, checkout / part, fs::copy_options::recursive);
  folder.write("checkout/tandem", "#!/bin/sh\necho \"$@\" >>'" + (folder.path() / "calls").string() + "'; cp '" +
                                      std::string(test::kBuildDir) + "/hal/libtandem_hal.a' '" + built.string() +
                                      "'\n");
  fs::permissions(checkout / "tandem", fs::perms::owner_all);
  fs::create_directory(project);
  fs::copy_file(kExamples / "waltz.cpp", project / "waltz.cpp");
  folder.write("project/CMakeLists.txt",
               "cmake_minimum_required(VERSION 3.25)\nproject(dances CXX)\nfind_package(Tandem REQUIRED)\n"
               "tandem_controller(NAME waltz SOURCES waltz.cpp)\n");
  const auto calls = [&] { return text_of(folder.path() / "calls"); };
  ASSERT_EQ(shell(configure((checkout / "cmake").string(), kProgram) + " && cmake --build build", project), 0)
      << text_of(project / "log");
  EXPECT_EQ(calls(), "build tandem_hal\n");
  EXPECT_TRUE(fs::exists(project / "build/libwaltz.so"));

  EXPECT_EQ(shell("touch waltz.cpp && cmake --build build", project), 0) << text_of(project / "log");
  EXPECT_EQ(calls(), "build tandem_hal\n") << "what is there is linked";

  fs::last_write_time(checkout / "hal/unit.hpp", fs::last_write_time(built) + std::chrono::seconds(2));
  EXPECT_EQ(shell("cmake --build build", project), 0) << text_of(project / "log");
  EXPECT_EQ(calls(), "build tandem_hal\nbuild tandem_hal\n") << "a header is newer";
}

TEST_F(Examples, BuildAndRunAgainstAnInstalledTree) {
  Folder folder;
  const std::string prefix = (folder.path() / "installed").string();
  ASSERT_EQ(shell("cmake --install '" + std::string(test::kBuildDir) + "' --prefix '" + prefix + "'", folder.path()), 0)
      << text_of(folder.path() / "log");
  const fs::path project = folder.path() / "project";
  fs::copy(kExamples, project, fs::copy_options::recursive);
  const std::string program = prefix + "/bin/tandem";
  ASSERT_EQ(
      shell("cmake -S . -B build -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O0 -DCMAKE_PREFIX_PATH='" + prefix +
                "' -DCMAKE_CXX_COMPILER_LAUNCHER=$(command -v ccache) && cmake --build build --target spread && '" +
                program + "' run spread.xml --quiet --picture spread.png",
            project),
      0)
      << text_of(project / "log");
  EXPECT_TRUE(fs::exists(project / "spread.csv"));
  EXPECT_THAT(text_of(project / "build" / "CMakeCache.txt"), HasSubstr("Tandem_PROGRAM:FILEPATH=" + program));
}

}  // namespace
}  // namespace tandem
