// Point masses in space: robots that fly, and wheels that roll without slip.
#pragma once
#include "core/physics/solver.hpp"

namespace tandem::core {

/// `<particle3d>`. A robot is a point mass with the upright cylinder of its kind around it.
///
/// One that flies is accelerated towards the velocity that FlightCommand asks for, by at most its kind's
/// acceleration beyond what holds it up, and against a drag that grows with its speed; it never gets faster than its
/// kind says. Towards a position it flies as fast as it can still brake. With an attitude, its thrust accelerates
/// it as if it leaned. FlightCommand::None: it falls, and lies where it lands; Held: it stays where it is. It stays
/// upright, and turns at the commanded rate at once, within its limit. With `flight="exact"` it knows no masses: it has
/// the wanted velocity at once, and arrives at positions exactly.
///
/// One with wheels follows the arcs of its wheels exactly, on the ground or on whatever it stands on; it falls where
/// nothing is beneath it. Wheels know no masses: they push as kinematics2d's do.
///
/// No cylinder ever enters an immovable object, the ground, the ceiling (the arena's, or the region's top) or a wall of
/// its region; bodies slide along them, but thrust against them is lost for other directions. Bodies that overlap are
/// pushed apart by half the overlap each, upwards and downwards where that is the shorter way; those moved from outside
/// push but are not pushed. Passes are computed from the positions of the one before, so the order of bodies does not
/// matter.
const EngineType& particle3d_type();

inline void register_particle3d(hal::Registrar& registrar) {
  register_engine(registrar, particle3d_type());
}

}  // namespace tandem::core
