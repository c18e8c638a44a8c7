#include "hal/plugin.hpp"

#include "controllers/footbot_diffusion/footbot_diffusion.hpp"

namespace {
void register_all(tandem::hal::Registrar& registrar) {
  registrar.add_controller<tandem::controllers::FootbotDiffusion>(
      "footbot_diffusion", "Spreads foot-bots out: straight on, turning away from what is near.");
}
}  // namespace

TANDEM_PLUGIN(register_all)
