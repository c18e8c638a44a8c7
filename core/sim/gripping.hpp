// What grippers hold: joints between robots and what is before their claws, and turrets that carry a load.
#pragma once
#include "core/space/stores.hpp"

namespace tandem::core {

/// After every gripper and turret took its command and before physics: claws that opened take hold of the nearest body
/// before them, those that closed let go, and joints follow what the turrets were told. One robot after the other in
/// the order of rows, because joints are common to all. Does nothing while no controller takes a gripper.
///
/// Open claws hold the first thing that the line from the robot's rim outwards meets within the data sheet's reach, at
/// the claws' height: a movable box or cylinder, or a robot whose kind has a gripper itself. They keep trying while
/// nothing is there. What they hold turns with the turret: firmly while that is off or has arrived, freely while it is
/// passive, else with the turret's motor. Robots whose pose comes from outside neither hold nor are held.
void grip_and_release(SpaceStores& stores, double tick_s);

/// After physics: turrets that carry a load look where the load went.
void follow_loads(SpaceStores& stores, double tick_s) noexcept;

}  // namespace tandem::core
