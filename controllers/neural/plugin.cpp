#include "hal/plugin.hpp"

#include "controllers/neural/neural.hpp"

namespace {
void register_all(tandem::hal::Registrar& registrar) {
  registrar.add_controller<tandem::controllers::Neural>("neural",
                                                        "Runs a small network from a file: readings in, commands out.");
}
}  // namespace

TANDEM_PLUGIN(register_all)
