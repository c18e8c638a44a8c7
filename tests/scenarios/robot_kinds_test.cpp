// Kinds of robots from files as users see them: in worlds of every engine, in every command, and as fast to get wrong.
#include <cmath>
#include <functional>
#include <gmock/gmock.h>

#include "app/catalog.hpp"
#include "app/real/simulated_body.hpp"
#include "bridges/emulation/emulator_type.hpp"
#include "core/config/kinds.hpp"
#include "core/config/reader.hpp"
#include "core/sim/world.hpp"
#include "hal/robot/epuck.hpp"
#include "hal/robot/eyebot.hpp"
#include "hal/robot/footbot.hpp"
#include "hal/xml/xml.hpp"
#include "tests/checkout.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem {
namespace {

using scenarios::Folder;
using scenarios::Tandem;
using scenarios::text_of;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// A world, or why there is none.
struct Trial {
  std::unique_ptr<core::World> world;
  core::Problems problems;

  explicit Trial(const std::string& text) {
    static hal::PluginLoader loader({std::string(test::kBuildDir) + "/lib"}, app::catalog());
    const auto scenario = core::read_experiment_text(text, "kinds.xml", {}, app::catalog(), problems);
    if (scenario) world = core::World::make(*scenario, loader, {}, problems);
  }
  std::string text() const {
    std::string all;
    for (const core::Problem& p : problems) all += core::to_text(p) + "\n";
    return all;
  }
};

struct Built {
  const hal::RobotKind& (*kind)();
  std::string controller, library, devices, engine;
};

/// Twenty robots of a kind that sense, drive and talk.
std::string experiment(const Built& built, const std::string& robot, const std::string& kinds) {
  return "<tandem version=\"1\">" + kinds +
         R"(<framework><experiment length="0" ticks_per_second="10" random_seed="7"/></framework><controllers><)" +
         built.controller + R"( id="c" library=")" + built.library + "\">" + built.devices + "</" + built.controller +
         R"(></controllers><physics_engines><)" + built.engine +
         R"( id="e"/></physics_engines><arena size="6,6,6" center="0,0,3"><distribute>
<position method="uniform" min="-2,-2,0" max="2,2,0"/><orientation method="uniform" min="0,0,0" max="360,0,0"/>
<entity quantity="12" max_trials="1000"><)" +
         robot + R"( id="r"><controller config="c"/></)" + robot + R"(></entity></distribute></arena></tandem>)";
}

const std::string kDiffusion =
    R"(<actuators><differential_steering/></actuators><sensors><proximity implementation="noisy" noise_level="0.05"/></sensors>)";
const std::string kHover =
    R"(<actuators><flight_task/><quadrotor_position/></actuators><sensors><positioning/><flight_state/><clock/></sensors>)";

std::vector<Built> all_built() {
  std::vector<Built> all;
  for (const char* engine : {"kinematics2d", "dynamics2d", "dynamics3d", "particle3d"}) {
    all.push_back({&hal::epuck::kind, "epuck_diffusion", "epuck_diffusion", kDiffusion, engine});
    all.push_back({&hal::footbot::kind, "footbot_diffusion", "footbot_diffusion", kDiffusion, engine});
  }
  for (const char* engine : {"dynamics3d", "particle3d"})
    all.push_back({&hal::eyebot::kind, "eyebot_hover", "eyebot_hover", kHover, engine});
  return all;
}

class WrittenOut : public testing::TestWithParam<Built> {};
INSTANTIATE_TEST_SUITE_P(OfTandem, WrittenOut, testing::ValuesIn(all_built()), [](const auto& one) {
  std::string name = one.param.kind().name + "In" + one.param.engine;
  std::erase(name, '-');
  return name;
});

