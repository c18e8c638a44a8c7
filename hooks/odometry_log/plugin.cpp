#include "hal/plugin.hpp"

#include "hooks/odometry_log/odometry_log.hpp"

namespace {
void register_all(tandem::hal::Registrar& registrar) {
  registrar.add(tandem::core::hook_type<tandem::hooks::OdometryLog>(
      "odometry_log", "Writes where robots think that they are, beside where they are."));
}
}  // namespace

TANDEM_PLUGIN(register_all)
