// Interface of a tracker: the pose of a real robot.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "core/space/pose.hpp"
#include "hal/time.hpp"
#include "mixed_reality/time/moment.hpp"
#include "mixed_reality/tracking/pose_measurement.hpp"
#include "mixed_reality/tracking/track_rows.hpp"

namespace tandem::mixed_reality {

class CommandedMotion;

/// A pose of a real robot in W, and when it had it. How old a pose may be to act on is for its user to say.
struct TrackedPose {
  core::Pose pose;
  hal::TimeNs taken_ns = 0;  ///< CLOCK_MONOTONIC
  bool known = false;        ///< false: there never was one; `pose` is where the robot was said to start
  std::optional<double> sd_m = {}, sd_rad = {};  ///< of each coordinate, of the heading; nothing: not known
  std::array<double, 6> covariance = {};  ///< xx, xy, yy, x heading, y heading, heading heading, where sd_m is known
  bool vague = false;                     ///< known no better than nothing to act on
  std::optional<std::array<double, 4>> q_WB = {};  ///< attitude: w, x, y, z; nothing: level, as far as is known
};

/// Why measurements of a pose were not used, and how many were.
struct PoseCounts {
  std::uint64_t used = 0;
  std::uint64_t gated = 0;       ///< farther from what was expected than noise explains
  std::uint64_t late = 0;        ///< older than all that is kept
  std::uint64_t doubled = 0;     ///< that had come already
  std::uint64_t impossible = 0;  ///< no numbers, or outside of the arena
  std::uint64_t disputed = 0;    ///< that another tracker spoke against
  std::uint64_t jumps = 0;       ///< it is elsewhere than its wheels can have brought it
  std::uint64_t slips = 0;       ///< its wheels rolled farther than it came
};

/// A source of poses of one robot: odometry, a camera, a motion-capture system.
class PoseSource {
 public:
  virtual ~PoseSource() = default;

  /// As in `<tracker source="…">`.
  virtual std::string_view name() const noexcept = 0;

  /// The newest pose with a stamp of at most `now`. Called once a tick, after the robot's readings
  /// were latched; neither blocks nor allocates.
  virtual TrackedPose latch(const Moment& now) noexcept = 0;
  /// How many measurements it did not believe.
  virtual std::uint64_t rejected() const noexcept = 0;
  /// How often it believed in the end that the robot is farther from where it was than it can have moved: it was
  /// carried, or it is another one.
  virtual std::uint64_t jumps() const noexcept { return 0; }
  /// How often it believed in the end that the robot came less far than its wheels rolled.
  virtual std::uint64_t slips() const noexcept { return 0; }
  /// Whether sources of it say different places now, and none is known to be right.
  virtual bool disputed() const noexcept { return false; }
  /// What a tracker saw of it last, as it came; null: there is none that has seen it.
  virtual const PoseMeasurement* newest_sighting() const noexcept { return nullptr; }
  /// Whether it knows of nothing but the wheels: what they slip it cannot tell.
  virtual bool by_wheels() const noexcept { return false; }
  /// What trackers saw since the `latch` before the last one, brought up to date by every `latch`; null: it asks none.
  virtual const SightingsRow* sightings() const noexcept { return nullptr; }
  /// What the robot is told from now on, which must outlive this: it shapes what the wheels rolled between two
  /// readings.
  virtual void drives_by(const CommandedMotion& /*motion*/) noexcept {}
  /// By which the body is later than the stamps of its encoders, as far as is known; may be negative.
  virtual double lag_s() const noexcept { return 0.0; }
  /// Writes what was learnt of the robot's wheels, as of the last `latch`.
  virtual void note_learnt(TrackRow& /*row*/) const noexcept {}
};

}  // namespace tandem::mixed_reality
