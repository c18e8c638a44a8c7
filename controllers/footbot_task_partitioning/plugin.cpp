#include "hal/plugin.hpp"

#include "controllers/footbot_task_partitioning/footbot_task_partitioning.hpp"

namespace {
void register_all(tandem::hal::Registrar& registrar) {
  registrar.add_controller<tandem::controllers::FootbotTaskPartitioning>(
      "footbot_task_partitioning", "Brings objects to the nest, each robot a part of the way; finds back by odometry.");
}
}  // namespace

TANDEM_PLUGIN(register_all)
