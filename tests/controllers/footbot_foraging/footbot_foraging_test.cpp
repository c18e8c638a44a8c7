// The behaviour and its hook: neither says anything without the other.
#include <cmath>
#include <numbers>

#include "hal/device/leds.hpp"
#include "hal/robot/footbot.hpp"
#include "tests/checkout.hpp"
#include "tests/controllers/experiment.hpp"
#include "tests/controllers/test_robot.hpp"

namespace tandem {
namespace {

using test::Experiment;

const std::string kConfig = "footbot_foraging.xml";
enum Column : std::size_t { kTime, kOutside, kInside, kBringing, kCollected, kEnergy };

std::vector<std::vector<double>> forage(std::vector<std::string> overrides, double seconds, std::uint64_t seed = 1) {
  const std::string csv = test::temporary("foraging.csv");
  overrides.push_back("loop_functions.output=" + csv);
  Experiment(kConfig, overrides, test::seeded(seed)).run(seconds);
  const auto rows = test::rows_of(csv);
  std::filesystem::remove(csv);
  return rows;
}

TEST(Foraging, CollectsFoodAndAccountsForIt) {
  const auto rows = forage({}, 600.0);
  ASSERT_EQ(rows.size(), 60U);
  EXPECT_EQ(rows.back()[kTime], 600.0);
  EXPECT_GT(rows.back()[kCollected], 5.0);  // of seeds 1 to 8: 8 to 20, 13 in the mean
  double before = 0.0;
  for (const auto& row : rows) {
    EXPECT_EQ(row[kOutside] + row[kInside], 10.0);
    EXPECT_LE(row[kBringing], row[kOutside]);
    EXPECT_GE(row[kCollected], before);
    before = row[kCollected];
  }
}

TEST(Foraging, CountsAnItemForEachRobotThatComesHomeWithAGreenBeacon) {
  const std::string csv = test::temporary("green.csv");
  const Experiment e(kConfig, {"loop_functions.output=" + csv, "loop_functions.every=1"}, test::seeded(1));
  const core::Space& space = e->space();
  std::vector<bool> out_with_item(space.robot_count(), false);
  int brought = 0;
  e->start();
  for (int t = 0; t < 6000; ++t) {
    e->step();
    for (std::size_t i = 0; i < space.robot_count(); ++i) {
      const bool green =
          space.port<hal::RingLeds>(space.robot(i))->color(hal::footbot::kind().part<hal::LedsPart>()->beacon_led()) ==
          hal::kGreen;
      ASSERT_EQ(space.published_text(space.robot(i), "state").value() == "bring", green) << "at tick " << t;
      const bool home = space.pose(space.robot(i)).x_m < -1.5;
      if (green && !home) out_with_item[i] = true;
      if (home && out_with_item[i]) {
        out_with_item[i] = false;
        ++brought;
      }
    }
  }
  e->finish();
  EXPECT_GT(brought, 10);
  EXPECT_EQ(test::rows_of(csv).back()[kCollected], brought);
  std::filesystem::remove(csv);
}

TEST(Foraging, PaysForEachSecondOutside) {
  const auto rows = forage(
      {"loop_functions.energy_per_item=100", "loop_functions.power_outside=2", "loop_functions.every=0.1"}, 120.0);
  ASSERT_EQ(rows.size(), 1200U);
  double cost_J = 0.0;
  for (const auto& row : rows) {
    cost_J += 2.0 * 0.1 * row[kOutside];
    ASSERT_NEAR(row[kEnergy], 100.0 * row[kCollected] - cost_J, 1e-6);
  }
  EXPECT_GT(cost_J, 100.0);
}

TEST(Foraging, LessFoodKeepsMoreRobotsAtHome) {
  const auto mean_outside = [](const std::string& items) {
    double sum = 0.0;
    const auto rows = forage({"loop_functions.items=" + items}, 1200.0);
    for (std::size_t i = rows.size() / 2; i < rows.size(); ++i) sum += rows[i][kOutside];
    return sum / static_cast<double>(rows.size() / 2);
  };
  EXPECT_LT(mean_outside("1"), 0.8 * mean_outside("100"));  // of seeds 1 to 6: 3.3 to 4.1 against 7.3 to 7.8
}

TEST(Foraging, RobotsThatGoTakeNoFoodWithThem) {
  const Experiment e(kConfig, {"loop_functions.items=1", "loop_functions.radius=0.3"}, test::seeded(3));
  core::Space& space = e->space();
  e->start();
  int t = 0;
  bool taken = false;
  for (; t < 20000 && !taken; ++t) {
    e->step();
    for (std::size_t i = space.robot_count(); i-- > 0;) {
      if (space.port<hal::RingLeds>(space.robot(i))->color(hal::footbot::kind().part<hal::LedsPart>()->beacon_led()) !=
          hal::kGreen)
        continue;
      space.remove_robot(space.robot(i));
      taken = true;
      break;
    }
  }
  ASSERT_TRUE(taken);
  while (space.robot_count() > 0) space.remove_robot(space.robot(0));  // nobody else may take it
  for (int k = 0; k < 5; ++k) e->step();
  // The floor has a pixel every 2 cm. Those whose middle is within r of the item's are black: as squares they lie
  // within r + half a diagonal and cover all within r - half a diagonal.
  constexpr double kPixel_m = 0.02, kRadius_m = 0.3;
  int black = 0;
  for (int i = 0; i < 250; ++i) {
    for (int k = 0; k < 210; ++k)
      black += space.floor(-2.5 + kPixel_m * (i + 0.5), -2.1 + kPixel_m * (k + 0.5)) < 0.2 ? 1 : 0;
  }
  const auto pixels_within = [&](double radius_m) { return std::numbers::pi * std::pow(radius_m / kPixel_m, 2); };
  const double half_diagonal_m = kPixel_m / std::numbers::sqrt2;
  EXPECT_GE(black, pixels_within(kRadius_m - half_diagonal_m));  // the whole item is back
  EXPECT_LE(black, pixels_within(kRadius_m + half_diagonal_m));
}

TEST(Foraging, GivesTheSameBitsForTheSameSeedAndAnyNumberOfThreads) {
  const std::uint64_t once = test::fingerprint(kConfig, 120.0, test::seeded(5));
  EXPECT_EQ(test::fingerprint(kConfig, 120.0, test::seeded(5)), once);
  EXPECT_EQ(test::fingerprint(kConfig, 120.0, test::seeded(5, 2)), once);
  EXPECT_NE(test::fingerprint(kConfig, 120.0, test::seeded(6)), once);
}

TEST(ForagingPlugin, SeesNoWorld) {
  test::expect_no_world_in(std::string(test::kBuildDir) + "/lib/libfootbot_foraging.so");
}

}  // namespace
}  // namespace tandem
