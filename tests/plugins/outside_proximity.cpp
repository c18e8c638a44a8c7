// The proximity sensor of the program, compiled once more as a plug-in: `tandem bench --with proximity:outside`
// measures what it costs that a device comes from outside.
#include "core/device/proximity.cpp"
#include "hal/plugin.hpp"

namespace {

void register_all(tandem::hal::Registrar& registrar) {
  static const tandem::core::DeviceType type = [] {
    for (tandem::core::DeviceType inside : tandem::core::proximity_types()) {
      if (inside.implementation != "default") continue;
      inside.implementation = "outside";
      return inside;
    }
    return tandem::core::DeviceType{};
  }();
  registrar.add(type);
}

}  // namespace

TANDEM_PLUGIN(register_all)
