#include "hal/plugin.hpp"

#include "controllers/obstacle_avoidance/obstacle_avoidance.hpp"

namespace {
void register_all(tandem::hal::Registrar& registrar) {
  registrar.add_controller<tandem::controllers::ObstacleAvoidance>("obstacle_avoidance",
                                                                   "Cruises and turns smoothly away from obstacles.");
}
}  // namespace

TANDEM_PLUGIN(register_all)