TEST_P(WrittenOut, KindRunsWithTheSameBits) {
  const Built& built = GetParam();
  hal::RobotKind copy = built.kind();
  copy.name = "copy";
  const Trial inside(experiment(built, built.kind().name, ""));
  const Trial outside(experiment(built, "copy", core::kinds_file({core::element_of(copy)})));
  ASSERT_NE(inside.world, nullptr) << inside.text();
  ASSERT_NE(outside.world, nullptr) << outside.text();
  for (core::World* world : {inside.world.get(), outside.world.get()}) {
    world->start();
    for (int tick = 0; tick < 100; ++tick) world->step();
    ASSERT_EQ(world->failure(), "");
  }
  EXPECT_EQ(inside.world->state_hash(), outside.world->state_hash());
  EXPECT_EQ(outside.world->space().kind(outside.world->space().robot(0)).name, "copy");
}

TEST(RobotKindsOfFiles, CanBeAddedWhileTheRunGoesOn) {
  hal::RobotKind crab = hal::epuck::kind();
  crab.name = "crab";
  const Built built{&hal::epuck::kind, "epuck_diffusion", "epuck_diffusion", kDiffusion, "dynamics2d"};
  const Trial trial(experiment(built, "e-puck", core::kinds_file({core::element_of(crab)})));
  ASSERT_NE(trial.world, nullptr) << trial.text();
  trial.world->start();
  core::Space& space = trial.world->space();
  const auto added =
      space.add_robot({.kind = "crab", .id = "new", .controller = "c", .pose = {.x_m = 2.8, .y_m = 2.8}});
  ASSERT_TRUE(added.ok()) << added.error().message;
  EXPECT_EQ(space.kind(added.value()).name, "crab");
  const auto nobody =
      space.add_robot({.kind = "crap", .id = "no", .controller = "c", .pose = {.x_m = 2.5, .y_m = 2.8}});
  ASSERT_FALSE(nobody.ok());
  EXPECT_THAT(nobody.error().message, HasSubstr("Did you mean 'crab'?"));
  for (int tick = 0; tick < 5; ++tick) trial.world->step();
  EXPECT_EQ(trial.world->failure(), "");
}

TEST(RobotKindsOfFiles, AreBodiesOfTheEmulatorOfTheKindThatTheyAreLike) {
  const std::string devices =
      R"(<actuators><differential_steering/><leds/><body_led/><front_led/></actuators><sensors><proximity/><light/><ground/>
<accelerometer/><microphones/><battery/></sensors>)";
  const auto* const epuck = app::catalog().find<bridges::EmulatorType>("epuck");
  ASSERT_NE(epuck, nullptr);
  const auto body_among = [&](const std::string& kind) {
    const Built built{&hal::epuck::kind, "puppet", "puppet", devices, "dynamics2d"};
    const Trial trial(experiment(built, "crab", "<kinds><kind name=\"crab\" " + kind + "/></kinds>"));
    EXPECT_NE(trial.world, nullptr) << trial.text();
    return trial.world != nullptr && app::SimulatedBody::find(*trial.world, *epuck, "").ok();
  };
  EXPECT_TRUE(body_among("like=\"e-puck\""));
  EXPECT_FALSE(body_among("like=\"e-puck\" bridge=\"foot-bot\""));
}

// --- figures at the ends of their ranges ---

/// Every attribute and child list of an element, one after the other, with something odd in its place.
void each_oddity(hal::Element& e, const hal::Element& root, const std::function<void(const std::string&)>& use) {
  static const std::vector<std::string> kOdd = {"0",   "-1",   "1e-9", "0.001", "0.01",
                                                "100", "1000", "1e4",  "1e6",   "1e300"};
  for (std::size_t i = 0; i < e.attributes.size(); ++i) {
    if (e.attributes[i].name == "source" || e.attributes[i].name == "summary" || e.attributes[i].name == "name")
      continue;
    const std::string usual = e.attributes[i].value;
    for (const std::string& odd : kOdd) {
      e.attributes[i].value = odd;
      use(hal::to_xml(root));
    }
    e.attributes[i].value = usual;
  }
  for (std::size_t i = 0; i < e.children.size(); ++i) {
    if (i > 0 && e.children[i].name == e.children[i - 1].name) continue;
    each_oddity(e.children[i], root, use);
    const hal::Element child = e.children[i];
    e.children.erase(e.children.begin() + static_cast<std::ptrdiff_t>(i));
    use(hal::to_xml(root));
    e.children.insert(e.children.begin() + static_cast<std::ptrdiff_t>(i), child);
  }
}

