// Registers a controller without a type.
#include "hal/plugin.hpp"

namespace {

void register_all(tandem::hal::Registrar& registrar) {
  registrar.add(tandem::hal::CatalogItem{"controller", "nobody",
                                         tandem::hal::entry_layout<tandem::hal::ControllerType>(), nullptr});
}

}  // namespace

TANDEM_PLUGIN(register_all)
