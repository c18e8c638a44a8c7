#include "mixed_reality/tracking/fused_pose.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <random>

#include "hal/robot/footbot.hpp"
#include "mixed_reality/tracking/odometry.hpp"

namespace tandem::mixed_reality {
namespace {

constexpr hal::TimeNs kMs = hal::kNsPerMs;
constexpr hal::TimeNs kTick_ns = 100 * kMs;

/// A robot, its wheels' counters, a camera that sees it 60 ms late, in faked time.
class Fused : public testing::Test {
 protected:
  Fused() : source_(core::Pose::at(0.0, 0.0, 0.0), *hal::footbot::kind().drive(), encoders_, nullptr, {}) {}

  /// A tick of driving; `see` is asked for what the camera makes of every truth, 20 a second.
  void tick(double left_m_s, double right_m_s,
            const std::function<std::optional<PoseMeasurement>(const core::Pose& truth, hal::TimeNs at)>& see) {
    const int ago = static_cast<int>(wheels_late_ns_ / (kTick_ns / 10));  // tenths of a tick
    for (int i = 0; i < 10; ++i) {
      const double dt_s = 0.01;
      left_m_ += left_m_s * dt_s;
      right_m_ += right_m_s * dt_s;
      truth_ = rolled(truth_, left_m_s * dt_s * left_scale_, right_m_s * dt_s * right_scale_,
                      hal::footbot::kind().drive()->wheel_base_m);
      now_ns_ += kTick_ns / 10;
      if (i == 9 - ago) counted_ = {left_m_, right_m_};
      if (i % 5 != 4) continue;
      if (auto seen = see(truth_, now_ns_)) arriving_.push_back(*seen);
    }
    while (!arriving_.empty() && arriving_.front().taken_ns + 60 * kMs <= now_ns_) {
      source_.see(arriving_.front(), arriving_.front().taken_ns);
      arriving_.erase(arriving_.begin());
    }
    if (!wheels_silent_) {
      encoders_.left_m = counted_[0];
      encoders_.right_m = counted_[1];
      encoders_.taken_ns = now_ns_;
      encoders_.validity = hal::Validity::Fresh;
    }
    tracked_ = source_.latch({now_ns_, now_ns_});
  }
  std::optional<PoseMeasurement> seen(const core::Pose& truth, hal::TimeNs at, std::uint8_t tracker = 0) {
    std::normal_distribution<double> noise(0.0, 0.002);
    return PoseMeasurement{tracker,
                           at,
                           truth.x_m + noise(chance_),
                           truth.y_m + noise(chance_),
                           truth.heading_rad() + 5.0 * noise(chance_),
                           0.002,
                           0.01};
  }
  auto honestly() {
    return [this](const core::Pose& truth, hal::TimeNs at) { return seen(truth, at); };
  }
  auto blindly() {
    return [](const core::Pose&, hal::TimeNs) -> std::optional<PoseMeasurement> { return {}; };
  }
  double error_m() const { return std::hypot(tracked_.pose.x_m - truth_.x_m, tracked_.pose.y_m - truth_.y_m); }
  double error_rad() const {
    return std::fabs(std::remainder(tracked_.pose.heading_rad() - truth_.heading_rad(), 2.0 * std::numbers::pi));
  }

