#include "mixed_reality/twin/twin_entity.hpp"

namespace tandem::mixed_reality {

TwinEntity::TwinEntity(core::Space& space, core::RobotId robot, const RealReadings& real)
    : space_(space), robot_(robot), fusion_(space, robot, real), positioning_(space.port<hal::Positioning>(robot)) {
  state_.set_pose(space.pose(robot));
  space_.set_external(robot_, true);
}

void TwinEntity::latch() noexcept {
  if (!takes_part_) return;
  takes_part_ = state_.takes_part;
  const bool held = state_.held && takes_part_;
  if (held != held_) space_.set_halted(robot_, held, core::HaltOwner::Safety);
  held_ = held;
  if (!takes_part_) {
    space_.set_halted(robot_, true, core::HaltOwner::Safety);  // it begins with safe commands, whatever was before
    space_.set_halted(robot_, false, core::HaltOwner::Safety);
    return space_.set_external(robot_, false);
  }
  space_.set_real_senses(robot_, state_.senses);
  apply_mechanisms(space_, robot_, state_);
  space_.set_pose(robot_, state_.pose());
}

void TwinEntity::after_sense() noexcept {
  if (!takes_part_) return;
  fusion_.fuse();
  tell_place();
}

/// A robot that does not measure its place itself is told the one of its twin.
void TwinEntity::tell_place() noexcept {
  if (positioning_ == nullptr || positioning_->validity != hal::Validity::Absent) return;
  if (state_.place_validity == hal::Validity::Absent) return;
  positioning_->p_WB = {state_.place_x_m, state_.place_y_m, state_.place_z_m};
  positioning_->q_WB = {state_.place_qw, 0.0, 0.0, state_.place_qz};
  positioning_->taken_ns = state_.place_taken_ns;
  positioning_->validity = state_.place_validity;
}

void TwinEntity::list(core::SpaceInputs& inputs) const {
  inputs.rows.push_back({robot_, &hal::row_type<TwinState>(), &state_});
  for (std::size_t i = 0; i < fusion_.size(); ++i)
    inputs.rows.push_back({robot_, &fusion_.type(i), fusion_.reading(i)});
}

}  // namespace tandem::mixed_reality
