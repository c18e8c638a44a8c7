// The entity that stands for a real robot in a space, and all that the real robot does to it.
//
// Twin (of a real robot) and Replay (of a record) decide the state and the readings of a tick; what comes of them in
// the space is written here alone, as a function of these values. That is why a replay has the same bits.
#pragma once
#include "core/space/space.hpp"
#include "core/space/space_inputs.hpp"
#include "hal/device/flight.hpp"
#include "mixed_reality/fusion/port_fusion.hpp"
#include "mixed_reality/twin/twin_state.hpp"

namespace tandem::mixed_reality {

class TwinEntity {
 public:
  /// The entity becomes external: engines do not move it, others bump into it. The space, and what `real` returns, must
  /// outlive this; `real` may have nothing where readings are written by hand.
  TwinEntity(core::Space& space, core::RobotId robot, const RealReadings& real);

  core::RobotId robot() const noexcept { return robot_; }
  /// To be brought up to date before `latch`.
  TwinState& state() noexcept { return state_; }
  const TwinState& state() const noexcept { return state_; }
  PortFusion& fusion() noexcept { return fusion_; }
  const PortFusion& fusion() const noexcept { return fusion_; }

  /// At the beginning of a tick: the entity comes where `state` says, is held or not, its mechanisms stand as they say.
  /// One that takes no part any more becomes a simulated robot, for good.
  void latch() noexcept;
  /// The space's ports, which hold the virtual readings, get the fused ones.
  void after_sense() noexcept;
  /// Whether the entity is still led from outside.
  bool takes_part() const noexcept { return takes_part_; }

  /// Its rows: the state and every reading. They stay where they are as long as this does.
  void list(core::SpaceInputs& inputs) const;

 private:
  void tell_place() noexcept;

  core::Space& space_;
  core::RobotId robot_;
  TwinState state_;
  PortFusion fusion_;
  hal::Positioning* positioning_;  // the controller's; null: it took none
  bool takes_part_ = true, held_ = false;
};

}  // namespace tandem::mixed_reality
