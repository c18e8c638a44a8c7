// Pose of a wheeled robot by its wheels, its gyroscope and trackers.
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "hal/device/body_sensors.hpp"
#include "hal/device/wheels.hpp"
#include "hal/robot_kind.hpp"
#include "mixed_reality/tracking/pose_filter.hpp"
#include "mixed_reality/tracking/pose_source.hpp"

namespace tandem::mixed_reality {

struct FusedPoseParams {
  PoseFilterParams filter = {};
  double lost_m = 0.1;  ///< standard deviation from which the pose is too vague to act on
};

/// Hands the wheels' ways and what trackers saw to a PoseFilter, and judges both.
///
/// Nothing is known of the robot's place until kFound sightings in a row agree, of whatever tracker: where the file
/// puts it is only its heading's first guess for trackers that see points. Encoders that have moved farther than the
/// robot can are not believed. While they are silent, for kBlind and longer, the pose is that of the trackers alone;
/// what the wheels rolled meanwhile is not counted.
///
/// The filter learns by how much the stamps of each tracker and those of the wheels are apart. Where a tracker stamps
/// by a clock that is right it is the robot whose stamps do not fit its body (mixed_reality/delay/delays.hpp): what the
/// encoders say is then of a body that much later, or earlier, than their stamps.
class FusedPose final : public PoseSource {
 public:
  static constexpr int kFound = 3;
  static constexpr hal::TimeNs kBlind_ns = 500 * hal::kNsPerMs;
  static constexpr hal::TimeNs kDisputed_ns = 2 * hal::kNsPerSecond;  ///< for so long after the last sign of it
  static constexpr double kDelayKnown_s = 0.01;  ///< standard deviation from which a link's delay is believed

  /// `encoders` and `gyroscope` (null: it has none) must outlive this; their stamps are on the run's clock.
  FusedPose(const core::Pose& start, const hal::DifferentialDrive& drive, const hal::WheelEncoders& encoders,
            const hal::Gyroscope* gyroscope, const FusedPoseParams& params);

  /// A tracker saw the robot; told before `latch`. `stamp`: the tracker's own, by which what comes twice is known.
  void see(const PoseMeasurement& pose, std::optional<std::int64_t> stamp) noexcept;
  /// Something came that cannot be a pose of this robot.
  void note_impossible() noexcept { ++impossible_; }

  std::string_view name() const noexcept override { return "fused"; }
  /// As of when the body was where the newest reading of the encoders says, and not later than now.
  TrackedPose latch(const Moment& now) noexcept override;
  std::uint64_t rejected() const noexcept override;
  std::uint64_t jumps() const noexcept override { return filter_.moved() + found_elsewhere_; }
  bool disputed() const noexcept override { return disputed_; }
  std::uint64_t slips() const noexcept override { return filter_.slipped(); }
  const PoseMeasurement* newest_sighting() const noexcept override { return newest_ ? &*newest_ : nullptr; }
  const SightingsRow* sightings() const noexcept override { return &sightings_; }
  void note_learnt(TrackRow& row) const noexcept override;
  void drives_by(const CommandedMotion& motion) noexcept override { motion_ = &motion; }
  double lag_s() const noexcept override { return learnt().lag_s.value_or(0.0); }

  PoseCounts counts() const noexcept;
  PoseFilter::Learnt learnt() const noexcept;
  Eigen::Matrix3d wheels_covariance() const noexcept { return filter_.wheels_covariance(); }
  /// The newest sighting of each tracker, as it came, whether it was used or not; nothing: none yet.
  const std::array<std::optional<PoseMeasurement>, PoseFilter::kTrackers>& seen() const noexcept { return seen_; }

 private:
  void read_wheels(const Moment& now) noexcept;
  void note_sightings(const Moment& now) noexcept;
  std::optional<std::size_t> honest_tracker() const noexcept;
  std::optional<double> turned_rad(hal::TimeNs span_ns, double& sd_rad) noexcept;
  void roll(hal::TimeNs until_ns, double left_m, double right_m, std::optional<double> turn_rad,
            double sd_rad) noexcept;
  bool agree(const PoseMeasurement& pose) noexcept;
  void take(const PoseMeasurement& pose, hal::TimeNs now_ns) noexcept;
  void judge(hal::TimeNs now_ns) noexcept;
  void put(const PoseMeasurement& pose) noexcept;

  const hal::WheelEncoders& encoders_;
  const hal::Gyroscope* gyroscope_;
  double wheel_base_m_;
  const CommandedMotion* motion_ = nullptr;              // null: its commands are unknown
  double left_m_s_ = 0.0, right_m_s_ = 0.0;              // before the last reading of the wheels
  double unsteady_rad_s_ = 0.0, unsteady_before_ = 0.0;  // by which the wheels' turn rate changed at the last two
  FusedPoseParams params_;
  double max_speed_m_s_;
  PoseFilter filter_;
  core::Pose start_;
  double start_heading_rad_;
  bool wheels_known_ = false, found_ = false;
  bool way_lost_ = false;  // what the wheels rolled since the last reading is not to be counted
  double left_m_ = 0.0, right_m_ = 0.0;
  std::optional<double> rate_rad_s_;  // at the last reading of the wheels
  hal::TimeNs wheels_at_ns_ = 0, future_ns_ = -1;
  std::optional<PoseMeasurement> candidate_;
  int agreed_ = 0;

  std::array<PoseMeasurement, 256> pending_;
  std::size_t pending_count_ = 0;
  SightingsRow sightings_;  // that were pending at the last latch
  struct Stamps {
    std::array<std::int64_t, 64> last{};
    std::size_t count = 0;
  };
  std::array<Stamps, PoseFilter::kTrackers> stamps_;
  std::array<std::optional<PoseMeasurement>, PoseFilter::kTrackers> seen_;
  std::optional<PoseMeasurement> newest_;

  std::array<bool, PoseFilter::kTrackers> by_true_clock_{};
  bool disputed_ = false;
  hal::TimeNs disputed_at_ns_ = 0;
  std::uint64_t disputes_ = 0;
  std::uint64_t found_elsewhere_ = 0, doubled_ = 0, impossible_ = 0, overrun_ = 0, wheels_rejected_ = 0;
};

}  // namespace tandem::mixed_reality
