#include "hal/plugin.hpp"

#include "controllers/footbot_gripping/footbot_gripping.hpp"

namespace {
void register_all(tandem::hal::Registrar& registrar) {
  registrar.add_controller<tandem::controllers::FootbotGripping>(
      "footbot_gripping", "Fetches the first thing ahead: grips it, turns beneath its turret, pulls it home.");
}
}  // namespace

TANDEM_PLUGIN(register_all)
