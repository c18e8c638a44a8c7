#include "app/dynamics/register.hpp"

#include "core/physics/dynamics2d/dynamics2d.hpp"
#include "core/physics/dynamics3d/dynamics3d.hpp"
#include "core/physics/particle3d/particle3d.hpp"

namespace tandem::app {

void register_dynamics(hal::Registrar& registrar) {
  core::register_dynamics2d(registrar);
  core::register_dynamics3d(registrar);
  core::register_particle3d(registrar);
}

}  // namespace tandem::app
