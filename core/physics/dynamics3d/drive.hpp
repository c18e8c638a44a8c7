// Drives and thrusts of limited strength, which move robots.
#pragma once
#include "core/physics/dynamics3d/body_proxy.hpp"

namespace tandem::core {

/// Lets a base start this sub-step towards what its wheels command.
void drive_base(BodyProxy& proxy, double left_m_s, double right_m_s, double dt_s) noexcept;
/// Lets the thrust of a flyer, if its command has any, and gravity act for this sub-step. Its limits are those of its
/// kind.
void drive_flyer(BodyProxy& proxy, const FlightCommand& command, double gravity_m_s2, double dt_s) noexcept;
/// Adds what the rotors of a flyer do in this sub-step to the forces on its body: the thrust and the torque that its
/// command asks for, as far as the rotors have them and with their lag. Attitude is held by a controller of its own.
void drive_rotors(BodyProxy& proxy, const FlightCommand& command, double gravity_m_s2, double dt_s);
/// Lets a light body fall.
void drop(BodyProxy& proxy, double gravity_m_s2, double dt_s) noexcept;
/// Hands the drive of an engaged base to ODE, as motors of limited force against the floor.
void engage(BodyProxy& proxy, dWorldID world);
/// Takes it back.
void release(BodyProxy& proxy) noexcept;
/// Sets the motors of a robot on wheels.
void drive_wheels(BodyProxy& proxy, double left_m_s, double right_m_s);
/// Counts what its wheels rolled in a sub-step.
void count_wheels(BodyProxy& proxy, double dt_s) noexcept;

}  // namespace tandem::core
