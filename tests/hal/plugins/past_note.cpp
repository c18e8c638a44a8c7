// Registers something that its note does not tell.
#include "hal/plugin.hpp"

namespace {

void register_all(tandem::hal::Registrar& registrar) {
  static const int engine = 0;
  registrar.add(tandem::hal::CatalogItem{"engine", "secret", 1, &engine, sizeof engine});
}

}  // namespace

TANDEM_PLUGIN(register_all)
