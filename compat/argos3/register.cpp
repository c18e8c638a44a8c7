#include "compat/argos3/register.hpp"

#include "compat/argos3/control/controller_types.hpp"
#include "compat/argos3/facade/library.hpp"
#include "compat/argos3/simulator/hooks.hpp"

namespace tandem::compat::argos3 {

void register_library(const void* address, hal::Registrar& registrar) {
  const auto registrations = registrations_of(address);
  register_controllers(registrations, registrar);
  register_hooks(registrations, registrar);
}

}  // namespace tandem::compat::argos3

namespace tandem::app {

void register_argos3(hal::Registrar& registrar) {
  static constexpr compat::argos3::Facade kFacade = {"argos3",
                                                     "ARGoS 3's classes for sources that were written for it"};
  registrar.add(kFacade);
  static const core::HookType kLook = [] {
    core::HookType look = compat::argos3::look_hook();
    look.comes_with = &compat::argos3::is_controller_of_argos;
    return look;
  }();
  registrar.add(kLook);
}

}  // namespace tandem::app
