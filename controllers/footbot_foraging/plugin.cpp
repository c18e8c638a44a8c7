#include "hal/plugin.hpp"

#include "controllers/footbot_foraging/footbot_foraging.hpp"

namespace {
void register_all(tandem::hal::Registrar& registrar) {
  registrar.add_controller<tandem::controllers::FootbotForaging>(
      "footbot_foraging",
      "Looks for food on the floor, brings it to the nest, and rests there the longer, the less there is.");
}
}  // namespace

TANDEM_PLUGIN(register_all)
