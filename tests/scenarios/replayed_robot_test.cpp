// `tandem replay` as a user types it, of a run with an emulated robot whose link failed on the way.
#include <fstream>
#include <gmock/gmock.h>

#include "core/record/record_reader.hpp"
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
  const std::string end = "  </controllers>";
  text.replace(text.find(end), end.size(),
               "    <obstacle_avoidance id=\"slow\" library=\"mine\"><actuators><differential_steering/></actuators>"
               "<sensors><proximity/></sensors><params cruise=\"1\"/></obstacle_avoidance>\n" +
                   end);
  folder.write("mixed.xml", text);
}

TEST(ReplayedRobot, ARunIsComputedAgainWithoutTheRobotAndChangedPlugInsAreTold) {
  Folder folder;
  write_experiment(folder);
  {
    EmulatedEpuck epuck(folder, {"--fault", "silent@drive+1s+700ms"});
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

  // With other settings and controllers from there on: until then it is the same run, and every tick is compared.
  const auto what_if_with = [&](std::vector<std::string> more, const std::string& dump) {
    std::vector<std::string> all = {"replay",       "run.record", "--from", "30",           "--report",
                                    "changed.json", "--dump",     dump,     "--dump-every", "1"};
    all.insert(all.end(), more.begin(), more.end());
    Tandem run(all, folder.path());
    EXPECT_EQ(run.wait(), 0) << run.errors();
    EXPECT_EQ(json_value(text_of(folder.path() / "changed.json"), "ticks_compared"), "30") << dump;
    return text_of(folder.path() / dump);
  };
  const std::string plain = what_if_with({}, "plain");
  EXPECT_EQ(what_if_with({"--set", "controllers.obstacle_avoidance[avoid].params.cruise=5.0"}, "equal"), plain);
  const std::string slower = what_if_with({"--set", "controllers.obstacle_avoidance[avoid].params.cruise=2"}, "slower");
  EXPECT_NE(slower, plain);
  const std::string behind = "\n31,";  // the state after 31 ticks: the first with the change
  EXPECT_EQ(slower.substr(0, slower.find(behind)), plain.substr(0, plain.find(behind)));
  EXPECT_EQ(what_if_with({"--set", "controllers.obstacle_avoidance[avoid].params.cruise=2", "--threads", "2"}, "two"),
            slower);
  EXPECT_NE(what_if_with({"--controller", "ep0=slow", "--record", "real.record"}, "real"), plain);
  auto told = core::RecordReader::open((folder.path() / "real.record").string());
  ASSERT_TRUE(told.ok()) << told.error().message;
  std::string changes;
  while (const auto entry = told.value().next()) {
    if (entry->type == core::RecordBlock::Event && entry->tick == 30 && entry->json.value("kind", "") == "what if")
      changes = entry->json.value("text", "");
  }
  EXPECT_EQ(changes, "ep0=slow");
  EXPECT_NE(what_if_with({"--controller", "sim=slow"}, "simulated"), plain);
  EXPECT_EQ(json_value(text_of(folder.path() / "changed.json"), "changed_from"), "30");
  folder.write("fitted.xml",
               "<fitted version=\"1\"><model kind=\"e-puck\"><fitted_wheels>"
               "<mean left=\"0.9\" right=\"1.1\" noise=\"0.003\" delay=\"130 ms\"/></fitted_wheels></model></fitted>");
  const std::string fitted = what_if_with({"--set", "fitted.file=fitted.xml"}, "fitted");
  EXPECT_EQ(fitted.substr(0, fitted.find(behind)), plain.substr(0, plain.find(behind)));
  EXPECT_NE(fitted, plain);
  EXPECT_EQ(what_if_with({"--set", "fitted.file=fitted.xml", "--threads", "2"}, "fitted_by_two"), fitted);

  for (const char* fixed :
       {"arena.distribute.entity.quantity=3", "framework.experiment.ticks_per_second=20",
        "framework.experiment.random_seed=3", "arena.size=3,3,1", "physics_engines.kinematics2d[kin].id=other"}) {
    Tandem refused({"replay", "run.record", "--from", "30", "--set", fixed}, folder.path());
    EXPECT_EQ(refused.wait(), 1) << fixed;
    EXPECT_THAT(refused.errors(), HasSubstr("cannot change while the run goes on: ")) << fixed;
    EXPECT_THAT(refused.errors(), HasSubstr("Leave out --from")) << fixed;
  }
  Tandem wrong(
      {"replay", "run.record", "--from", "30", "--set", "controllers.obstacle_avoidance[avoid].params.cruise=fast"},
      folder.path());
  EXPECT_EQ(wrong.wait(), 1);
  EXPECT_THAT(wrong.errors(), HasSubstr("cruise"));
  Tandem from_start({"replay", "run.record", "--set", "controllers.obstacle_avoidance[avoid].params.cruise=2"},
                    folder.path());
  EXPECT_EQ(from_start.wait(), 0) << from_start.errors();
  EXPECT_THAT(from_start.errors(), HasSubstr("is the first that is not as recorded"));

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
