#include "hal/plugin.hpp"

#include "hooks/throughput/throughput.hpp"

namespace {
void register_all(tandem::hal::Registrar& registrar) {
  registrar.add(tandem::core::hook_type<tandem::hooks::Throughput>(
      "throughput", "Counts objects that are brought to the nest, and puts them back to the source."));
}
}  // namespace

TANDEM_PLUGIN(register_all)
