#include "hal/plugin.hpp"

#include "controllers/epuck_diffusion/epuck_diffusion.hpp"

namespace {
void register_all(tandem::hal::Registrar& registrar) {
  registrar.add_controller<tandem::controllers::EpuckDiffusion>(
      "epuck_diffusion", "Spreads out: straight on, turning away from what is near.");
}
}  // namespace

TANDEM_PLUGIN(register_all)
