#include "hal/plugin.hpp"

#include "controllers/footbot_synchronization/footbot_synchronization.hpp"

namespace {
void register_all(tandem::hal::Registrar& registrar) {
  registrar.add_controller<tandem::controllers::FootbotSynchronization>(
      "footbot_synchronization", "Flashes in unison with the robots that it sees, as fireflies do.");
}
}  // namespace

TANDEM_PLUGIN(register_all)
