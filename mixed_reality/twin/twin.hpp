// A real robot among simulated ones: the entity that stands for it in the space, kept true in every tick.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/robot_bridge.hpp"
#include "core/space/space.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/wheels.hpp"
#include "hal/log.hpp"
#include "mixed_reality/fence/intrusion.hpp"
#include "mixed_reality/safety/real_robot.hpp"
#include "mixed_reality/time/moment.hpp"
#include "mixed_reality/tracking/commanded_motion.hpp"
#include "mixed_reality/tracking/delay_watch.hpp"
#include "mixed_reality/tracking/pose_source.hpp"
#include "mixed_reality/tracking/slip_watch.hpp"
#include "mixed_reality/twin/mechanisms.hpp"
#include "mixed_reality/twin/smooth_pose.hpp"
#include "mixed_reality/twin/twin_barrier.hpp"
#include "mixed_reality/twin/twin_entity.hpp"

namespace tandem::mixed_reality {

struct TwinParams {
  RearmParams rearm;
  hal::TimeNs pose_timeout_ns = 500 * hal::kNsPerMs;  ///< age from which a pose is stale
  hal::TimeNs frozen_after_ns = hal::kNsPerSecond;    ///< two ticks that lie farther apart: the hub was frozen
  double fence_ahead_s = 0.5;                         ///< how far ahead the arena's edge is looked for
  bool ask_battery = false;  ///< also where its controller does not read it, and its line is slow
  double coast_s = 2.0;      ///< in an outage the twin drives on as last commanded, at most for so long
};

/// Counted in the ticks of the run.
struct TwinCounts {
  std::uint64_t ticks_driving = 0;
  std::uint64_t ticks_held = 0;
  std::uint64_t stops = 0;  ///< times it was stopped by the safety table
  std::uint64_t rearms = 0;
  std::uint64_t fenced_ticks = 0;  ///< commands cut because they led out of the arena
  std::uint64_t intrusions = 0;    ///< times its twin came to stand in something virtual
  BarrierCounts barrier;
};

/// Keeps the entity `robot` of a space and a real robot one. Four calls a tick, in this order; none waits or
/// allocates, but that messages are logged when the verdict changes.
class Twin {
 public:
  /// The entity becomes external: engines do not move it, others bump into it. All but `real` must outlive this.
  Twin(core::Space& space, core::RobotId robot, std::unique_ptr<bridges::RobotBridge> real,
       std::unique_ptr<PoseSource> poses, const TwinParams& params, const hal::Log& log);

  /// Its wheels roll as another robot is seen to move: heeded by the next `latch`. `what` for people.
  void links_seem_swapped(const std::string& what) {
    swapped_ = true;
    note_incident(now_, what, true);
  }
  /// Before the run, with the phase Running for this robot alone: it drives so, whatever its controller says, as far as
  /// the safety table lets it; nothing: as its controller says.
  void steer(const std::optional<hal::WheelSpeeds>& wheels) noexcept { robot_now_.gate().steer(wheels); }
  /// Takes over the newest readings and pose, and decides whether the robot may move; its controller is held if not.
  void latch(const Moment& now, RunPhase phase);
  /// The space's ports, which hold the twin's virtual readings, get the fused ones.
  void after_sense() noexcept;
  /// From now on commands go through this filter, which must outlive the twin.
  void join(BarrierFilter& filter) { barrier_ = std::make_unique<TwinBarrier>(filter, space_.kind(robot_)); }
  void leave() noexcept { barrier_.reset(); }
  /// Tells that filter what the controller commanded; then all robots' commands are decided upon at once.
  void offer(const Moment& now);
  /// Sends what the controller commanded, as far as it may be.
  void after_filter(const Moment& now);
  /// The real robot takes no part any more: the entity becomes one of the simulated ones. No other call follows.
  void let_go();

