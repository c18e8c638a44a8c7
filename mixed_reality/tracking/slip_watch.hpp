// Notices wheels that roll without the robot's moving as they say.
#pragma once
#include <cstdint>

#include "hal/device/wheels.hpp"
#include "mixed_reality/tracking/pose_source.hpp"

namespace tandem::mixed_reality {

/// Compares what a robot's wheels rolled with where another source of its pose says that it is: it slips at a wall, is
/// carried, or one of the two is wrong. By the wheels alone nothing of that can be known.
class SlipWatch {
 public:
  enum class Found : std::uint8_t {
    Nothing,
    Slip,  ///< the wheels rolled farther than the robot came
    Moved  ///< the robot came farther than its wheels rolled: it was moved
  };
  static constexpr double kSpan_s = 1.0;    ///< over which both are compared
  static constexpr double kMost_m = 0.05;   ///< that they may differ …
  static constexpr double kMostPart = 0.3;  ///< … and this part of the way rolled

  /// `encoders` must outlive this; its stamps are on the run's clock.
  SlipWatch(const hal::WheelEncoders& encoders, double wheel_base_m)
      : encoders_(encoders), wheel_base_m_(wheel_base_m) {}

  /// Once a tick, after readings and pose were latched. @returns how both were found to differ, once a span.
  Found judge(const TrackedPose& tracked) noexcept;

 private:
  void begin(const TrackedPose& tracked) noexcept;

  const hal::WheelEncoders& encoders_;
  double wheel_base_m_;
  bool begun_ = false;
  hal::TimeNs begun_at_ns_ = 0, last_ns_ = 0;
  core::Pose from_, reckoned_;
  double way_m_ = 0.0;     // rolled since then
  double wheels_m_ = 0.0;  // by the one that rolled more, either way
  double left_m_ = 0.0, right_m_ = 0.0;
};

}  // namespace tandem::mixed_reality
