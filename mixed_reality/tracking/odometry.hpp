// Pose of a robot by its wheels' odometry.
#pragma once
#include <cstdint>

#include "hal/device/wheels.hpp"
#include "hal/robot_kind.hpp"
#include "mixed_reality/tracking/pose_source.hpp"

namespace tandem::mixed_reality {

/// `pose` after the left and right wheel have rolled `left_m` and `right_m` along one arc, exactly.
/// `wheel_base_m`: distance between the wheels' contact points. [Siegwart 2011, eq. 5.2 to 5.7, with the chord of the
/// arc instead of its first-order approximation]
core::Pose rolled(const core::Pose& pose, double left_m, double right_m, double wheel_base_m) noexcept;

/// Integrates wheel encoders from a known start. It knows nothing of slip, and its error grows with the way: good for
/// minutes, until a tracker corrects it.
///
/// The first reading is the reference. What the wheels rolled while the link was down counts when it is back, as
/// far as the robot can have rolled it in that time; encoders that have moved farther were reset or misread: such a
/// step is counted, and the robot stays where it was. So is a stamp that lies in the future.
class Odometry final : public PoseSource {
 public:
  /// `encoders` must outlive this; its stamps are on the run's clock.
  Odometry(const core::Pose& start, const hal::DifferentialDrive& drive, const hal::WheelEncoders& encoders);

  /// As old as the encoders' reading.
  std::string_view name() const noexcept override { return "odometry"; }
  TrackedPose latch(const Moment& now) noexcept override;

  std::uint64_t rejected() const noexcept override { return rejected_; }
  bool by_wheels() const noexcept override { return true; }

 private:
  bool believable(double left_m, double right_m, hal::TimeNs since_ns) const noexcept;

  const hal::WheelEncoders& encoders_;
  double wheel_base_m_;
  double max_speed_m_s_;
  TrackedPose tracked_;
  double left_m_ = 0.0, right_m_ = 0.0;  // of the reading that `tracked_` belongs to
  hal::TimeNs future_ns_ = -1;           // the last stamp that lay in the future
  std::uint64_t rejected_ = 0;
};

}  // namespace tandem::mixed_reality