  /// What the robot did to the space in this tick: state and readings.
  const TwinEntity& entity() const noexcept { return entity_; }
  /// Their rows, and those of the commands that the robot was sent. They stay where they are as long as this does.
  void list(core::SpaceInputs& inputs) const;
  const std::string& id() const noexcept { return id_; }
  core::RobotId robot() const noexcept { return robot_; }
  /// Commands of persons and guards to the robot.
  RealRobot& real_robot() noexcept { return robot_now_; }
  const RealRobot& real_robot() const noexcept { return robot_now_; }
  bridges::RobotBridge& real() noexcept { return robot_now_.bridge(); }
  const bridges::RobotBridge& real() const noexcept { return robot_now_.bridge(); }
  /// Where the robot is in this tick, as well as is known: the tracked pose, carried on by what was commanded since it
  /// was taken. Its entity comes there without jumps.
  const core::Pose& pose() const noexcept { return pose_; }
  const PoseSource& poses() const noexcept { return *poses_; }
  hal::TimeNs pose_taken_ns() const noexcept { return pose_taken_ns_; }  ///< on the run's clock
  /// As its source said in the last `latch`.
  const TrackedPose& tracked() const noexcept { return tracked_; }
  /// The newest reading of all that the robot is asked for; null: none came yet.
  const hal::Reading* newest_reading() const noexcept;
  const hal::WheelEncoders* encoders() const noexcept { return encoders_; }  ///< null: not asked for
  const Verdict& verdict() const noexcept { return robot_now_.verdict(); }
  /// The wheel speeds last handed to the robot.
  const hal::WheelSpeeds& sent() const noexcept { return sent_; }
  /// By how much the filter changed the last command; 0: not at all.
  double changed_m_s() const noexcept { return barrier_ != nullptr ? barrier_->changed_m_s() : 0.0; }
  TwinCounts counts() const noexcept;
  /// Why the robot did not drive, in the order in which that came up: "12.3 s: link lost". The first few.
  const std::vector<std::string>& incidents() const noexcept { return incidents_; }

 private:
  void track(const Moment& now, Conditions& conditions) noexcept;
  void note_track() noexcept;
  void tell_place() noexcept;
  core::Pose carried_on(const core::Pose& pose, hal::TimeNs from_ns, double for_s) const noexcept;
  void look_for_intrusions(const Moment& now);
  void note_incident(const Moment& now, const std::string& what, bool serious);
  void note(const Moment& now);
  void note_trespass(const Moment& now);
  void measure_delay(const Moment& now);
  bool may_move(const Moment& now) const noexcept;
  void prepare(const Moment& now);
  bool confine(const hal::PortType& type, void* command) const noexcept;
  void hold_back(const hal::PortType& type, void* command) const noexcept;

  core::Space& space_;
  core::RobotId robot_;
  std::string id_;
  RealRobot robot_now_;
  std::unique_ptr<PoseSource> poses_;
  TwinParams params_;
  const hal::Log& log_;
  hal::Fence fence_;        // for poses of the twin
  hal::Fence inner_fence_;  // for where its middle may go
  TwinEntity entity_;
  Mechanisms mechanisms_;
  bool told_place_;                               // its controller took a positioning
  std::vector<const hal::Reading*> readings_;     // that the robot is asked for
  std::unique_ptr<SlipWatch> slip_;               // null: there is nothing to compare the wheels with
  std::unique_ptr<DelayWatch> delay_;             // null: it has no wheels, or does not tell what they roll
  const hal::WheelEncoders* encoders_ = nullptr;  // null: the same
  std::unique_ptr<CommandedMotion> motion_;       // null: it has no wheels
  std::uint64_t jumps_ = 0, slips_ = 0;           // of the pose, as far as they were judged
  bool swapped_ = false;
  TrackedPose tracked_;
  TrackRow track_;  // the same, for a record
  core::Pose pose_;
  SmoothPose smooth_;
  std::unique_ptr<TwinBarrier> barrier_;  // null: nothing keeps it from collisions
  hal::TimeNs heard_ns_ = 0;              // when it was last told something while it could hear
  Intrusion intrusion_;
  bool intruding_ = false;
  hal::WheelSpeeds sent_;
  hal::WheelSpeeds driven_;  // what it was last told while it could hear
  bool running_ = false;
  bool prepared_ = false;          // the commands of this tick
  Moment now_;                     // of the last `latch`
  hal::TimeNs pose_taken_ns_ = 0;  // on the run's clock
  hal::Validity pose_validity_ = hal::Validity::Absent;
  std::string_view noted_;
  TwinCounts counts_;
  std::vector<std::string> incidents_;
};

}  // namespace tandem::mixed_reality
