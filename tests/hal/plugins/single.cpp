// One controller.
#include "hal/plugin.hpp"

namespace {

struct Idle final : tandem::hal::Controller {
  explicit Idle(tandem::hal::Robot&) {}
  void step() override {}
};

void register_all(tandem::hal::Registrar& registrar) {
  registrar.add_controller<Idle>("idle", "Does nothing.");
}

}  // namespace

TANDEM_PLUGIN(register_all)
