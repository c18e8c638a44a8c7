// Whole runs of the case study.
#include <cmath>
#include <map>

#include "core/space/space.hpp"
#include "hal/device/leds.hpp"
#include "tests/checkout.hpp"
#include "tests/controllers/experiment.hpp"
#include "tests/controllers/test_robot.hpp"

namespace tandem {
namespace {

using test::Experiment;

const std::string kNoise = "footbot_task_partitioning_noise.xml";
const std::string kIdeal = "footbot_task_partitioning_ideal.xml";

/// Objects that were brought in half an hour, in all of some seeds.
double brought(const std::string& config, const std::vector<std::string>& overrides) {
  const std::string csv = test::temporary("throughput.csv");
  std::vector<std::string> all = overrides;
  all.push_back("loop_functions.output=" + csv);
  double sum = 0.0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Experiment(config, all, test::seeded(seed)).run(1800.0);
    sum += test::rows_of(csv).back().at(2);
  }
  std::filesystem::remove(csv);
  return sum;
}

const std::string kAllTheWay = "controllers.footbot_task_partitioning[carry].params.carry=10";

TEST(TaskPartitioning, SuffersLessFromTreelsThatDrawToOneSideThanGoingAllTheWay) {
  const double ideal = brought(kIdeal, {});
  const double noise = brought(kNoise, {});
  EXPECT_GT(ideal, 40.0);
  EXPECT_GT(noise, 40.0);
  const double of_whole_way = brought(kNoise, {kAllTheWay}) / brought(kIdeal, {kAllTheWay});
  EXPECT_LT(of_whole_way, 0.75);
  EXPECT_GT(noise / ideal, of_whole_way + 0.1);
}

TEST(TaskPartitioning, CarriesNoFartherThanItIsTold) {
  const Experiment experiment(kIdeal, {"controllers.footbot_task_partitioning[carry].params.carry=0.5"});
  core::Space& space = experiment->space();
  std::map<std::size_t, core::Pose> gripped;
  int carries = 0;
  experiment->start();
  for (int t = 0; t < 9000; ++t) {
    experiment->step();
    for (std::size_t i = 0; i < space.robot_count(); ++i) {
      const core::Pose pose = space.pose(space.robot(i));
      if (!space.holding(space.robot(i))) {
        gripped.erase(i);
      } else if (gripped.try_emplace(i, pose).second) {
        ++carries;
      } else {
        // What the odometry does not see: where others push it.
        EXPECT_LT(std::hypot(pose.x_m - gripped.at(i).x_m, pose.y_m - gripped.at(i).y_m), 0.60);
      }
    }
  }
  EXPECT_GT(carries, 10);
}

TEST(TaskPartitioning, GripsNoRobotAndNoWall) {
  const Experiment experiment(kNoise);
  core::Space& space = experiment->space();
  experiment->start();
  for (int t = 0; t < 9000; ++t) {
    experiment->step();
    for (std::size_t i = 0; i < space.robot_count(); ++i) {
      if (!space.holding(space.robot(i))) continue;
      const core::Pose pose = space.pose(space.robot(i));
      double nearest_m = 10.0;
      for (const core::Object& o : space.objects()) {
        if (o.movable) nearest_m = std::min(nearest_m, std::hypot(o.x_m - pose.x_m, o.y_m - pose.y_m));
      }
      EXPECT_LT(nearest_m, 0.19) << "robot " << i << " at tick " << t;
    }
  }
}

TEST(TaskPartitioning, GivesTheSameBitsForTheSameSeedAndAnyNumberOfThreads) {
  const std::uint64_t once = test::fingerprint(kNoise, 300.0, test::seeded(5, 0));
  EXPECT_EQ(test::fingerprint(kNoise, 300.0, test::seeded(5, 0)), once);
  EXPECT_EQ(test::fingerprint(kNoise, 300.0, test::seeded(5, 2)), once);
  EXPECT_NE(test::fingerprint(kNoise, 300.0, test::seeded(6, 0)), once);
}

TEST(TaskPartitioning, GoesOnAlikeFromACheckpoint) {
  const Experiment experiment(kNoise);
  experiment->start();
  for (int t = 0; t < 2000; ++t) experiment->step();
  const auto moment = experiment->snapshot();
  ASSERT_TRUE(moment.ok()) << moment.error().message;
  for (int t = 0; t < 1000; ++t) experiment->step();
  const std::uint64_t once = experiment->state_hash();
  ASSERT_TRUE(experiment->restore(moment.value()).ok());
  for (int t = 0; t < 1000; ++t) experiment->step();
  EXPECT_EQ(experiment->state_hash(), once);
}

TEST(TaskPartitioningPlugin, SeesNoWorld) {
  test::expect_no_world_in(std::string(test::kBuildDir) + "/lib/libfootbot_task_partitioning.so");
}

}  // namespace
}  // namespace tandem
