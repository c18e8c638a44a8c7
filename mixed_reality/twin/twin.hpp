// A real robot among simulated ones: the entity that stands for it in the space, kept true in every tick.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/robot_bridge.hpp"
#include "core/space/space.hpp"
#include "hal/log.hpp"
#include "mixed_reality/fence/fence.hpp"
#include "mixed_reality/fusion/port_fusion.hpp"
#include "mixed_reality/safety/supervisor.hpp"
#include "mixed_reality/time/moment.hpp"
#include "mixed_reality/tracking/pose_source.hpp"

namespace tandem::mixed_reality {

struct TwinParams {
  RearmParams rearm;
  hal::TimeNs pose_timeout_ns = 500 * hal::kNsPerMs;  ///< age from which a pose is stale
  hal::TimeNs frozen_after_ns = hal::kNsPerSecond;    ///< two ticks that lie farther apart: the hub was frozen
  double fence_ahead_s = 0.5;                         ///< how far ahead the arena's edge is looked for
};

/// Counted in the ticks of the run.
struct TwinCounts {
  std::uint64_t ticks_driving = 0;
  std::uint64_t ticks_held = 0;
  std::uint64_t stops = 0;  ///< times it was stopped by the safety table
  std::uint64_t rearms = 0;
  std::uint64_t fenced_ticks = 0;  ///< commands cut because they led out of the arena
};

/// Keeps the entity `robot` of a space and a real robot one. Three calls a tick, in this order; none waits or
/// allocates, but that messages are logged when the verdict changes.
class Twin {
 public:
  /// The entity becomes external: engines do not move it, others bump into it. All but `real` must outlive this.
  Twin(core::Space& space, core::RobotId robot, std::unique_ptr<bridges::RobotBridge> real,
       std::unique_ptr<PoseSource> poses, const TwinParams& params, const hal::Log& log);

  /// Takes over the newest readings and pose, and decides whether the robot may move; its controller is held if not.
  void latch(const Moment& now, RunPhase phase);
  /// The space's ports, which hold the twin's virtual readings, get the fused ones.
  void after_sense() noexcept;
  /// Sends what the controller commanded, as far as it may be.
  void after_filter(const Moment& now);

  const std::string& id() const noexcept { return id_; }
  core::RobotId robot() const noexcept { return robot_; }
  bridges::RobotBridge& real() noexcept { return *real_; }
  const bridges::RobotBridge& real() const noexcept { return *real_; }
  /// Where the robot is in this tick: the tracked pose, carried on by what was commanded since it was taken.
  const core::Pose& pose() const noexcept { return pose_; }
  const PoseSource& poses() const noexcept { return *poses_; }
  const Verdict& verdict() const noexcept { return supervisor_.verdict(); }
  /// The wheel speeds last handed to the robot.
  const hal::WheelSpeeds& sent() const noexcept { return sent_; }
  TwinCounts counts() const noexcept;
  /// Why the robot did not drive, in the order in which that came up: "12.3 s: link lost". The first few.
  const std::vector<std::string>& incidents() const noexcept { return incidents_; }

 private:
  struct Output {
    const hal::PortType* type;
    const void* port;  // in the space
    void* real;        // null: the robot has none such
  };

  hal::Validity track(const Moment& now) noexcept;
  void hold(bool held);
  void note(const Moment& now);
  void send_commands(bool alive, const Moment& now);

  core::Space& space_;
  core::RobotId robot_;
  std::string id_;
  std::unique_ptr<bridges::RobotBridge> real_;
  std::unique_ptr<PoseSource> poses_;
  TwinParams params_;
  const hal::Log& log_;
  Fence fence_;
  PortFusion fusion_;
  std::vector<Output> outputs_;
  void* real_wheels_;                         // null: it has none
  std::unique_ptr<std::max_align_t[]> safe_;  // the largest command, to be reset
  Supervisor supervisor_;
  core::Pose pose_;
  hal::WheelSpeeds sent_;
  hal::QuadrotorSpeed speed_;
  hal::QuadrotorPosition target_;
  bool running_ = false;
  bool held_ = false;  // by the safety table
  hal::TimeNs last_latch_ns_ = 0;
  std::string_view noted_;
  TwinCounts counts_;
  std::vector<std::string> incidents_;
};

}  // namespace tandem::mixed_reality