  hal::WheelEncoders encoders_;
  core::Pose truth_ = core::Pose::at(0.4, -0.3, 0.7);
  double left_m_ = 0.0, right_m_ = 0.0, left_scale_ = 1.0, right_scale_ = 1.0;
  bool wheels_silent_ = false;
  hal::TimeNs wheels_late_ns_ = 0;  // by which the counters are older than their stamp
  std::array<double, 2> counted_{};
  hal::TimeNs now_ns_ = hal::kNsPerSecond;
  std::vector<PoseMeasurement> arriving_;
  std::mt19937_64 chance_{11};
  FusedPose source_;
  TrackedPose tracked_;
};

TEST_F(Fused, KnowsNothingUntilATrackerHasFoundTheRobotThreeTimes) {
  for (int i = 0; i < 5; ++i) tick(0.0, 0.0, blindly());
  EXPECT_FALSE(tracked_.known);
  for (int i = 0; i < 4; ++i) tick(0.0, 0.0, honestly());
  ASSERT_TRUE(tracked_.known);
  EXPECT_FALSE(tracked_.vague);
  EXPECT_LT(error_m(), 0.01);
  ASSERT_TRUE(tracked_.sd_m.has_value());
  EXPECT_LT(*tracked_.sd_m, 0.015);
}

TEST_F(Fused, IsNotFoundBySightingsThatDisagree) {
  int n = 0;
  for (int i = 0; i < 20; ++i) {
    tick(0.0, 0.0, [&](core::Pose truth, hal::TimeNs at) {
      truth.x_m += ++n % 2 == 0 ? 0.5 : 0.0;
      return seen(truth, at);
    });
  }
  EXPECT_FALSE(tracked_.known);
}

TEST_F(Fused, StaysWithinMillimetresThoughItsWheelsAreNotAsTheKindSays) {
  left_scale_ = 1.015;
  right_scale_ = 0.985;
  double sum = 0.0, turns = 0.0;
  int count = 0;
  for (int i = 0; i < 600; ++i) {
    const double turn = 0.05 * std::sin(0.07 * i) + 0.02;
    const bool lost = i % 20 == 7;
    tick(0.2 - turn, 0.2 + turn,
         [&](const core::Pose& truth, hal::TimeNs at) { return lost ? std::nullopt : seen(truth, at); });
    if (i < 50) continue;
    sum += error_m() * error_m();
    turns += error_rad() * error_rad();
    ++count;
  }
  EXPECT_LT(std::sqrt(sum / count), 0.005);
  EXPECT_LT(std::sqrt(turns / count), std::numbers::pi / 180.0);
  EXPECT_NEAR(source_.learnt().left, left_scale_, 0.005);
  EXPECT_NEAR(source_.learnt().right, right_scale_, 0.005);
  for (int i = 0; i < 20; ++i) tick(0.2, 0.2, blindly());
  EXPECT_LT(error_m(), 0.02) << "after two seconds without tracker";
  EXPECT_EQ(source_.jumps(), 0U);
}

/// The robot's counters are 40 ms older than their stamps.
class FusedOverASlowLink : public Fused {
 protected:
  void drive(bool true_clock) {
    wheels_late_ns_ = 40 * kMs;
    for (int i = 0; i < 600; ++i) {
      turn_m_s_ = 0.05 * std::sin(0.07 * i) + 0.02;
      tick(0.2 - turn_m_s_, 0.2 + turn_m_s_, [&](const core::Pose& truth, hal::TimeNs at) {
        auto m = seen(truth, at);
        m->by_true_clock = true_clock;
        return m;
      });
    }
  }
  double turn_m_s_ = 0.0;
};

TEST_F(FusedOverASlowLink, LearnsHowLateItIsByATrackerWhoseClockIsRight) {
  drive(true);
  EXPECT_LT(source_.learnt().sd[4], FusedPose::kDelayKnown_s);
  ASSERT_TRUE(source_.learnt().lag_s);
  EXPECT_NEAR(*source_.learnt().lag_s, -0.04, 0.005);
  EXPECT_EQ(source_.learnt().delay_s[0], 0.0) << "the tracker is right";
  EXPECT_NEAR(static_cast<double>(now_ns_ - tracked_.taken_ns), 40e6, 5e6);
  EXPECT_GT(error_m(), 0.005);
  // As its twin does: carried on for as long as the pose is old.
  const double for_s = hal::to_seconds(now_ns_ - tracked_.taken_ns);
  tracked_.pose = rolled(tracked_.pose, (0.2 - turn_m_s_) * for_s, (0.2 + turn_m_s_) * for_s,
                         hal::footbot::kind().drive()->wheel_base_m);
  EXPECT_LT(error_m(), 0.003);
}

TEST_F(FusedOverASlowLink, DoesNotSayWhichIsLateWhereTheTrackersClockIsItsOwn) {
  drive(false);
  EXPECT_FALSE(source_.learnt().lag_s);
  EXPECT_NEAR(source_.learnt().delay_s[0], -0.04, 0.005);
  EXPECT_EQ(tracked_.taken_ns, now_ns_);
}

TEST_F(Fused, CountsWhatComesTwiceAndWhatIsNoPose) {
  for (int i = 0; i < 10; ++i) tick(0.1, 0.1, honestly());
  PoseMeasurement twice = *seen(truth_, now_ns_ - 20 * kMs);
  source_.see(twice, 77);
  source_.see(twice, 77);
  PoseMeasurement none = twice;
  none.x_m = std::nan("");
  source_.see(none, 78);
  tick(0.1, 0.1, honestly());
  EXPECT_EQ(source_.counts().doubled, 1U);
  EXPECT_EQ(source_.counts().impossible, 1U);
  EXPECT_LT(error_m(), 0.01);
}

TEST_F(Fused, IsVagueWhenNoTrackerHasSeenTheRobotForLong) {
  for (int i = 0; i < 10; ++i) tick(0.2, 0.2, honestly());
  int ticks = 0;
  while (!tracked_.vague && ticks < 3000) {
    tick(0.2, 0.22, blindly());
    ++ticks;
  }
  EXPECT_GT(ticks, 50) << "not at once";
  EXPECT_LT(ticks, 3000) << "but in the end";
  for (int i = 0; i < 10; ++i) tick(0.0, 0.0, honestly());
  EXPECT_FALSE(tracked_.vague);
}

TEST_F(Fused, ARobotThatIsCarriedHasJumpedOnceAndIsFound) {
  for (int i = 0; i < 30; ++i) tick(0.1, 0.1, honestly());
  truth_.x_m += 0.6;
  for (int i = 0; i < 10; ++i) tick(0.1, 0.1, honestly());
  EXPECT_EQ(source_.jumps(), 1U);
  EXPECT_EQ(source_.slips(), 0U);
  EXPECT_LT(error_m(), 0.02);
}

TEST_F(Fused, TwoTrackersThatDisagreeAreToldAsLongAsTheyDo) {
  for (int i = 0; i < 20; ++i) tick(0.1, 0.1, honestly());
  EXPECT_FALSE(source_.disputed());
  bool other = false;
  const auto both = [&](core::Pose truth, hal::TimeNs at) {
    other = !other;
    if (other) truth.y_m += 0.4;
    return seen(truth, at, other ? 1 : 0);
  };
  for (int i = 0; i < 20; ++i) tick(0.1, 0.1, both);
  EXPECT_TRUE(source_.disputed());
  EXPECT_GT(source_.counts().disputed, 0U);
  EXPECT_EQ(source_.jumps(), 0U);
  EXPECT_LT(error_m(), 0.02);
  for (int i = 0; i < 30; ++i) tick(0.1, 0.1, honestly());
  EXPECT_FALSE(source_.disputed());
}

TEST_F(Fused, ACameraThatShowsTheSameFrameAgainAndAgainIsNoSlip) {
  for (int i = 0; i < 30; ++i) tick(0.1, 0.1, honestly());
  const PoseMeasurement frozen = *seen(truth_, now_ns_);
  for (int i = 0; i < 20; ++i) {
    tick(0.1, 0.1, [&](const core::Pose&, hal::TimeNs at) {
      PoseMeasurement again = frozen;
      again.taken_ns = at;
      return std::optional(again);
    });
  }
  EXPECT_GE(source_.jumps(), 1U) << "a person is to look";
  EXPECT_EQ(source_.slips(), 0U);
  EXPECT_GE(source_.counts().gated, 5U);
}

TEST_F(Fused, AMirroredTrackerContradictsTheWheels) {
  for (int i = 0; i < 10; ++i) tick(0.0, 0.0, honestly());
  // Left is right for it; where it stands, nothing shows that.
  truth_ = core::Pose::at(0.4, 0.0, 0.0);
  for (int i = 0; i < 20; ++i) tick(0.0, 0.0, honestly());
  const std::uint64_t before = source_.jumps() + source_.slips();
  for (int i = 0; i < 100; ++i) {
    tick(0.1, 0.2, [&](const core::Pose& truth, hal::TimeNs at) {
      return seen(core::Pose::at(truth.x_m, -truth.y_m, -truth.heading_rad()), at);
    });
  }
  EXPECT_GT(source_.jumps() + source_.slips(), before);
}

TEST_F(Fused, WheelsThatSlipAgainAndAgainAreNoJump) {
  for (int i = 0; i < 30; ++i) tick(0.1, 0.1, honestly());
  for (int times = 0; times < 4; ++times) {
    left_scale_ = right_scale_ = 0.0;  // it pushes against a wall
    for (int i = 0; i < 20; ++i) tick(0.1, 0.1, honestly());
    left_scale_ = right_scale_ = 1.0;
    for (int i = 0; i < 20; ++i) tick(0.0, 0.0, honestly());
    for (int i = 0; i < 20; ++i) tick(-0.1, -0.1, honestly());
  }
  EXPECT_GE(source_.slips(), 3U);
  EXPECT_EQ(source_.jumps(), 0U) << "nobody moved it";
  EXPECT_LT(error_m(), 0.02);
}

TEST_F(Fused, ARobotInWhosePlaceAnotherOneIsSeenHasJumpedAtOnce) {
  for (int i = 0; i < 30; ++i) tick(0.1, 0.1, honestly());
  for (int i = 0; i < 10; ++i) {
    tick(0.1, 0.1, [&](const core::Pose& truth, hal::TimeNs at) {
      return seen(core::Pose::at(truth.x_m - 0.3, truth.y_m + 0.2, 2.0), at);
    });
  }
  EXPECT_EQ(source_.jumps(), 1U);
}

TEST_F(Fused, FollowsTheTrackerWhileTheWheelsAreSilentAndDoesNotCountWhatTheyRolledMeanwhile) {
  for (int i = 0; i < 20; ++i) tick(0.1, 0.1, honestly());
  wheels_silent_ = true;
  for (int i = 0; i < 20; ++i) tick(0.05, 0.05, honestly());
  EXPECT_LT(error_m(), 0.02);
  wheels_silent_ = false;
  for (int i = 0; i < 5; ++i) tick(0.1, 0.1, honestly());
  EXPECT_LT(error_m(), 0.02);
  EXPECT_EQ(source_.jumps(), 0U);
}

TEST_F(Fused, EncodersThatWereResetMoveNothing) {
  for (int i = 0; i < 20; ++i) tick(0.1, 0.1, honestly());
  left_m_ = right_m_ = -1000.0;
  for (int i = 0; i < 3; ++i) tick(0.0, 0.0, honestly());
  EXPECT_LT(error_m(), 0.01);
  EXPECT_GE(source_.rejected(), 1U);
}

}  // namespace
}  // namespace tandem::mixed_reality
