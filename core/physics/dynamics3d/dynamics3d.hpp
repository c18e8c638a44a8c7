// Masses, forces, friction and gravity in space, on ODE.
#pragma once
#include "core/physics/solver.hpp"

namespace tandem::core {

/// `<dynamics3d>`: robots on wheels are upright cylinders that a drive of limited force moves over the floor, or
/// (`drive="wheels"`) bodies on two motorised wheels; robots that fly are held in the air by a limited thrust, or
/// (`flight="rotors"`) by four rotors, and then lean to where they are to go; boxes and cylinders that are movable have
/// mass, fall, and rub on the floor and on one another.
const EngineType& dynamics3d_type();

inline void register_dynamics3d(hal::Registrar& registrar) {
  register_engine(registrar, dynamics3d_type());
}

}  // namespace tandem::core
