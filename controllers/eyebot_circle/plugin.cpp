#include "hal/plugin.hpp"

#include "controllers/eyebot_circle/eyebot_circle.hpp"

namespace {
void register_all(tandem::hal::Registrar& registrar) {
  registrar.add_controller<tandem::controllers::EyebotCircle>(
      "eyebot_circle", "Flies circles over a place, calling those who are to follow.");
}
}  // namespace

TANDEM_PLUGIN(register_all)
