#include "hal/plugin.hpp"

#include "controllers/footbot_shuttle/footbot_shuttle.hpp"

namespace {
void register_all(tandem::hal::Registrar& registrar) {
  registrar.add_controller<tandem::controllers::FootbotShuttle>(
      "footbot_shuttle", "Drives there and back by its odometry, both wheels alike.");
}
}  // namespace

TANDEM_PLUGIN(register_all)
