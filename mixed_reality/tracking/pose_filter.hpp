// Pose of a wheeled robot from its wheels, a gyroscope and trackers, with its uncertainty.
//
//   wheels, gyroscope  --roll-->  events by time:  roll  roll  pose  roll  roll  pose  roll
//   trackers           --correct (late ones at their own time, what came after is repeated)
//   at(now)            <--  the newest state, carried on
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/space/pose.hpp"
#include "hal/params.hpp"
#include "hal/time.hpp"
#include "mixed_reality/tracking/learnt_motion.hpp"
#include "mixed_reality/tracking/pose_measurement.hpp"

namespace tandem::mixed_reality {

/// What is assumed of a robot and its trackers before anything is known. Standard deviations.
struct PoseFilterParams {
  double wheel_noise_m = 0.004;      ///< of what one wheel rolls, after one metre; grows with the root of the way
  double gyroscope_rad_s = 0.005;    ///< white noise of the gyroscope's rate, in one second
  double bias_rad_s = 0.02;          ///< of its bias
  double bias_drift_rad_s = 0.0002;  ///< by which the bias wanders in a second
  double scale = 0.02;               ///< of each wheel's radius, as a part
  double base = 0.03;                ///< of the wheel base, as a part
  double delay_s = 0.03;             ///< of what each tracker's stamps are late by, beside what they say
  void describe(hal::ParamVisitor& v) {
    v.number("wheel_noise", wheel_noise_m, hal::unit::m, {1e-6, 1.0}, "Of what a wheel rolls in one metre.");
    v.number("gyroscope_noise", gyroscope_rad_s, hal::unit::rad_s, {1e-6, 10.0}, "Of the turn in one second.");
    v.number("bias", bias_rad_s, hal::unit::rad_s, {0.0, 10.0}, "Of the gyroscope's rate at rest.");
    v.number("bias_drift", bias_drift_rad_s, hal::unit::rad_s, {0.0, 1.0}, "By which that wanders in a second.");
    v.number("wheel_scale", scale, hal::unit::none, {0.0, 0.5}, "Of each wheel's radius, as a part.");
    v.number("base_scale", base, hal::unit::none, {0.0, 0.5}, "Of the distance of the wheels, as a part.");
    v.number("delay", delay_s, hal::unit::s, {0.0, 1.0}, "By which a tracker's stamps may be late.");
  }
};

/// By what way and turn until somewhere within a stretch of rolling may differ from those of even rolling.
struct UnevenWay {
  double way_m = 0.0, turn_rad = 0.0;
};

/// A pose and how well it is known.
struct PoseEstimate {
  core::Pose pose;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of x, y (m, in W) and heading (rad)
};

/// Error-state Kalman filter [Sola 2017, ch. 5, for the plane] over pose, scales of both wheels and of their distance,
/// bias of the gyroscope, and delay of each tracker. Keeps the last kKept events: a pose that comes late is taken in at
/// its own time, between the steps of the wheels, and what came after is repeated. What is learnt stays within five
/// times what was assumed. Nothing here allocates.
class PoseFilter {
 public:
  static constexpr std::size_t kKept = 256;
  static constexpr std::size_t kTrackers = LearntMotion::kTrackers;
  static constexpr int kInsists = 5;
  static constexpr double kInsists_s = 0.2;  ///< over which gated poses must agree at least
  static constexpr double kOthers_s = 1.0;   ///< for so long after one tracker was believed another is not in its stead

  enum class Taken : std::uint8_t {
    Used,
    Waits,     ///< is newer than the wheels; used when they have come there
    TooLate,   ///< older than all that is kept
    Gated,     ///< farther from what was expected than noise explains (one of 1,000 true ones is)
    Moved,     ///< kInsists gated ones of a tracker in a row agree: the filter goes on from there. It was carried, or
               ///< is another robot: its wheels cannot have brought it there
    Slipped,   ///< the same, and they can: they rolled farther than it came
    Disputed,  ///< they agree, and another tracker says that it was not
    Nonsense,  ///< no numbers
  };

  /// `start` is known by `sd_m` and `sd_rad`; `wheel_base_m` as in the robot's kind.
  PoseFilter(const core::Pose& start, hal::TimeNs start_ns, double sd_m, double sd_rad, double wheel_base_m,
             const PoseFilterParams& params);

  /// What the wheels rolled and the gyroscope turned since the last call, until `taken_ns`, which only grows.
  /// `gyroscope_sd_rad`: of that turn, beside the gyroscope's own noise, such as of a rate that was sampled seldom.
  /// `uneven`: by what it may have rolled otherwise than evenly meanwhile.
  void roll(hal::TimeNs taken_ns, double left_m, double right_m, std::optional<double> gyroscope_rad = {},
            double gyroscope_sd_rad = 0.0, const UnevenWay& uneven = {}) noexcept;
  Taken correct(const PoseMeasurement& pose) noexcept;
  /// The robot was put somewhere: starts again there, keeps what was learnt of its wheels.
  void put(const core::Pose& pose, hal::TimeNs at_ns, double sd_m, double sd_rad) noexcept;