/// Takes all that there is of such a robot, and gives every figure of its kind odd values.
void try_oddities(Built built, const std::vector<std::string>& engines) {
  int refused = 0, run = 0;
  hal::RobotKind copy = built.kind();
  copy.name = "copy";
  hal::Element kinds;
  kinds.name = "kinds";
  kinds.children = {core::element_of(copy)};
  // Of lists of sensors a single one tells as much.
  for (hal::Element& part : kinds.children[0].children) {
    while (part.children.size() > 4 && part.children.back().name == part.children[part.children.size() - 2].name)
      part.children.pop_back();
  }
  each_oddity(kinds.children[0], kinds, [&](const std::string& text) {
    for (const std::string& engine : engines) {
      built.engine = engine;
      const Trial odd(experiment(built, "copy", text));
      if (odd.world == nullptr) {
        EXPECT_FALSE(odd.problems.empty());
        ++refused;
        continue;
      }
      odd.world->start();
      for (int tick = 0; tick < 3; ++tick) odd.world->step();
      EXPECT_EQ(odd.world->failure(), "") << text;
      for (std::size_t i = 0; i < odd.world->space().robot_count(); ++i)
        ASSERT_TRUE(std::isfinite(odd.world->space().pose(odd.world->space().robot(i)).x_m)) << engine << text;
      ++run;
    }
  });
  EXPECT_GT(refused, 100);
  EXPECT_GT(run, 100);
}

TEST(RobotKindsOfFiles, ThatDriveWithOddFiguresAreRefusedOrRun) {
  try_oddities({&hal::footbot::kind, "footbot_puppet", "puppet",
                R"(<actuators><differential_steering/><leds/><range_and_bearing/><turret/><gripper/><distance_scanner/>
</actuators><sensors><proximity/><light/><battery/><accelerometer/><gyroscope/><range_and_bearing/><turret_encoder/>
<gripper/><distance_scanner/><base_ground/><motor_ground/></sensors>)",
                ""},
               {"dynamics2d", "dynamics3d"});
  try_oddities({&hal::epuck::kind, "epuck_diffusion", "epuck_diffusion", kDiffusion, ""},
               {"kinematics2d", "particle3d"});
}

TEST(RobotKindsOfFiles, ThatFlyWithOddFiguresAreRefusedOrRun) {
  try_oddities(
      {&hal::eyebot::kind, "eyebot_puppet", "puppet",
       R"(<actuators><flight_task/><quadrotor_speed/><leds/><upper_leds/><camera_led/><pan_tilt/><distance_scanner/>
<range_and_bearing/></actuators><sensors><flight_state/><positioning/><altimeter/><proximity/><light/><distance_scanner/>
<pan_tilt_encoder/><perspective_camera/><range_and_bearing/><battery/></sensors>)",
       ""},
      {"dynamics3d", "particle3d"});
}

// --- commands ---

const std::string kCrab = R"(<kinds version="1">
  <kind name="crab" like="e-puck" summary="Walks sideways.">
    <body radius="0.1"/>
    <leds><mount radius="0.08" z="0.1" count="3"/></leds>
  </kind>
</kinds>
)";

