#include "hal/plugin.hpp"

#include "controllers/footbot_follow/footbot_follow.hpp"

namespace {
void register_all(tandem::hal::Registrar& registrar) {
  registrar.add_controller<tandem::controllers::FootbotFollow>("footbot_follow",
                                                               "Follows whoever calls, in the air or on the ground.");
}
}  // namespace

TANDEM_PLUGIN(register_all)
