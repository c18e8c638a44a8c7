#include "bridges/eyebot/world_frame.hpp"

#include "hal/angle.hpp"
#include "hal/vector.hpp"

namespace tandem::bridges::eyebot {

Vector turned(const Quaternion& q, const Vector& v) noexcept {
  return hal::array_of(hal::quaternion_of(q) * hal::vector_of(v));
}

Vector about_z(const Vector& v, double turn_rad) noexcept {
  return hal::array_of(hal::about_z(turn_rad) * hal::vector_of(v));
}

Vector WorldFrame::place_in_run(const Vector& robots) const noexcept {
  return hal::array_of(hal::vector_of(direction_in_run(robots)) + hal::vector_of(origin));
}

Vector WorldFrame::place_of_robot(const Vector& runs) const noexcept {
  return direction_of_robot(hal::array_of(hal::vector_of(runs) - hal::vector_of(origin)));
}

Quaternion WorldFrame::orientation_in_run(const Quaternion& robots) const noexcept {
  return hal::array_of(hal::about_z(turn_rad) * hal::quaternion_of(robots).normalized());
}

double WorldFrame::heading_of_robot(double runs_rad) const noexcept {
  return hal::turn_between(turn_rad, runs_rad);
}

}  // namespace tandem::bridges::eyebot