std::string with_crabs(const std::string& top) {
  return "<tandem version=\"1\">" + top + R"(
<framework><experiment length="5" ticks_per_second="10" random_seed="7"/></framework>
<controllers><obstacle_avoidance id="c" library="obstacle_avoidance"><actuators><differential_steering/></actuators>
<sensors><proximity/></sensors></obstacle_avoidance></controllers><arena size="4,4,1">
<crab id="c0"><body position="0,0,0"/><controller config="c"/></crab><crab id="c1"><body position="1,0,0"/><controller config="c"/></crab>
</arena></tandem>)";
}

class Commands : public testing::Test {
 protected:
  Commands() {
    scenarios::fs::create_directory(folder_.path() / "there");
    folder_.write("there/crab.xml", kCrab);
    folder_.write("there/run.xml", with_crabs("<kinds file=\"crab.xml\"/>"));
  }
  const Folder folder_;
};

TEST_F(Commands, ShowAKindFromAFileWithItsPlace) {
  Tandem list({"list", "robots", "--in", "there/run.xml"}, folder_.path());
  ASSERT_EQ(list.wait(), 0) << list.errors();
  EXPECT_THAT(list.output(), HasSubstr("Walks sideways. (crab.xml:2)"));
  for (const char* file : {"there/run.xml", "there/crab.xml"}) {
    Tandem describe({"describe", "crab", "--in", file}, folder_.path());
    ASSERT_EQ(describe.wait(), 0) << describe.errors();
    EXPECT_THAT(describe.output(),
                AllOf(HasSubstr("robot <crab>: Walks sideways. (crab.xml:2)"), HasSubstr("radius: 0.1 m"),
                      HasSubstr("source: wheel radius: GCtronic's wiki"), HasSubstr("  actuators: ")));
    Tandem check({"check", file}, folder_.path());
    EXPECT_EQ(check.wait(), 0) << check.errors();
  }
  Tandem without({"describe", "crab"}, folder_.path());
  EXPECT_EQ(without.wait(), 1);
}

TEST_F(Commands, LeaveAKindOutThatAPluginOfTheFoldersHasToo) {
  folder_.write("crawler.xml", R"(<kinds><kind name="crawler" like="e-puck"/></kinds>)");
  Tandem check({"check", "crawler.xml"}, folder_.path());
  EXPECT_EQ(check.wait(), 0) << "only who lists everything opens the plug-ins of the folders: " << check.errors();
  Tandem list({"list", "robots", "--in", "crawler.xml", "--plugin", "libtest_crawler"}, folder_.path());
  EXPECT_EQ(list.wait(), 1);
  EXPECT_THAT(list.errors(), HasSubstr("crawler.xml:1: error: <kind name>: there is a robot 'crawler' already"));
  Tandem all({"list", "robots", "--in", "crawler.xml"}, folder_.path());
  EXPECT_EQ(all.wait(), 0);
  EXPECT_THAT(all.errors(), HasSubstr("warning: crawler.xml:1: the kind 'crawler' is left out: "));
}

TEST_F(Commands, PrintAKindAsTheFileThatGivesIt) {
  Tandem xml({"describe", "crab", "--xml", "--in", "there/run.xml"}, folder_.path());
  ASSERT_EQ(xml.wait(), 0) << xml.errors();
  folder_.write("copy.xml", xml.output());
  Tandem check({"check", "copy.xml"}, folder_.path());
  EXPECT_EQ(check.wait(), 0) << check.errors();
  EXPECT_THAT(check.output(), HasSubstr("good: 1 kind of robots: crab"));
  folder_.write("again.xml", with_crabs("<kinds file=\"copy.xml\"/>"));
  Tandem compare({"compare", "again.xml", "there/run.xml"}, folder_.path());
  EXPECT_EQ(compare.wait(), 0) << compare.output() << compare.errors();
  Tandem nobody({"describe", "crap", "--xml", "--in", "there/run.xml"}, folder_.path());
  EXPECT_EQ(nobody.wait(), 1);
  EXPECT_THAT(nobody.errors(), HasSubstr("there is no robot 'crap'"));
  EXPECT_THAT(nobody.errors(), HasSubstr("Did you mean 'crab'?"));
}

