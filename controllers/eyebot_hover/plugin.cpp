#include "hal/plugin.hpp"

#include "controllers/eyebot_hover/eyebot_hover.hpp"

namespace {
void register_all(tandem::hal::Registrar& registrar) {
  registrar.add_controller<tandem::controllers::EyebotHover>(
      "eyebot_hover", "Takes off, keeps its place, and lands when its time is up.");
}
}  // namespace

TANDEM_PLUGIN(register_all)
