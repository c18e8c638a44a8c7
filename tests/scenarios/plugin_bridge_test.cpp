// Real robots whose kind, bridge and stopper a plug-in brings: the guardian is forked when their code is there.
#include <gmock/gmock.h>

#include "tests/scenarios/process.hpp"

namespace tandem::scenarios {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class Crawlers : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override { ::setenv("XDG_RUNTIME_DIR", folder_.path().c_str(), 1); }

  std::string experiment(const std::string& plugins) const {
    return "<tandem version=\"1\">" + plugins +
           "<framework><experiment length=\"0\" ticks_per_second=\"20\" random_seed=\"1\"/><time mode=\"realtime\"/>"
           "</framework><controllers><drive id=\"d\" library=\"test_controllers\"><actuators><differential_steering/>"
           "</actuators><sensors/><params left=\"5 cm/s\" right=\"5 cm/s\"/></drive></controllers>"
           "<arena size=\"400,40,4\"><crawler id=\"c0\"><body position=\"-9,0,0\"/><controller config=\"d\"/><bridge "
           "link=\"file:" +
           told().string() + "\"/></crawler></arena></tandem>";
  }
  fs::path told() const { return folder_.path() / "told"; }
  bool was_told(const std::string& what) const {
    return eventually([&] { return text_of(told()).find(what) != std::string::npos; }, 30.0);
  }

  Folder folder_;
};
INSTANTIATE_TEST_SUITE_P(Both, Crawlers, testing::Values("run", "robot"));

TEST_P(Crawlers, OfAPluginAreStoppedByTheGuardianWhenTheirHubIsKilled) {
  folder_.write("e.xml", experiment("<plugins library=\"test_thermometer\"/><plugins library=\"test_crawler\"/>"));
  Tandem hub({GetParam(), "e.xml"}, folder_.path());
  ASSERT_TRUE(was_told("drive")) << hub.errors();
  EXPECT_THAT(text_of(told()), Not(HasSubstr("guardian")));
  // The guardian has the code that it runs, and none of what was loaded after it was forked.
  const std::string maps = text_of("/proc/" + std::to_string(hub.guardian()) + "/maps");
  EXPECT_THAT(maps, AllOf(HasSubstr("libtest_crawler.so"), Not(HasSubstr("libtest_thermometer.so")),
                          Not(HasSubstr("libtest_controllers.so"))));
  hub.signal(SIGKILL);
  EXPECT_EQ(hub.wait(), -SIGKILL);
  EXPECT_TRUE(was_told("told to stand by its guardian")) << text_of(told());
}

TEST_P(Crawlers, AreStoppedByTheirHubWhenItEndsInOrder) {
  folder_.write("e.xml", experiment(""));
  Tandem hub({GetParam(), "e.xml", "--plugin", "test_crawler", "--report", "r.json"}, folder_.path());
  ASSERT_TRUE(was_told("drive")) << hub.errors();
  hub.signal(SIGINT);
  EXPECT_EQ(hub.wait(), 130) << hub.errors();
  EXPECT_THAT(text_of(told()), AllOf(HasSubstr("stopped by its hub"), Not(HasSubstr("guardian"))));
  EXPECT_THAT(text_of(folder_.path() / "r.json"), HasSubstr("libtest_crawler.so"));
}

TEST_P(Crawlers, OfALibraryThatStartsAThreadWhileItIsLoadedAreRefused) {
  const std::string library = std::string(test::kBuildDir) + "/tests/broken_plugins/libtest_crawler_threaded.so";
  folder_.write("e.xml", experiment("\n<plugins library=\"" + library + "\"/>"));
  Tandem hub({GetParam(), "e.xml"}, folder_.path());
  EXPECT_EQ(hub.wait(), 1);
  EXPECT_THAT(hub.errors(),
              AllOf(HasSubstr("e.xml:2: error: <plugins>"), HasSubstr("starts a thread while it is loaded")));
  EXPECT_FALSE(fs::exists(told()));
}

TEST(CrawlersLeftOut, AreSimulated) {
  Folder folder;
  folder.write(
      "e.xml",
      "<tandem version=\"1\"><plugins library=\"test_crawler\"/><framework><experiment length=\"2\" "
      "ticks_per_second=\"20\" "
      "random_seed=\"1\"/></framework><controllers><drive id=\"d\" library=\"test_controllers\"><actuators>"
      "<differential_steering/></actuators><sensors/><params left=\"5 cm/s\" right=\"5 cm/s\"/></drive></controllers>"
      "<arena size=\"40,40,4\"><crawler id=\"c0\"><body position=\"-9,0,0\"/><controller config=\"d\"/><bridge "
      "link=\"file:/nowhere/told\"/></crawler></arena></tandem>");
  Tandem run({"run", "e.xml", "--without", "c0"}, folder.path());
  EXPECT_EQ(run.wait(), 0) << run.errors();
  EXPECT_EQ(run.guardian(), -1);
  Tandem list({"describe", "crawler"}, folder.path());
  EXPECT_EQ(list.wait(), 0) << list.errors();
  EXPECT_THAT(list.output(), HasSubstr("(libtest_crawler.so)"));
}

}  // namespace
}  // namespace tandem::scenarios
