#include "mixed_reality/tracking/delay_watch.hpp"

#include <cmath>
#include <deque>
#include <gtest/gtest.h>
#include <random>

namespace tandem::mixed_reality {
namespace {

constexpr hal::TimeNs kMs = hal::kNsPerMs;
constexpr double kBase_m = 0.1, kTop_m_s = 0.3, kBrakes_m_s2 = 3.0, kCounted_s = 0.05;

/// A body of this test's own: its wheels obey after `delay_s`, as fast as its brakes allow; commands leave ten times a
/// second, encoders are read as often.
class Robot {
 public:
  Robot(double delay_s, std::uint64_t seed, bool counters_too = true)
      : chance_(seed), delay_s_(delay_s), counters_too_(counters_too) {}

  /// @returns the delay that was found, 0: none, within `ticks` of random driving.
  double drive(int ticks, bool seen) {
    std::uniform_real_distribution<double> speed(-0.15, 0.25);
    hal::WheelSpeeds wheels;
    for (int i = 0; i < ticks; ++i) {
      if (i % 13 == 5) wheels.set(speed(chance_), speed(chance_));
      if (tick(wheels, seen)) return watch_.delay_s();
    }
    return watch_.delay_s();
  }
  bool tick(const hal::WheelSpeeds& wheels, bool seen) {
    watch_.told(now_ns_, wheels);
    told_.push_back({now_ns_, wheels});
    for (int ms = 0; ms < 100; ++ms) {
      now_ns_ += kMs;
      step();
      if (seen && ms % 33 == 0) pictures_.push_back(picture());
    }
    watch_.rolled(now_ns_, counters_too_ ? left_ : told_left_, counters_too_ ? right_ : told_right_);
    while (!pictures_.empty() && pictures_.front().taken_ns + 60 * kMs <= now_ns_) {
      watch_.seen(pictures_.front());
      pictures_.pop_front();
    }
    return watch_.judge(now_ns_, kCounted_s);
  }
  bool held = false;

 private:
  struct Told {
    hal::TimeNs at_ns;
    hal::WheelSpeeds wheels;
  };
  void step() {
    while (told_.size() > 1 && told_[1].at_ns + static_cast<hal::TimeNs>(delay_s_ * 1e9) <= now_ns_) told_.pop_front();
    const bool obeys = told_[0].at_ns + static_cast<hal::TimeNs>(delay_s_ * 1e9) <= now_ns_;
    const hal::WheelSpeeds wanted = obeys ? told_[0].wheels : hal::WheelSpeeds{};
    const double most = kBrakes_m_s2 * 1e-3;
    left_v_ += std::clamp(wanted.left_m_s - left_v_, -most, most);
    right_v_ += std::clamp(wanted.right_m_s - right_v_, -most, most);
    left_ += left_v_ * 1e-3;
    right_ += right_v_ * 1e-3;
    told_left_ += told_.back().wheels.left_m_s * 1e-3;
    told_right_ += told_.back().wheels.right_m_s * 1e-3;
    if (held) return;
    x_ += 0.5e-3 * (left_v_ + right_v_) * std::cos(heading_);
    y_ += 0.5e-3 * (left_v_ + right_v_) * std::sin(heading_);
    heading_ += 1e-3 * (right_v_ - left_v_) / kBase_m;
  }
  PoseMeasurement picture() {
    std::normal_distribution<double> noise(0.0, 0.002);
    PoseMeasurement seen;
    seen.taken_ns = now_ns_;
    seen.x_m = x_ + noise(chance_);
    seen.y_m = y_ + noise(chance_);
    seen.heading_rad = heading_ + 3.0 * noise(chance_);
    return seen;
  }

  std::mt19937_64 chance_;
  double delay_s_;
  bool counters_too_;  // false: the counters follow the commands, and the body comes later
  DelayWatch watch_{kBase_m, 2.0 * kTop_m_s / kBrakes_m_s2};
  hal::TimeNs now_ns_ = hal::kNsPerSecond;
  std::deque<Told> told_;
  std::deque<PoseMeasurement> pictures_;
  double left_v_ = 0.0, right_v_ = 0.0, left_ = 0.0, right_ = 0.0, told_left_ = 0.0, told_right_ = 0.0;
  double x_ = 0.0, y_ = 0.0, heading_ = 0.0;
};

TEST(DelayWatch, FindsHiddenDelaysByTheWheelsWithinTenSeconds) {
  for (const double delay_s : {0.15, 0.22, 0.3, 0.5}) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const double found_s = Robot(delay_s, seed).drive(100, false);
      EXPECT_GE(found_s, delay_s - 0.005) << "seed " << seed;
      EXPECT_LE(found_s, delay_s + 0.08) << "seed " << seed;
    }
  }
}

TEST(DelayWatch, FindsABodyThatLagsItsOwnCountersByATracker) {
  for (const double delay_s : {0.22, 0.3, 0.5}) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const double found_s = Robot(delay_s, seed, false).drive(60, true);
      EXPECT_GE(found_s, delay_s - 0.02) << "seed " << seed;
      EXPECT_LE(found_s, delay_s + 0.08) << "seed " << seed;
    }
  }
}

TEST(DelayWatch, TellsNothingOfRobotsThatObeyAsIsCountedOn) {
  for (const double delay_s : {0.0, 0.03, 0.05}) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed)
      EXPECT_EQ(Robot(delay_s, seed).drive(300, seed % 2 == 0), 0.0) << delay_s << " s, seed " << seed;
  }
}

TEST(DelayWatch, TellsNothingOfARobotThatIsHeldFast) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Robot robot(0.02, seed);
    robot.held = true;
    EXPECT_EQ(robot.drive(300, true), 0.0) << "seed " << seed;
  }
}

}  // namespace
}  // namespace tandem::mixed_reality
