#include "mixed_reality/tracking/pose_filter.hpp"

#include <Eigen/LU>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <random>
#include <vector>

namespace tandem::mixed_reality {
namespace {

constexpr hal::TimeNs kMs = hal::kNsPerMs;
constexpr hal::TimeNs kTick_ns = 100 * kMs;
constexpr double kBase_m = 0.12;

/// A robot that is no filter: small steps of 1 ms, wheels that slip by chance, a gyroscope with a bias, a camera.
struct Truth {
  explicit Truth(unsigned seed) : chance(seed) {}

  double x_m = 0.0, y_m = 0.0, heading_rad = 0.0;
  double left_scale = 1.0, right_scale = 1.0, base_scale = 1.0;  // truth a metre of the encoders
  double wheel_noise_m = 0.004;
  hal::TimeNs now_ns = 0;
  std::mt19937_64 chance;

  double normal(double sd) { return std::normal_distribution<double>(0.0, 1.0)(chance) * sd; }

  struct Rolled {
    double left_m = 0.0, right_m = 0.0, turn_rad = 0.0;
  };
  /// Drives so for a while; what its encoders say, and how far it turned.
  Rolled drive(double left_m_s, double right_m_s, hal::TimeNs for_ns) {
    Rolled rolled;
    for (hal::TimeNs t = 0; t < for_ns; t += kMs) {
      const double left_m = left_m_s * 1e-3, right_m = right_m_s * 1e-3;
      rolled.left_m += left_m;
      rolled.right_m += right_m;
      const double true_left_m = left_m * left_scale + normal(wheel_noise_m * std::sqrt(std::fabs(left_m)));
      const double true_right_m = right_m * right_scale + normal(wheel_noise_m * std::sqrt(std::fabs(right_m)));
      const double turn_rad = (true_right_m - true_left_m) / (kBase_m * base_scale);
      const double way_m = 0.5 * (true_left_m + true_right_m);
      x_m += way_m * std::cos(heading_rad + 0.5 * turn_rad);
      y_m += way_m * std::sin(heading_rad + 0.5 * turn_rad);
      heading_rad += turn_rad;
      rolled.turn_rad += turn_rad;
      now_ns += kMs;
    }
    return rolled;
  }
  PoseMeasurement seen(double sd_m, double sd_rad) {
    return {0, now_ns, x_m + normal(sd_m), y_m + normal(sd_m), heading_rad + normal(sd_rad), sd_m, sd_rad};
  }
};

hal::TimeNs to_ns(double seconds) noexcept {
  return static_cast<hal::TimeNs>(std::llround(seconds * 1e9));
}

double wrapped(double rad) {
  return std::remainder(rad, 2.0 * std::numbers::pi);
}

double nees(const PoseEstimate& estimate, const Truth& truth) {
  const Eigen::Vector3d e(estimate.pose.x_m - truth.x_m, estimate.pose.y_m - truth.y_m,
                          wrapped(estimate.pose.heading_rad() - truth.heading_rad));
  return e.dot(estimate.covariance.inverse() * e);
}

struct Pending {
  hal::TimeNs arrives_ns;
  PoseMeasurement pose;
};

TEST(PoseFilter, FollowsItsWheelsAloneAndItsUncertaintyGrowsWithTheWay) {
  PoseFilter filter(core::Pose::at(0.0, 0.0, 0.0), 0, 1e-4, 1e-4, kBase_m, {});
  double last_m = 0.0;
  for (int i = 1; i <= 100; ++i) {
    filter.roll(i * kTick_ns, 0.02, 0.02);
    const double sd_m = std::sqrt(filter.now().covariance(0, 0));
    EXPECT_GT(sd_m, last_m);
    last_m = sd_m;
  }
  EXPECT_NEAR(filter.now().pose.x_m, 2.0, 1e-9);
  EXPECT_NEAR(filter.now().pose.y_m, 0.0, 1e-9);
  const PoseEstimate later = filter.at(100 * kTick_ns + kTick_ns / 2);
  EXPECT_NEAR(later.pose.x_m, 2.01, 1e-9) << "carried on";
}

TEST(PoseFilter, APoseThatComesLateGivesTheSameAsInTime) {
  Truth truth(3);
  PoseFilter in_time(core::Pose::at(0.0, 0.0, 0.0), 0, 0.05, 0.05, kBase_m, {});
  PoseFilter late(core::Pose::at(0.0, 0.0, 0.0), 0, 0.05, 0.05, kBase_m, {});
  std::vector<PoseMeasurement> kept;
  for (int i = 0; i < 20; ++i) {
    const auto rolled = truth.drive(0.1, 0.14, kTick_ns);
    in_time.roll(truth.now_ns, rolled.left_m, rolled.right_m);
    late.roll(truth.now_ns, rolled.left_m, rolled.right_m);
    PoseMeasurement seen = truth.seen(0.002, 0.01);
    seen.taken_ns -= kTick_ns / 3;
    if (i % 5 != 4) continue;
    EXPECT_EQ(in_time.correct(seen), PoseFilter::Taken::Used);
    kept.push_back(seen);
  }
  for (auto it = kept.rbegin(); it != kept.rend(); ++it) EXPECT_EQ(late.correct(*it), PoseFilter::Taken::Used);
  EXPECT_NEAR(late.now().pose.x_m, in_time.now().pose.x_m, 2e-3);
  EXPECT_NEAR(late.now().pose.y_m, in_time.now().pose.y_m, 2e-3);
  EXPECT_NEAR(late.now().covariance.trace(), in_time.now().covariance.trace(), 0.1 * in_time.now().covariance.trace());
}

/// What a robot has, and what happens to it.
struct Consistency {
  bool gyroscope = true;
  bool headings = true;  // the tracker sees more than points
  bool carried = false;  // somebody puts it elsewhere in the middle of the run
  // Of runs of a minute whose wheels, bias and delay are as wrong as was assumed:
  double mean = 0.0, mean_after_gap = 0.0;  // in the mean; three numbers: 3 where the filter is as wrong as it says
  void measure(int runs);
};

void Consistency::measure(int runs) {
  double sum = 0.0, sum_after_gap = 0.0;
  int count = 0;
  for (int run = 0; run < runs; ++run) {
    Truth truth(1000U + static_cast<unsigned>(run));
    const PoseFilterParams params;
    truth.left_scale = 1.0 + truth.normal(params.scale);
    truth.right_scale = 1.0 + truth.normal(params.scale);
    truth.base_scale = 1.0 + truth.normal(params.base);
    const double bias_rad_s = truth.normal(params.bias_rad_s);
    const double delay_s = std::fabs(truth.normal(params.delay_s));
    PoseFilter filter(core::Pose::at(truth.normal(0.01), truth.normal(0.01), truth.normal(0.05)), 0, 0.01, 0.05,
                      kBase_m, params);
    std::vector<Pending> pending;
    for (int i = 0; i < 600; ++i) {
      const double turn = 0.06 * std::sin(0.05 * i) + 0.03;
      const auto rolled = truth.drive(0.15 - turn, 0.15 + turn, kTick_ns);
      const double gyroscope_rad =
          rolled.turn_rad + bias_rad_s * 0.1 + truth.normal(params.gyroscope_rad_s * std::sqrt(0.1));
      filter.roll(truth.now_ns, rolled.left_m, rolled.right_m, gyroscope ? std::optional(gyroscope_rad) : std::nullopt);
      if (carried && i == 200) {
        truth.x_m += 0.6;
        truth.heading_rad += 1.0;
      }
      const bool blind = i > 300 && i < 330;
      if (!blind && truth.normal(1.0) < 1.64) {  // 5 % are lost
        PoseMeasurement seen = truth.seen(0.002, 0.01);
        if (!headings) seen.heading_rad.reset();
        seen.taken_ns += to_ns(delay_s);  // its stamp is late by what nobody says
        pending.push_back({truth.now_ns + 160 * kMs, seen});
      }
      while (!pending.empty() && pending.front().arrives_ns <= truth.now_ns) {
        (void)filter.correct(pending.front().pose);
        pending.erase(pending.begin());
      }
      if (i > 50 && i % 50 == 0 && (!carried || i < 200 || i > 240)) {
        sum += nees(filter.now(), truth);
        ++count;
      }
      if (i == 329) sum_after_gap += nees(filter.now(), truth);
    }
    EXPECT_LE(filter.gated(), carried ? 40U : 20U) << "of 570 true ones";
    EXPECT_EQ(filter.moved(), carried ? 1U : 0U);
    const auto learnt = filter.learnt();
    EXPECT_NEAR(learnt.left, truth.left_scale, 5.0 * learnt.sd[0]);
    EXPECT_NEAR(learnt.right, truth.right_scale, 5.0 * learnt.sd[1]);
    EXPECT_NEAR(learnt.base, truth.base_scale, 5.0 * learnt.sd[2]);
    EXPECT_NEAR(learnt.bias_rad_s, bias_rad_s, 5.0 * learnt.sd[3]) << "without a gyroscope nothing is learnt of it";
    EXPECT_NEAR(learnt.delay_s[0], delay_s, 5.0 * learnt.sd[4]);
    EXPECT_LT(learnt.sd[0], 0.01) << "it has learnt something";
  }
  mean = sum / count;
  mean_after_gap = sum_after_gap / runs;
}

// Of 1,000 values in runs that are alike within themselves the mean is known by a tenth; after the gap by a fifth.
TEST(PoseFilter, IsAsWrongAsItSays) {
  Consistency c;
  c.measure(100);
  EXPECT_NEAR(c.mean, 3.0, 0.75);
  EXPECT_NEAR(c.mean_after_gap, 3.0, 1.0);
}

TEST(PoseFilter, IsAsWrongAsItSaysWithoutAGyroscope) {
  Consistency c;
  c.gyroscope = false;
  c.measure(60);
  EXPECT_NEAR(c.mean, 3.0, 0.9);
  EXPECT_NEAR(c.mean_after_gap, 3.0, 1.3);
}

TEST(PoseFilter, IsAsWrongAsItSaysWhereATrackerSeesPoints) {
  Consistency c;
  c.headings = false;
  c.measure(60);
  EXPECT_NEAR(c.mean, 3.0, 0.9);
  EXPECT_NEAR(c.mean_after_gap, 3.0, 1.3);
}

TEST(PoseFilter, IsAsWrongAsItSaysAfterItWasCarried) {
  Consistency c;
  c.carried = true;
  c.measure(60);
  EXPECT_NEAR(c.mean, 3.0, 0.9);
}

// Along a straight way a filter that counts with q of slip a tick, and r of the tracker, comes to the gain k of its
// Riccati equation and says k r. Without slip the error is what k leaves of the tracker's noise alone, k r / (2 - k),
// which is 1 / (2 - k) of what it says. More care than that would be a mistake.
TEST(PoseFilter, IsAsCarefulAboutWheelsThatDoNotSlipAsItsAssumptionMakesIt) {
  constexpr double kWay_m = 0.01, kSeen_m = 0.002;
  constexpr int kTicks = 20'000;
  PoseFilterParams params;
  params.scale = params.base = params.delay_s = 1e-6;
  const double q = 0.5 * params.wheel_noise_m * params.wheel_noise_m * kWay_m, r = kSeen_m * kSeen_m;
  const double predicted = 0.5 * q + std::sqrt(0.25 * q * q + q * r);
  const double gain = predicted / (predicted + r);
  Truth truth(11);
  truth.wheel_noise_m = 0.0;
  PoseFilter filter(core::Pose::at(0.0, 0.0, 0.0), 0, 0.001, 0.001, kBase_m, params);
  double sum = 0.0;
  for (int i = 0; i < kTicks; ++i) {
    const auto rolled = truth.drive(kWay_m / 0.1, kWay_m / 0.1, kTick_ns);
    filter.roll(truth.now_ns, rolled.left_m, rolled.right_m);
    (void)filter.correct(truth.seen(kSeen_m, 0.01));
    const PoseEstimate now = filter.now();
    if (i >= 1000) sum += std::pow(now.pose.x_m - truth.x_m, 2) / now.covariance(0, 0);
  }
  EXPECT_NEAR(filter.now().covariance(0, 0), gain * r, 0.02 * gain * r);
  EXPECT_NEAR(sum / (kTicks - 1000), 1.0 / (2.0 - gain), 0.1 / (2.0 - gain));
}

TEST(PoseFilter, APoseFromNowhereIsGatedAndARobotThatWasCarriedIsFoundAgain) {
  Truth truth(5);
  PoseFilterParams params;
  params.delay_s = 0.0;
  PoseFilter filter(core::Pose::at(0.0, 0.0, 0.0), 0, 0.01, 0.05, kBase_m, params);
  const auto tick = [&] {
    const auto rolled = truth.drive(0.1, 0.1, kTick_ns);
    filter.roll(truth.now_ns, rolled.left_m, rolled.right_m);
  };
  for (int i = 0; i < 20; ++i) {
    tick();
    EXPECT_EQ(filter.correct(truth.seen(0.002, 0.01)), PoseFilter::Taken::Used);
  }
  tick();
  PoseMeasurement swapped = truth.seen(0.002, 0.01);
  swapped.x_m += 0.5;
  EXPECT_EQ(filter.correct(swapped), PoseFilter::Taken::Gated);
  tick();
  EXPECT_EQ(filter.correct(truth.seen(0.002, 0.01)), PoseFilter::Taken::Used);
  truth.x_m += 0.7;
  truth.heading_rad += 1.0;
  std::vector<PoseFilter::Taken> taken;
  for (int i = 0; i < 6; ++i) {
    tick();
    taken.push_back(filter.correct(truth.seen(0.002, 0.01)));
  }
  for (int i = 0; i < 4; ++i) EXPECT_EQ(taken[static_cast<std::size_t>(i)], PoseFilter::Taken::Gated);
  EXPECT_EQ(taken[4], PoseFilter::Taken::Moved);
  EXPECT_EQ(taken[5], PoseFilter::Taken::Used);
  EXPECT_EQ(filter.moved(), 1U);
  EXPECT_NEAR(filter.now().pose.x_m, truth.x_m, 0.02);
  EXPECT_NEAR(wrapped(filter.now().pose.heading_rad() - truth.heading_rad), 0.0, 0.05);
}

TEST(PoseFilter, NonsenseAndPosesOlderThanAllThatIsKeptChangeNothing) {
  Truth truth(7);
  PoseFilter filter(core::Pose::at(0.0, 0.0, 0.0), 0, 0.01, 0.05, kBase_m, {});
  for (int i = 0; i < 300; ++i) {
    const auto rolled = truth.drive(0.1, 0.1, kTick_ns);
    filter.roll(truth.now_ns, rolled.left_m, rolled.right_m);
  }
  const core::Pose before = filter.now().pose;
  PoseMeasurement m = truth.seen(0.002, 0.01);
  m.x_m = std::nan("");
  EXPECT_EQ(filter.correct(m), PoseFilter::Taken::Nonsense);
  m = truth.seen(0.002, 0.01);
  m.sd_m = 0.0;
  EXPECT_EQ(filter.correct(m), PoseFilter::Taken::Nonsense);
  m = truth.seen(0.002, 0.01);
  m.taken_ns = kTick_ns;
  EXPECT_EQ(filter.correct(m), PoseFilter::Taken::TooLate);
  m.taken_ns = truth.now_ns + 50 * kMs;
  EXPECT_EQ(filter.correct(m), PoseFilter::Taken::Waits);
  EXPECT_EQ(filter.now().pose.x_m, before.x_m);
  filter.roll(truth.now_ns, 1.0, 1.0);
  EXPECT_EQ(filter.now().pose.x_m, before.x_m) << "no time has passed";
}

}  // namespace
}  // namespace tandem::mixed_reality
