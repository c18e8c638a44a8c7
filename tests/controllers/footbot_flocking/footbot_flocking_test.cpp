// The flock's pattern and its way.
#include <cmath>
#include <complex>

#include "tests/checkout.hpp"
#include "tests/controllers/experiment.hpp"
#include "tests/controllers/test_robot.hpp"

namespace tandem {
namespace {

const std::string kConfig = "footbot_flocking.xml";
const std::string kParams = "controllers.footbot_flocking[flock].params.";
constexpr double kDistance_m = 0.6;

struct Flock {
  double x_m = 0.0, y_m = 0.0;         // of the middle
  double nearest_m = 0.0;              // mean distance of a robot to the nearest other
  double least_m = 1e9, most_m = 0.0;  // of those distances
  double hexagonal = 0.0;              // mean |mean of e^(6 i bearing)| of neighbours: 1 in a hexagonal pattern
  std::complex<double> heading = 0.0;  // mean of e^(i heading): 1 when all look alike
};

Flock measure(const core::Space& space) {
  Flock f;
  const std::size_t n = space.robot_count();
  std::vector<core::Pose> poses;
  for (std::size_t i = 0; i < n; ++i) {
    poses.push_back(space.pose(space.robot(i)));
    f.x_m += poses[i].x_m / static_cast<double>(n);
    f.y_m += poses[i].y_m / static_cast<double>(n);
    f.heading += std::polar(1.0 / static_cast<double>(n), poses[i].heading_rad());
  }
  for (const core::Pose& a : poses) {
    double nearest_m = 1e9;
    std::complex<double> sixfold = 0.0;
    int neighbours = 0;
    for (const core::Pose& b : poses) {
      if (&a == &b) continue;
      const double distance_m = std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
      nearest_m = std::min(nearest_m, distance_m);
      if (distance_m > 1.4 * kDistance_m) continue;
      sixfold += std::polar(1.0, 6.0 * std::atan2(b.y_m - a.y_m, b.x_m - a.x_m));
      ++neighbours;
    }
    f.nearest_m += nearest_m / static_cast<double>(n);
    f.least_m = std::min(f.least_m, nearest_m);
    f.most_m = std::max(f.most_m, nearest_m);
    if (neighbours > 0) f.hexagonal += std::abs(sixfold) / neighbours / static_cast<double>(n);
  }
  return f;
}

TEST(Flocking, FormsAHexagonalPatternThatMovesToTheLight) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const test::Experiment experiment(kConfig, {}, test::seeded(seed));
    const Flock before = measure(experiment->space());
    experiment.run(120.0);
    const Flock after = measure(experiment->space());
    EXPECT_LT(before.hexagonal, 0.6);
    EXPECT_GT(after.hexagonal, 0.95) << "seed " << seed;
    // A little closer than two alone would stay: those behind the neighbours pull, too.
    EXPECT_NEAR(after.nearest_m, 0.96 * kDistance_m, 0.02 * kDistance_m) << "seed " << seed;
    EXPECT_GT(after.least_m, 0.9 * kDistance_m) << "seed " << seed;
    EXPECT_LT(after.most_m, 1.05 * kDistance_m) << "seed " << seed << ": somebody is left behind";
    // At 4 cm/s, 0.4 of full speed, to the west, all but some seconds in which the pattern forms.
    EXPECT_LT(after.x_m, before.x_m - 0.04 * 100.0) << "seed " << seed;
    EXPECT_NEAR(after.y_m, before.y_m, 0.3) << "seed " << seed;
    EXPECT_GT(std::abs(after.heading), 0.98) << "seed " << seed;
    EXPECT_LT(after.heading.real(), -0.95) << "seed " << seed;
  }
}

TEST(Flocking, StaysWhereItIsInTheDark) {
  const test::Experiment experiment(kConfig, {kParams + "light_gain=0"}, test::seeded(1));
  const Flock before = measure(experiment->space());
  experiment.run(120.0);
  const Flock after = measure(experiment->space());
  EXPECT_NEAR(after.x_m, before.x_m, 0.1);
  EXPECT_NEAR(after.y_m, before.y_m, 0.1);
  EXPECT_NEAR(after.nearest_m, 0.96 * kDistance_m, 0.03 * kDistance_m);
  EXPECT_LT(std::abs(after.heading), 0.5);
}

TEST(Flocking, FallsApartWithoutPushAndPull) {
  const test::Experiment experiment(kConfig, {kParams + "gain=0"}, test::seeded(1));
  experiment.run(120.0);
  const Flock after = measure(experiment->space());
  EXPECT_LT(after.least_m, 0.7 * kDistance_m);
}

TEST(Flocking, TwoKeepTheDistanceAtWhichNothingPullsAndNothingPushes) {
  for (const double gap_m : {0.3, 0.9}) {
    const test::Experiment experiment(kConfig, {kParams + "light_gain=0", "arena.distribute[0].entity.quantity=2"},
                                      test::seeded(1));
    core::Space& space = experiment->space();
    experiment->start();
    space.set_pose(space.robot(0), core::Pose::at(0.0, 0.0, 0.0));
    space.set_pose(space.robot(1), core::Pose::at(gap_m, 0.0, 0.0));
    for (int t = 0; t < 600; ++t) experiment->step();
    EXPECT_NEAR(measure(space).nearest_m, kDistance_m, 0.02) << gap_m;
  }
}

TEST(Flocking, GivesTheSameBitsForTheSameSeedAndAnyNumberOfThreads) {
  const std::uint64_t once = test::fingerprint(kConfig, 60.0, test::seeded(5));
  EXPECT_EQ(test::fingerprint(kConfig, 60.0, test::seeded(5)), once);
  EXPECT_EQ(test::fingerprint(kConfig, 60.0, test::seeded(5, 2)), once);
  EXPECT_NE(test::fingerprint(kConfig, 60.0, test::seeded(6)), once);
}

TEST(FlockingPlugin, SeesNoWorld) {
  test::expect_no_world_in(std::string(test::kBuildDir) + "/lib/libfootbot_flocking.so");
}

}  // namespace
}  // namespace tandem
