// A twin's commands before and after the filter that keeps real robots from collisions.
#pragma once
#include "bridges/robot_bridge.hpp"
#include "core/space/space.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/wheels.hpp"
#include "mixed_reality/barrier/barrier_filter.hpp"
#include "mixed_reality/tracking/pose_source.hpp"

namespace tandem::mixed_reality {

/// Counted in ticks of the run.
struct BarrierCounts {
  std::uint64_t changed_ticks = 0;
  double most_m_s = 0.0;         ///< largest change of a speed
  std::uint64_t trespasses = 0;  ///< times it came to be out of a fence or in a keep-out
  double delay_s = 0.0;          ///< measured, from a command to its motion; 0: none beyond what was counted on
};

/// Commands of one robot as the filter wants and answers them. Each tick: `begin`, `want` for each command in the order
/// in which they rule, the filter, `apply` to the same commands, `sent`.
class TwinBarrier {
 public:
  static constexpr double kSigmas = 3.0;      ///< that a pose may be wrong by
  static constexpr double kError_rad = 0.02;  ///< of headings of unknown uncertainty
  static constexpr double kTouch_m = 0.01;    ///< less deep is no trespass

  /// The filter must outlive this.
  TwinBarrier(BarrierFilter& filter, const hal::RobotKind& kind)
      : filter_(filter), kind_(kind), robot_(filter.add(kind)) {}
  ~TwinBarrier() { filter_.remove(robot_); }
  TwinBarrier(const TwinBarrier&) = delete;
  TwinBarrier& operator=(const TwinBarrier&) = delete;

  /// Where the robot is, and whether it hears. `delay_s`: measured from a command to its motion; 0: not known.
  void begin(const TrackedPose& tracked, hal::TimeNs now_ns, double round_trip_s, double delay_s, bool hears) noexcept;
  /// Fills in what is virtual around it, if that is to be avoided.
  void look_around(const core::Space& space, core::RobotId robot, const core::Pose& pose) noexcept;
  void want(const hal::WheelSpeeds& wheels) noexcept;
  void want(const hal::FlightTask& task) noexcept;
  /// While it is active, nothing changes it: how it leans says nothing of where it will be.
  void want(const hal::QuadrotorAttitude& attitude, const hal::FlightState* flight) noexcept;
  void want(const hal::QuadrotorPosition& position, const core::Pose& at) noexcept;
  void want(const hal::QuadrotorSpeed& speed) noexcept;

  void apply(hal::WheelSpeeds& wheels) const noexcept;
  void apply(hal::FlightTask& task) const noexcept;
  void apply(hal::QuadrotorPosition& position, const core::Pose& at) const noexcept;
  void apply(hal::QuadrotorSpeed& speed) const noexcept;
  /// At the end, what has left. Not `moved`: it was ordered to stand.
  void sent(hal::TimeNs now_ns, const hal::WheelSpeeds& wheels, bool moved) noexcept;

  bool begun() const noexcept { return begun_; }
  bool changed() const noexcept { return robot_.changed_m_s > 0.0; }
  double changed_m_s() const noexcept { return robot_.changed_m_s; }
  const Trespass& trespass() const noexcept { return robot_.trespass; }
  const BarrierCounts& counts() const noexcept { return counts_; }
  /// The delay that is counted on; 0 before the first `begin`.
  double latency_s() const noexcept { return robot_.latency_s; }
  /// Once for each time that it comes to be where it should not.
  bool notes_trespass() noexcept;
  void count() noexcept;

 private:
  enum class Rules : std::uint8_t { Nothing, Task, Attitude, Position, Speed };

  BarrierFilter& filter_;
  const hal::RobotKind& kind_;
  BarrierRobot& robot_;
  BarrierCounts counts_;
  Rules rules_ = Rules::Nothing;
  bool begun_ = false;
  bool trespassing_ = false;
};

}  // namespace tandem::mixed_reality
