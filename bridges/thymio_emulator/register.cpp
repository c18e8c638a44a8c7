#include "bridges/thymio_emulator/register.hpp"

#include "bridges/emulation/emulator_type.hpp"
#include "bridges/thymio_emulator/body.hpp"
#include "bridges/thymio_emulator/emulator.hpp"
#include "bridges/thymio_emulator/faults.hpp"
#include "hal/device/wheels.hpp"
#include "hal/robot/thymio.hpp"

namespace tandem::bridges::thymio_emulator {
namespace {

const EmulatorType kType{.name = "thymio",
                         .kind = hal::thymio::kName,
                         .summary =
                             "A Thymio II, as USB or ASEBA's switch shows it: pty:NAME, serial:DEVICE, "
                             "tcp-listen:PORT.",
                         .puppet = "<thymio_puppet library=\"puppet\" …>",
                         .needs = &port_types_of<hal::WheelSpeeds>,
                         .ports = &body_ports,
                         .faults = [] { return kFaults.manual(); },
                         .read = &read_options<Options>,
                         .run = &run_emulator<Options, PortBody, run>};

}  // namespace

void register_emulator(hal::Registrar& registrar) {
  registrar.add(kType);
}

}  // namespace tandem::bridges::thymio_emulator
