// Robots that obey late, and whose body lags their encoders, before a tracker whose stamps are right: where the filter
// and the commands put them, against an integrator of the test's own, and how well that is known.
#include <Eigen/LU>
#include <cmath>
#include <deque>
#include <gtest/gtest.h>
#include <numbers>
#include <random>
#include <vector>

#include "hal/robot/footbot.hpp"
#include "mixed_reality/tracking/commanded_motion.hpp"
#include "mixed_reality/tracking/fused_pose.hpp"

namespace tandem::mixed_reality {
namespace {

constexpr hal::TimeNs kMs = hal::kNsPerMs;

/// By how much wheels slip by chance, and how much the filter counts with: m after 1 m.
struct Slip {
  double is_m = PoseFilterParams{}.wheel_noise_m, assumed_m = PoseFilterParams{}.wheel_noise_m;
};

/// A foot-bot in steps of a millisecond.
class Delayed {
 public:
  Delayed(double lag_s, double actuation_s, unsigned seed, bool gyroscope = false, const Slip& slip = {})
      : slip_m_(slip.is_m),
        lag_ms_(std::lround(1e3 * lag_s)),
        actuation_ms_(std::lround(1e3 * actuation_s)),
        dice_(seed),
        base_m_(hal::footbot::kind().drive()->wheel_base_m),
        source_(core::Pose::at(0.0, 0.0, 0.0), *hal::footbot::kind().drive(), encoders_,
                gyroscope ? &gyroscope_ : nullptr, {.filter = {.wheel_noise_m = slip.assumed_m}}),
        motion_(base_m_) {
    const PoseFilterParams assumed;
    left_ = 1.0 + assumed.scale * normal();
    right_ = 1.0 + assumed.scale * normal();
    base_ = 1.0 + assumed.base * normal();
    truth_.push_back({});
    source_.drives_by(motion_);
  }

  /// A tick: commands change now and then; @returns the heading's error in degrees, as a twin would show it.
  double tick() {
    if (even() < 0.15) {
      const double way = 0.1 + 0.1 * even(), turn = 0.12 * (2.0 * even() - 1.0);
      told_ = {way - turn, way + turn};
    }
    // Given a little after the tick began, and obeyed later.
    commands_.push_back({ms_ + 2, told_[0], told_[1]});
    hal::WheelSpeeds wheels;
    wheels.set(told_[0], told_[1]);
    motion_.told(ns(ms_ + 2), wheels);
    for (int i = 0; i < 100; ++i) step();
    encoders_.left_m = counted_[0];
    encoders_.right_m = counted_[1];
    encoders_.taken_ns = ns(ms_);
    encoders_.validity = hal::Validity::Fresh;
    gyroscope_.taken_ns = encoders_.taken_ns;
    gyroscope_.validity = hal::Validity::Fresh;
    gyroscope_.rate_rad_s[2] = static_cast<float>(rate_rad_s_ + 0.01 + 0.002 * normal());
    while (!arriving_.empty() && arriving_.front().taken_ns + 60 * kMs <= ns(ms_)) {
      source_.see(arriving_.front(), arriving_.front().taken_ns);
      arriving_.pop_front();
    }
    const Moment now{ns(ms_), ns(ms_)};
    tracked_ = source_.latch(now);
    motion_.counted(encoders_.taken_ns, encoders_.left_m, encoders_.right_m);
    const core::Pose shown =
        motion_.carried_on(tracked_.pose, tracked_.taken_ns, now.monotonic_ns, motion_.to_way_s(source_.lag_s()));
    return std::fabs(apart(shown.heading_rad(), truth_.back().heading)) * 180.0 / std::numbers::pi;
  }

  /// Of the pose at its own stamp; of three numbers 3 where the filter is as wrong as it says.
  double pose_nees() const {
    const auto at = static_cast<std::size_t>(tracked_.taken_ns / kMs - kFirst_ms);
    const double part = 1e-6 * static_cast<double>(tracked_.taken_ns % kMs);
    const Place &a = truth_[at], &b = truth_[std::min(at + 1, truth_.size() - 1)];
    const Eigen::Vector3d e(tracked_.pose.x_m - (a.x + part * (b.x - a.x)),
                            tracked_.pose.y_m - (a.y + part * (b.y - a.y)),
                            apart(tracked_.pose.heading_rad(), a.heading + part * apart(b.heading, a.heading)));
    const std::array<double, 6>& c = tracked_.covariance;
    Eigen::Matrix3d covariance;
    covariance << c[0], c[1], c[3], c[1], c[2], c[4], c[3], c[4], c[5];
    return e.dot(covariance.inverse() * e);
  }
  double wheels_nees() const {
    const PoseFilter::Learnt found = source_.learnt();
    const Eigen::Vector3d e(found.left - left_, found.right - right_, found.base - base_);
    return e.dot(source_.wheels_covariance().inverse() * e);
  }
  const FusedPose& source() const { return source_; }
  const CommandedMotion& motion() const { return motion_; }

 private:
  static constexpr std::int64_t kFirst_ms = 1000;
  struct Place {
    double x = 0.3, y = -0.2, heading = 0.7;
  };
  struct Command {
    std::int64_t at_ms;
    double left, right;
  };
  static hal::TimeNs ns(std::int64_t ms) { return ms * kMs; }
  static double apart(double a, double b) { return std::remainder(a - b, 2.0 * std::numbers::pi); }
  double normal() { return gauss_(dice_); }
  double even() { return std::uniform_real_distribution<double>()(dice_); }

  Command at(std::int64_t ms) const {
    for (auto c = commands_.rbegin(); c != commands_.rend(); ++c) {
      if (c->at_ms <= ms) return *c;
    }
    return {0, 0.0, 0.0};
  }

