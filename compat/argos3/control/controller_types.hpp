// Classes that users' libraries register, as classes of controllers.
#pragma once
#include <argos3/core/utility/plugins/factory.h>
#include <vector>

#include "hal/catalog.hpp"
#include "hal/plugin.hpp"

namespace tandem::compat::argos3 {

/// Adds those that are of the kind "controller". @throws std::runtime_error when the process has too many
void register_controllers(const std::vector<const argos::tandem_detail::SRegistration*>& registrations,
                          hal::Registrar& registrar);

/// Whether `register_controllers` made it.
bool is_controller_of_argos(const hal::ControllerType& type) noexcept;

}  // namespace tandem::compat::argos3