  /// As of the last `roll`.
  PoseEstimate now() const noexcept;
  /// Carried on by the speed of the last step; before that, as it was then.
  PoseEstimate at(hal::TimeNs time_ns) const noexcept;
  /// What this tracker would stamp so, if it had no noise: what it is late by, and how well that is known, is in it.
  PoseEstimate seen_by(std::size_t tracker, hal::TimeNs time_ns) const noexcept;
  /// Of the factors of the left wheel, the right one, and their distance.
  Eigen::Matrix3d wheels_covariance() const noexcept { return event(count_ - 1).after.p.block<3, 3>(3, 3); }

  using Learnt = LearntMotion;
  Learnt learnt() const noexcept;

  std::uint64_t used() const noexcept { return used_; }
  std::uint64_t gated() const noexcept { return gated_; }
  std::uint64_t too_late() const noexcept { return too_late_; }
  std::uint64_t moved() const noexcept { return moved_; }
  std::uint64_t slipped() const noexcept { return slipped_; }
  std::uint64_t disputed() const noexcept { return disputed_; }
  hal::TimeNs time_ns() const noexcept { return event(count_ - 1).time_ns; }  ///< of the last `roll` or `put`
  /// Normalised innovation squared of the last measurement, and its degrees of freedom: for tests of consistency.
  double innovation() const noexcept { return innovation_; }

 private:
  static constexpr int kDelay = 7;
  static constexpr int kErrors = kDelay + static_cast<int>(kTrackers);  // x y heading | left right base | bias | delays
  using Covariance = Eigen::Matrix<double, kErrors, kErrors>;
  using Errors = Eigen::Matrix<double, kErrors, 1>;
  struct State {
    core::Pose pose;
    double left = 1.0, right = 1.0, base = 1.0, bias_rad_s = 0.0;
    std::array<double, kTrackers> delay_s{};
    Covariance p = Covariance::Zero();
    void add(const Errors& e, const PoseFilterParams& assumed) noexcept;
  };
  /// A stretch of rolling, and perhaps a pose at its end.
  struct Event {
    hal::TimeNs time_ns = 0;
    double left_m = 0.0, right_m = 0.0;
    std::optional<double> gyroscope_rad;
    double gyroscope_var = 0.0;  // beside its own noise
    UnevenWay uneven;
    std::optional<PoseMeasurement> measured;
    double delay_s = 0.0;  // by which it was put before its stamp
    State after;
  };

  Event& event(std::size_t i) noexcept { return events_[(first_ + i) % kKept]; }
  const Event& event(std::size_t i) const noexcept { return events_[(first_ + i) % kKept]; }
  State state_at(hal::TimeNs time_ns, double& left_m_s, double& right_m_s) const noexcept;
  void append(const Event& e) noexcept;
  bool insert(std::size_t at, const Event& e) noexcept;
  void repeat(std::size_t from) noexcept;
  void step(State& s, const Event& e, double dt_s) const noexcept;
  bool update(State& s, const PoseMeasurement& m, double delay_s, double left_m_s, double right_m_s,
              bool gate) noexcept;
  hal::TimeNs time_of(const PoseMeasurement& m) const noexcept;
  Taken gate_out(const PoseMeasurement& m) noexcept;
  bool within_reach(const PoseMeasurement& m) const noexcept;
  void carry_to(const PoseMeasurement& m) noexcept;
  Taken take(const PoseMeasurement& m) noexcept;
  void take_waiting() noexcept;

  double wheel_base_m_;
  PoseFilterParams params_;
  std::array<Event, kKept> events_;
  std::size_t first_ = 0, count_ = 0;
  std::array<PoseMeasurement, 16> waiting_;
  std::size_t waiting_count_ = 0;
  /// What one tracker says against what is believed.
  struct Odd {
    PoseMeasurement last;  // that was gated
    core::Pose at;         // where the filter was then
    hal::TimeNs since_ns = 0;
    int count = 0;
    bool alike = true;  // they are the same to the last bit
  };
  /// The newest of one tracker that was believed, and how far the wheels had rolled then.
  struct Believed {
    PoseMeasurement pose;
    double left_m = 0.0, right_m = 0.0;
  };
  std::array<Odd, kTrackers> odd_;
  std::array<Believed, kTrackers> believed_;
  double rolled_left_m_ = 0.0, rolled_right_m_ = 0.0;  // in all, either way
  std::array<hal::TimeNs, kTrackers> used_at_ns_{};    // the newest that was used of each
  std::array<bool, kTrackers> any_used_{};
  double innovation_ = 0.0;
  std::uint64_t used_ = 0, gated_ = 0, too_late_ = 0, moved_ = 0, slipped_ = 0, disputed_ = 0;
};

}  // namespace tandem::mixed_reality