  void step() {
    const Command motor = at(ms_ - actuation_ms_), floor = at(ms_ - actuation_ms_ - lag_ms_);
    counted_[0] += 1e-3 * motor.left;
    counted_[1] += 1e-3 * motor.right;
    const auto rolled = [&](double way) { return way + slip_m_ * std::sqrt(std::fabs(way)) * normal(); };
    const double l = rolled(1e-3 * left_ * floor.left), r = rolled(1e-3 * right_ * floor.right);
    Place next = truth_.back();
    const double turn = (r - l) / (base_m_ * base_);
    next.x += 0.5 * (l + r) * std::cos(next.heading + 0.5 * turn);
    next.y += 0.5 * (l + r) * std::sin(next.heading + 0.5 * turn);
    next.heading += turn;
    rate_rad_s_ = (right_ * floor.right - left_ * floor.left) / (base_m_ * base_);
    truth_.push_back(next);
    ++ms_;
    if (ms_ % 33 != 0) return;
    PoseMeasurement seen{
        0, ns(ms_), next.x + 0.002 * normal(), next.y + 0.002 * normal(), next.heading + 0.01 * normal(), 0.002, 0.01};
    seen.by_true_clock = true;
    arriving_.push_back(seen);
  }

  double slip_m_;
  std::int64_t lag_ms_, actuation_ms_;
  std::mt19937_64 dice_;
  std::normal_distribution<double> gauss_;
  double base_m_, left_ = 1.0, right_ = 1.0, base_ = 1.0, rate_rad_s_ = 0.0;
  std::int64_t ms_ = kFirst_ms;
  std::vector<Command> commands_;
  std::array<double, 2> told_{}, counted_{};
  std::vector<Place> truth_;
  std::deque<PoseMeasurement> arriving_;
  hal::WheelEncoders encoders_;
  hal::Gyroscope gyroscope_;
  FusedPose source_;
  CommandedMotion motion_;
  TrackedPose tracked_;
};

struct Setting {
  double lag_s, actuation_s;
};
std::vector<Setting> eight_settings() {
  std::vector<Setting> all;
  for (const double lag_s : {0.0, 0.06}) {
    for (const double actuation_s : {0.0, 0.03, 0.06, 0.11}) all.push_back({lag_s, actuation_s});
  }
  return all;
}

TEST(DelayedRobot, ItsHeadingIsWithinADegreeHoweverLateItObeys) {
  for (const Setting& s : eight_settings()) {
    Delayed robot(s.lag_s, s.actuation_s, 7);
    double squares = 0.0;
    int count = 0;
    for (int i = 0; i < 600; ++i) {
      const double error = robot.tick();
      if (i < 150) continue;
      squares += error * error;
      ++count;
    }
    EXPECT_LT(std::sqrt(squares / count), 1.0) << s.lag_s << " " << s.actuation_s;
    ASSERT_TRUE(robot.source().learnt().lag_s);
    EXPECT_NEAR(*robot.source().learnt().lag_s, s.lag_s, 0.005) << s.actuation_s;
    EXPECT_EQ(robot.source().learnt().delay_s[0], 0.0) << "the tracker is declared right";
    ASSERT_TRUE(robot.motion().to_counters().told);
    EXPECT_NEAR(robot.motion().to_counters().value_s, s.actuation_s, 0.004) << s.lag_s;
  }
}

/// Means over robots of all delays; three numbers each, 1 where the filter is as wrong as it says.
struct Known {
  double poses = 0.0, wheels = 0.0;
};
Known known_by(unsigned runs, bool gyroscope, const Slip& slip) {
  Known sum;
  int pose_count = 0, wheel_count = 0;
  unsigned seed = 100;
  for (const Setting& s : eight_settings()) {
    for (unsigned run = 0; run < runs; ++run) {
      Delayed robot(s.lag_s, s.actuation_s, seed++, gyroscope, slip);
      for (int i = 0; i < 400; ++i) {
        (void)robot.tick();
        if (i < 100) continue;
        sum.poses += robot.pose_nees() / 3.0;
        ++pose_count;
      }
      sum.wheels += robot.wheels_nees() / 3.0;
      ++wheel_count;
    }
  }
  return {sum.poses / pose_count, sum.wheels / wheel_count};
}

TEST(DelayedRobot, PosesAndWheelsAreAsWellKnownAsTheFilterSays) {
  for (const bool gyroscope : {false, true}) {
    const Known known = known_by(12, gyroscope, {});
    EXPECT_NEAR(known.poses, 1.0, 0.2) << "gyroscope " << gyroscope;
    EXPECT_NEAR(known.wheels, 1.0, 0.2) << "gyroscope " << gyroscope;
  }
}

// Nothing but what it counts with makes it careful about wheels that slip less than that.
TEST(DelayedRobot, PosesAndWheelsThatHardlySlipAreAsWellKnownWhereTheFilterCountsWithThat) {
  for (const double slip_m : {0.0005, 0.001, 0.002}) {
    const Known known = known_by(6, false, {slip_m, slip_m});
    EXPECT_NEAR(known.poses, 1.0, 0.2) << slip_m;
    EXPECT_NEAR(known.wheels, 1.0, 0.3) << slip_m;
  }
}

// How much better follows for one number from its gain (PoseFilter.IsAsCarefulAboutWheelsThatDoNotSlip…).
TEST(DelayedRobot, PosesAreBetterKnownThanTheFilterSaysWhereWheelsDoNotSlip) {
  const Known known = known_by(6, false, {.is_m = 0.0});
  EXPECT_LT(known.poses, 0.8);
  EXPECT_GT(known.poses, 0.3);
}

}  // namespace
}  // namespace tandem::mixed_reality
