// `tandem replay` as a user types it, of a run with an emulated robot whose link failed on the way.
#include <fstream>
#include <gmock/gmock.h>

#include "tests/checkout.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem::scenarios {
namespace {

using testing::HasSubstr;

/// The mixed experiment with a plug-in that lies beside it.
void write_experiment(const Folder& folder) {
  fs::copy_file(std::string(test::kBuildDir) + "/lib/libobstacle_avoidance.so", folder.path() / "libmine.so");
  std::string text = text_of(fs::path(test::kSourceDir) / "configs/epuck_mixed.xml");
  const std::string library = "library=\"obstacle_avoidance\"";
  text.replace(text.find(library), library.size(), "library=\"mine\"");
  folder.write("mixed.xml", text);
}

TEST(ReplayedRobot, ARunIsComputedAgainWithoutTheRobotAndChangedPlugInsAreTold) {
  Folder folder;
  write_experiment(folder);
  {
    EmulatedEpuck epuck(folder, {"--fault", "silent@2s+700ms"});
    ASSERT_TRUE(epuck.ready());
    Tandem run({"run", "mixed.xml", "--seconds", "5", "--record", "run.record"}, folder.path());
    ASSERT_EQ(run.wait(), 0) << run.errors();
  }
  Tandem again({"replay", "run.record", "--report", "again.json", "--threads", "2"}, folder.path());
  EXPECT_EQ(again.wait(), 0) << again.errors();
  EXPECT_EQ(json_value(text_of(folder.path() / "again.json"), "ticks_compared"), "50");

  Tandem what_if({"replay", "run.record", "--from", "30", "--report", "what_if.json"}, folder.path());
  EXPECT_EQ(what_if.wait(), 0) << what_if.errors();
  const std::string report = text_of(folder.path() / "what_if.json");
  EXPECT_EQ(json_value(report, "ticks_compared"), "30");
  EXPECT_EQ(json_value(report, "simulated_from"), "30");
  EXPECT_LT(std::stod("0" + json_value(report, "max_m")), 0.15) << report;  // in two seconds at 5 cm/s

  std::ofstream(folder.path() / "libmine.so", std::ios::app | std::ios::binary) << "changed";
  Tandem changed({"replay", "run.record"}, folder.path());
  EXPECT_EQ(changed.wait(), 1);
  EXPECT_THAT(changed.errors(), HasSubstr("controller avoid"));
  EXPECT_THAT(changed.errors(), HasSubstr("--accept-changes"));
  Tandem accepted({"replay", "run.record", "--accept-changes"}, folder.path());
  EXPECT_EQ(accepted.wait(), 0) << accepted.errors();

  fs::remove(folder.path() / "libmine.so");
  Tandem missing({"replay", "run.record", "--accept-changes"}, folder.path());
  EXPECT_EQ(missing.wait(), 1);
  EXPECT_THAT(missing.errors(), HasSubstr("mine"));
}

}  // namespace
}  // namespace tandem::scenarios
