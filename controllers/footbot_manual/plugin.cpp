#include "hal/plugin.hpp"

#include "controllers/footbot_manual/footbot_manual.hpp"

namespace {
void register_all(tandem::hal::Registrar& registrar) {
  registrar.add_controller<tandem::controllers::FootbotManual>(
      "footbot_manual", "Does what datagrams say: drive, turn the turret, grip, let go.");
}
}  // namespace

TANDEM_PLUGIN(register_all)
