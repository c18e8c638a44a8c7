// Plug-ins as a user names them: by <plugins> and --plugin, in every command that reads files or lists.
#include <gmock/gmock.h>

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

const std::string kThermometer = std::string(test::kBuildDir) + "/lib/libtest_thermometer.so";

/// Robots with thermometers between two lamps.
std::string experiment(const std::string& plugins, const std::string& controllers = "test_thermometer") {
  return "<tandem version=\"1\">" + plugins + R"(
  <framework><experiment length="20" ticks_per_second="10" random_seed="3"/></framework>
  <controllers><basker id="b" library=")" +
         controllers + R"("><sensors><thermometer offset="1"/></sensors><actuators><differential_steering/></actuators>
  </basker></controllers>
  <arena size="8,8,1">
    <light id="lamp" position="1,1,1" intensity="2"/>
    <distribute><position method="uniform" min="-3,-3,0" max="3,3,0"/>
      <orientation method="uniform" min="0,0,0" max="360,0,0"/>
      <entity quantity="40" max_trials="100"><e-puck id="ep"><controller config="b"/></e-puck></entity></distribute>
    <e-puck id="warm"><body position="1,1,0"/><controller config="b"/></e-puck>
  </arena></tandem>)";
}

/// A library of that name in `folder`, which nobody else finds.
void put(const Folder& folder, const std::string& name) {
  std::filesystem::copy_file(kThermometer, folder.path() / name);
}

class Plugins : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(folder_.path() / "there");
    put(folder_, "there/libwarm.so");
    folder_.write("there/named.xml", experiment("<plugins library=\"libwarm\"/>", "libwarm"));
    folder_.write("there/plain.xml", experiment("", "libwarm"));
  }
  std::string state_of(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--report", "-"});
    Tandem run(arguments, folder_.path());
    EXPECT_EQ(run.wait(), 0) << run.errors();
    return json_value(run.output(), "state_hash");
  }
  Folder folder_;
};

TEST_F(Plugins, OfAFileAreFoundBesideItAndGiveTheSameBitsForAnyNumberOfThreads) {
  const std::string first = state_of({"run", "there/named.xml", "--threads", "0"});
  EXPECT_FALSE(first.empty());
  EXPECT_EQ(state_of({"run", "there/named.xml", "--threads", "2"}), first);
  EXPECT_EQ(state_of({"run", "there/plain.xml", "--plugin", "there/libwarm.so"}), first);
  Tandem compare({"compare", "there/named.xml", "--steps", "20", "--threads-b", "2"}, folder_.path());
  EXPECT_EQ(compare.wait(), 0) << compare.errors() << compare.output();
}

/// The experiment with crabs instead of e-pucks, whose thermometers are as `parts` say.
std::string with_crabs(const std::string& plugins, const std::string& parts) {
  std::string text =
      experiment(plugins + "\n<kinds><kind name=\"crab\" like=\"e-puck\">" + parts + "</kind></kinds>", "libwarm");
  for (std::size_t at = 0; (at = text.find("e-puck", at)) != std::string::npos; at += 4) {
    if (text.compare(at - 6, 6, "like=\"") != 0) text.replace(at, 6, "crab");
  }
  return text;
}

TEST_F(Plugins, PartsOfTheirsAreBuiltIntoRobotsOfFiles) {
  const std::string plugin = "<plugins library=\"libwarm\"/>";
  folder_.write("there/crabs.xml", with_crabs(plugin, "<thermometer offset=\"400\" source=\"a guess\"/>"));
  folder_.write("there/plain_crabs.xml", with_crabs(plugin, ""));
  EXPECT_NE(state_of({"run", "there/crabs.xml"}), state_of({"run", "there/plain_crabs.xml"}));
  EXPECT_EQ(state_of({"run", "there/plain_crabs.xml"}), state_of({"run", "there/named.xml"}));
  Tandem describe({"describe", "crab", "--in", "there/crabs.xml"}, folder_.path());
  ASSERT_EQ(describe.wait(), 0) << describe.errors();
  EXPECT_THAT(describe.output(), AllOf(HasSubstr("thermometer: A thermometer in the body."), HasSubstr("offset: 400 K"),
                                       HasSubstr("source: a guess")));

  folder_.write("there/hot.xml", with_crabs(plugin, "<thermometer offset=\"900\"/>"));
  Tandem hot({"check", "there/hot.xml"}, folder_.path());
  EXPECT_EQ(hot.wait(), 1);
  EXPECT_THAT(hot.errors(), HasSubstr("there/hot.xml:2: error: <thermometer> shows more than anybody believes"));
  folder_.write("there/without.xml", with_crabs("", "<thermometer offset=\"4\"/>"));
  Tandem without({"check", "there/without.xml"}, folder_.path());
  EXPECT_EQ(without.wait(), 1);
  EXPECT_THAT(without.errors(),
              HasSubstr("there/without.xml:2: error: <kind> cannot hold <thermometer>: it is no body"));
}

TEST_F(Plugins, TheirStateIsRecordedAndTheirFileReported) {
  Tandem run({"run", "there/named.xml", "--report", "r.json", "--dump", "d.csv"}, folder_.path());
  ASSERT_EQ(run.wait(), 0) << run.errors();
  EXPECT_THAT(text_of(folder_.path() / "d.csv"), HasSubstr("warmth"));
  const std::string report = text_of(folder_.path() / "r.json");
  const std::size_t plugins = report.find("\"plugins\"");
  ASSERT_NE(plugins, std::string::npos) << report;
  EXPECT_THAT(json_value(report, "file", plugins), HasSubstr("there/libwarm.so"));
  EXPECT_THAT(report, HasSubstr("<plugins library=")) << "the saved settings name it";
}

