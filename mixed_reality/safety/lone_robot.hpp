// A real robot whose controller writes straight into its bridge's ports, as `tandem robot` drives it.
//
//   controller = type.construct(memory, bridge->robot(), params);
//   LoneRobot robot(id, std::move(bridge), …);       // when the controller has taken its ports
//   each tick:  if (robot.latch(tick, now, phase)) controller step;  robot.commit(now);
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "hal/device/body_sensors.hpp"
#include "hal/log.hpp"
#include "mixed_reality/safety/real_robot.hpp"

namespace tandem::mixed_reality {

/// The robot's place plays no part: no fence, no barrier. Not thread-safe; `latch` and `commit` allocate nothing but
/// for messages.
class LoneRobot {
 public:
  LoneRobot(std::string id, std::unique_ptr<bridges::RobotBridge> bridge, RealRobotParams params, hal::TimeNs tick_ns,
            hal::Log log);

  /// Takes over readings, stamped so that those of tick `tick` are as old as they are now, and judges. `now` is
  /// CLOCK_MONOTONIC. @returns whether the controller is to step.
  bool latch(hal::Tick tick, hal::TimeNs now, RunPhase phase = RunPhase::Running);
  /// Sends what the controller wrote, as far as it may be. Its ports keep what it wrote.
  void commit(hal::TimeNs now);

  RealRobot& real() noexcept { return real_; }
  const RealRobot& real() const noexcept { return real_; }
  /// Why it may not drive, for people: "a reading never came (ground)".
  std::string reason() const;

 private:
  /// That its controller asked for: it does not drive before each came once.
  struct Input {
    const hal::PortType* type;
    const hal::Reading* reading;
    bool came = false;
  };
  const hal::PortType* missing() const noexcept;
  void note();

  std::string id_;
  std::vector<WantedCommand> commands_;
  std::vector<Input> inputs_;
  RealRobot real_;
  const hal::Positioning* position_;  // null: it does not know
  hal::TimeNs tick_ns_;
  hal::Log log_;
  std::string_view noted_;
};

}  // namespace tandem::mixed_reality