TEST_F(Commands, RunAKindFromAFileAndReportIt) {
  Tandem run({"run", "there/run.xml", "--report", "r.json", "--picture", "end.svg"}, folder_.path());
  ASSERT_EQ(run.wait(), 0) << run.errors();
  EXPECT_THAT(text_of(folder_.path() / "end.svg"), HasSubstr("2 × crab"));
  const std::string report = text_of(folder_.path() / "r.json");
  EXPECT_THAT(report, AllOf(HasSubstr("there/crab.xml"), HasSubstr("<kind name=\\\"crab\\\"")))
      << "its file, and in the settings itself";
  Tandem over({"run", "there/run.xml", "--report", "there/crab.xml"}, folder_.path());
  EXPECT_EQ(over.wait(), 1);
  EXPECT_THAT(over.errors(), HasSubstr("crab"));
  EXPECT_EQ(text_of(folder_.path() / "there/crab.xml"), kCrab);
}

TEST_F(Commands, FindTwoRunsDifferentWhenTheKindIs) {
  folder_.write("there/slow.xml", with_crabs("<kinds file=\"crab.xml\"/>"));
  Tandem compare(
      {"compare", "there/run.xml", "there/slow.xml", "--set-b", "kinds.kind[crab].differential_drive.max_speed=0.01"},
      folder_.path());
  EXPECT_EQ(compare.wait(), 1) << "a drive that the file does not give cannot be set: " << compare.errors();
  folder_.write("there/slow.xml", with_crabs(R"(<kinds file="slow_crab.xml"/>)"));
  std::string slow = kCrab;
  slow.replace(slow.find("<body"), 0, "<differential_drive max_speed=\"0.01\"/>");
  folder_.write("there/slow_crab.xml", slow);
  Tandem other({"compare", "there/run.xml", "there/slow.xml"}, folder_.path());
  EXPECT_EQ(other.wait(), 4) << other.output() << other.errors();
}

TEST_F(Commands, RefuseARealRobotThatItsBridgeCannotDrive) {
  std::string text = with_crabs("<kinds><kind name=\"crab\" like=\"e-puck\" without=\"differential_drive\"/></kinds>");
  text.replace(text.find("<controller config=\"c\"/></crab>"), 0, "\n<bridge link=\"serial:/dev/ttyUSB0\"/>");
  folder_.write("real.xml", text);
  for (const char* command : {"check", "run", "robot"}) {
    Tandem real({command, "real.xml"}, folder_.path());
    EXPECT_EQ(real.wait(), 1) << command;
    EXPECT_THAT(real.errors(), HasSubstr("real.xml:6: error: robot 'c0': the kind 'crab' has no drive"));
  }
}

TEST_F(Commands, DriveARealRobotOfAKindThatIsBuiltAsItsBridgeKnows) {
  scenarios::EmulatedEpuck epuck(folder_);
  ASSERT_TRUE(epuck.ready());
  std::string text = with_crabs(
      "<kinds><kind name=\"crab\" like=\"e-puck\"><differential_drive wheel_base=\"55 mm\" "
      "source=\"measured\"/></kind></kinds>");
  text.replace(text.find("<crab id=\"c1\">"), text.find("</arena>") - text.find("<crab id=\"c1\">"), "");
  text.replace(text.find("<controller config=\"c\"/></crab>"), 0, "<bridge link=\"serial:ep0\" firmware=\"auto\"/>");
  folder_.write("real.xml", text);
  Tandem robot({"robot", "real.xml", "--seconds", "2"}, folder_.path());
  EXPECT_EQ(robot.wait(), 0) << robot.errors();
  EXPECT_TRUE(epuck.has_moved());
  Tandem run({"run", "real.xml", "--seconds", "1"}, folder_.path());
  EXPECT_EQ(run.wait(), 0) << run.errors();
}

}  // namespace
}  // namespace tandem