TEST_F(Plugins, AreThereInCheckListAndDescribe) {
  Tandem check({"check", "there/named.xml"}, folder_.path());
  EXPECT_EQ(check.wait(), 0) << check.errors();
  Tandem without({"check", "there/plain.xml"}, folder_.path());
  EXPECT_EQ(without.wait(), 1);
  EXPECT_THAT(without.errors(), HasSubstr("plain.xml:3: error: unknown sensor <thermometer>"));
  Tandem with({"check", "there/plain.xml", "--plugin", "there/libwarm"}, folder_.path());
  EXPECT_EQ(with.wait(), 0) << with.errors();

  // The build's own folder has the same library under another name, so the copy's parts are a second time there.
  Tandem list({"list", "--plugin", "there/libwarm.so"}, folder_.path());
  ASSERT_EQ(list.wait(), 0) << list.errors();
  EXPECT_THAT(list.output(),
              AllOf(HasSubstr("default (libwarm.so)"), HasSubstr("Lamps warm robots with thermometers. (libwarm.so)"),
                    HasSubstr("there/libwarm.so: 1 controller, 1 coupling, 1 device, 1 part, 1 port")));
  EXPECT_THAT(list.errors(), HasSubstr("registers the port 'sensor thermometer' a second time: the first is from"));
  Tandem describe({"describe", "thermometer", "--plugin", "there/libwarm.so"}, folder_.path());
  ASSERT_EQ(describe.wait(), 0) << describe.errors();
  EXPECT_THAT(describe.output(), AllOf(HasSubstr("Temperature of the robot's body. (libwarm.so)"), HasSubstr("[K]"),
                                       HasSubstr("What it shows too much.")));
  Tandem coupling({"describe", "warming"}, folder_.path());
  EXPECT_EQ(coupling.wait(), 0) << coupling.errors();
  EXPECT_THAT(coupling.output(), HasSubstr("coupling warming: Lamps warm"));
}

TEST_F(Plugins, ThatAreNotThereAreNamedWithFileAndLine) {
  folder_.write("there/wrong.xml", experiment("\n<plugins library=\"libcold\"/>", "libwarm"));
  for (const std::string command : {"run", "check"}) {
    Tandem wrong({command, "there/wrong.xml"}, folder_.path());
    EXPECT_EQ(wrong.wait(), 1);
    EXPECT_THAT(wrong.errors(), AllOf(HasSubstr("there/wrong.xml:2: error: <plugins>: library 'libcold' is not there"),
                                      HasSubstr("there/libcold.so")));
  }
  folder_.write("there/nothing.xml", experiment("<plugins/>", "libwarm"));
  Tandem nothing({"check", "there/nothing.xml"}, folder_.path());
  EXPECT_EQ(nothing.wait(), 1);
  EXPECT_THAT(nothing.errors(), AllOf(HasSubstr("nothing.xml:1: error: <plugins>"), HasSubstr("library")));
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"list"},
                                             {"describe", "thermometer"},
                                             {"bench", "codec"},
                                             {"emulate", "epuck", "--link", "pty:x"},
                                             {"inspect", "serial:x"},
                                             {"upgrade", "there/named.xml", "--dry-run"},
                                             {"compare", "there/named.xml"},
                                             {"robot", "there/named.xml"}}) {
    std::vector<std::string> all = words;
    all.insert(all.end(), {"--plugin", "libcold"});
    Tandem tandem(all, folder_.path());
    EXPECT_EQ(tandem.wait(), 1) << words.front();
    EXPECT_THAT(tandem.errors(), HasSubstr("--plugin: library 'libcold' is not there")) << words.front();
  }
}

TEST_F(Plugins, ThatDoNotFitAreRefusedBeforeTheyRun) {
  const std::string stale = std::string(test::kBuildDir) + "/tests/hal_plugins/libtest_hal_stale.so";  // aborts
  folder_.write("there/stale.xml", experiment("<plugins library=\"" + stale + "\"/>", "libwarm"));
  Tandem run({"run", "there/stale.xml"}, folder_.path());
  EXPECT_EQ(run.wait(), 1);
  EXPECT_THAT(run.errors(),
              AllOf(HasSubstr("stale.xml:1: error: <plugins>: library '" + stale + "' was built against Tandem"),
                    HasSubstr("it uses controller 0"), HasSubstr("cmake --build")));
}

TEST_F(Plugins, AreKnownToTheCommandThatUpgradesFiles) {
  folder_.write("there/old.xml", experiment("<plugins library=\"libwarm\"/>", "libwarm"));
  std::string text = text_of(folder_.path() / "there/old.xml");
  text.replace(text.find("<thermometer"), 12, "<epuck_thermometer");
  text.erase(text.find(" version=\"1\""), 12);
  folder_.write("there/old.xml", text);
  Tandem upgrade({"upgrade", "there/old.xml"}, folder_.path());
  ASSERT_EQ(upgrade.wait(), 0) << upgrade.errors();
  EXPECT_THAT(text_of(folder_.path() / "there/old.xml"), HasSubstr("<thermometer offset"));
  EXPECT_EQ(text_of(folder_.path() / "there/old.xml.bak"), text) << "the old file is kept";
}

}  // namespace
}  // namespace tandem
