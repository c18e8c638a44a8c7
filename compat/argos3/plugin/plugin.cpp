// What makes a plug-in of a user's library: linked into each, from libtandem_argos3_plugin.a.
#include "hal/plugin.hpp"

#include "compat/argos3/facade/library.hpp"
#include "core/hook/hook.hpp"

namespace {

/// In the note of every such library: the module `argos3` is loaded before it, and registers for it.
void register_all(tandem::hal::Registrar& registrar) {
  tandem::hal::detail::note_surface<tandem::compat::argos3::Facade>();
  tandem::hal::detail::note_surface<tandem::hal::ControllerType>();
  tandem::hal::detail::note_surface<tandem::core::HookType>();
  tandem::compat::argos3::register_library(reinterpret_cast<const void*>(&register_all), registrar);
}

}  // namespace

TANDEM_PLUGIN(register_all)

namespace argos::tandem_detail {

__attribute__((visibility("hidden"))) void LinkPlugin() {}

}  // namespace argos::tandem_detail
