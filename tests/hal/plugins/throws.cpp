// Throws after it has registered a controller.
#include <stdexcept>

#include "hal/plugin.hpp"

namespace {

struct Idle final : tandem::hal::Controller {
  explicit Idle(tandem::hal::Robot&) {}
  void step() override {}
};

void register_all(tandem::hal::Registrar& registrar) {
  registrar.add_controller<Idle>("idle", "Does nothing.");
  throw std::runtime_error("no licence");
}

}  // namespace

TANDEM_PLUGIN(register_all)
