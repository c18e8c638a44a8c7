// Flashes come together, measured by Kuramoto's order parameter.
#include <cmath>
#include <complex>
#include <numbers>

#include "hal/device/leds.hpp"
#include "hal/robot/footbot.hpp"
#include "tests/checkout.hpp"
#include "tests/controllers/experiment.hpp"
#include "tests/controllers/test_robot.hpp"

namespace tandem {
namespace {

const std::string kConfig = "footbot_synchronization.xml";
const std::string kParams = "controllers.footbot_synchronization[flash].params.";
constexpr double kPeriod_s = 5.0;

/// Watches the beacons: when each robot began to flash last.
class Watch {
 public:
  explicit Watch(const test::Experiment& experiment)
      : experiment_(experiment), began_s_(experiment->space().robot_count(), -1.0), lit_(began_s_.size(), false) {}

  void run(double seconds) {
    for (long t = 0; t < std::lround(seconds * 10.0); ++t) {
      experiment_->step();
      now_s_ += 0.1;
      look();
    }
  }
  /// |mean of e^(i phase)| over all robots: 1 in unison, about 1 / sqrt(robots) at random.
  double order() const {
    std::complex<double> sum = 0.0;
    for (const double began_s : began_s_) {
      EXPECT_GE(began_s, 0.0) << "a robot has not flashed yet";
      sum += std::polar(1.0, 2.0 * std::numbers::pi * (now_s_ - began_s) / kPeriod_s);
    }
    return std::abs(sum) / static_cast<double>(began_s_.size());
  }
  /// Until nobody has begun to flash for `seconds`; fails when that does not happen.
  void run_until_dark_for(double seconds) {
    for (int t = 0; t < 200 && now_s_ - *std::max_element(began_s_.begin(), began_s_.end()) < seconds; ++t) run(0.1);
    EXPECT_GE(now_s_ - *std::max_element(began_s_.begin(), began_s_.end()), seconds - 1e-6);
  }
  /// Between the robots that began their last flash first and last.
  double spread_s() const {
    const auto [first, last] = std::minmax_element(began_s_.begin(), began_s_.end());
    return *last - *first;
  }
  std::size_t flashes() const { return flashes_; }

 private:
  void look() {
    const core::Space& space = experiment_->space();
    for (std::size_t i = 0; i < began_s_.size(); ++i) {
      const bool lit =
          space.port<hal::RingLeds>(space.robot(i))->color(hal::footbot::kind().part<hal::LedsPart>()->beacon_led()) ==
          hal::kRed;
      if (lit && !lit_[i]) {
        began_s_[i] = now_s_;
        ++flashes_;
      }
      lit_[i] = lit;
    }
  }

  const test::Experiment& experiment_;
  std::vector<double> began_s_;
  std::vector<bool> lit_;
  double now_s_ = 0.0;
  std::size_t flashes_ = 0;
};

/// Order after `seconds` on.
double order_after(std::uint64_t seed, const std::string& coupling, double seconds) {
  const test::Experiment experiment(kConfig, {kParams + "coupling=" + coupling}, test::seeded(seed));
  experiment->start();
  Watch watch(experiment);
  watch.run(seconds);
  return watch.order();
}

TEST(Synchronization, BringsAllFlashesTogether) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    EXPECT_LT(order_after(seed, "0", kPeriod_s + 0.1), 0.6) << "of 25 at random it is more once in 8,000 times";
    const test::Experiment experiment(kConfig, {}, test::seeded(seed));
    experiment->start();
    Watch watch(experiment);
    watch.run(120.0);
    EXPECT_GT(watch.order(), 0.95) << "seed " << seed;
    watch.run_until_dark_for(1.0);
    EXPECT_LE(watch.spread_s(), 0.31) << "seed " << seed;
  }
}

TEST(Synchronization, LeavesEachRobotItsOwnTimeWithoutCoupling) {
  const test::Experiment experiment(kConfig, {kParams + "coupling=0"}, test::seeded(1));
  experiment->start();
  Watch watch(experiment);
  watch.run(kPeriod_s + 0.1);
  const double before = watch.order();
  EXPECT_LT(before, 0.6);
  watch.run(20.0 * kPeriod_s);
  EXPECT_NEAR(watch.order(), before, 0.05);
  EXPECT_NEAR(static_cast<double>(watch.flashes()), 21.0 * 25.0, 25.0);
}

TEST(Synchronization, LooksAtOthersAlone) {
  // One that sees nobody keeps its period: it is not carried away by its own light.
  const test::Experiment experiment(kConfig, {"arena.distribute[0].entity.quantity=1"}, test::seeded(2));
  experiment->start();
  Watch watch(experiment);
  watch.run(10.0 * kPeriod_s + 0.1);
  EXPECT_NEAR(static_cast<double>(watch.flashes()), 10.0, 1.0);
}

TEST(Synchronization, GivesTheSameBitsForTheSameSeedAndAnyNumberOfThreads) {
  const std::uint64_t once = test::fingerprint(kConfig, 60.0, test::seeded(5));
  EXPECT_EQ(test::fingerprint(kConfig, 60.0, test::seeded(5)), once);
  EXPECT_EQ(test::fingerprint(kConfig, 60.0, test::seeded(5, 2)), once);
  EXPECT_NE(test::fingerprint(kConfig, 60.0, test::seeded(6)), once);
}

TEST(SynchronizationPlugin, SeesNoWorld) {
  test::expect_no_world_in(std::string(test::kBuildDir) + "/lib/libfootbot_synchronization.so");
}

}  // namespace
}  // namespace tandem
