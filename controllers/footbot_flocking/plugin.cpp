#include "hal/plugin.hpp"

#include "controllers/footbot_flocking/footbot_flocking.hpp"

namespace {
void register_all(tandem::hal::Registrar& registrar) {
  registrar.add_controller<tandem::controllers::FootbotFlocking>(
      "footbot_flocking", "Moves towards the light in a hexagonal pattern with the robots that it sees.");
}
}  // namespace

TANDEM_PLUGIN(register_all)
