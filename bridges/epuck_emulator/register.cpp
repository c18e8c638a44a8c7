#include "bridges/epuck_emulator/register.hpp"

#include <array>

#include "bridges/emulation/emulator_type.hpp"
#include "bridges/epuck_emulator/emulator.hpp"
#include "bridges/epuck_emulator/port_body.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/leds.hpp"

namespace tandem::bridges::epuck_emulator {
namespace {

struct Own {
  std::string firmware = "gctronic";
  void describe(hal::ParamVisitor& v) { v.text("firmware", firmware, "btcom, gctronic, webots or epuck2."); }
};

hal::Status run_type(const EmulatorRequest& request, SharedPorts* ports, const std::atomic<bool>& stop) {
  Options options;
  apply(request, options);
  if (request.options != nullptr) options.firmware = static_cast<const Own*>(request.options.get())->firmware;
  options.ready = [&request](const std::string& path) {
    if (request.ready)
      request.ready("e-puck's firmware on " + path + ": connect with --link serial:" + path + "@115200");
  };
  std::optional<PortBody> body;
  if (ports != nullptr) options.body = &body.emplace(*ports);
  return run(options, stop);
}

const EmulatorType kType{.name = "epuck",
                         .kind = hal::epuck::kName,
                         .summary = "An e-puck's stock firmware behind a serial line: pty:NAME, serial:DEVICE@115200.",
                         .puppet = "<puppet library=\"puppet\" …>",
                         .needs = &port_types_of<hal::FrontLed, hal::Microphones>,
                         .ports = &body_ports,
                         .read = &read_options<Own>,
                         .run = &run_type};

}  // namespace

void register_emulator(hal::Registrar& registrar) {
  registrar.add(kType);
}

}  // namespace tandem::bridges::epuck_emulator
