#include "hal/plugin.hpp"

#include "hooks/foraging/foraging.hpp"

namespace {
void register_all(tandem::hal::Registrar& registrar) {
  registrar.add(tandem::core::hook_type<tandem::hooks::Foraging>(
      "foraging", "Food items on the floor, the nest, and the balance of energy."));
}
}  // namespace

TANDEM_PLUGIN(register_all)
