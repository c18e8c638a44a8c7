// Masses, forces and friction in the plane, on Box2D.
#pragma once
#include "core/physics/solver.hpp"

namespace tandem::core {

/// `<dynamics2d>`: robots are discs that their wheels pull to the commanded speed with a limited force; boxes and
/// cylinders that are movable have mass, and rub on the ground.
const EngineType& dynamics2d_type();

inline void register_dynamics2d(hal::Registrar& registrar) {
  register_engine(registrar, dynamics2d_type());
}

}  // namespace tandem::core
