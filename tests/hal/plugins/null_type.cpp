// Registers a controller without a type.
#include "hal/plugin.hpp"

namespace {

void register_all(tandem::hal::Registrar& registrar) {
  registrar.add("controller", "nobody", nullptr);
}

}  // namespace

TANDEM_PLUGIN(register_all)
