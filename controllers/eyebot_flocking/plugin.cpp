#include "hal/plugin.hpp"

#include "controllers/eyebot_flocking/eyebot_flocking.hpp"

namespace {
void register_all(tandem::hal::Registrar& registrar) {
  registrar.add_controller<tandem::controllers::EyebotFlocking>(
      "eyebot_flocking", "Keeps its distance to its neighbours in space, and flies with them.");
}
}  // namespace

TANDEM_PLUGIN(register_all)
