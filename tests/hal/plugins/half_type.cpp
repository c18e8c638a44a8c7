// Registers a controller whose type lacks functions.
#include "hal/plugin.hpp"

namespace {

void register_all(tandem::hal::Registrar& registrar) {
  static tandem::hal::ControllerType half;
  half.name = "half";
  registrar.add(half);
}

}  // namespace

TANDEM_PLUGIN(register_all)
