#include "bridges/epuck_emulator/register.hpp"

#include "bridges/emulation/emulator_type.hpp"
#include "bridges/epuck_emulator/body.hpp"
#include "bridges/epuck_emulator/emulator.hpp"
#include "bridges/epuck_emulator/faults.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/leds.hpp"
#include "hal/robot/epuck2.hpp"

namespace tandem::bridges::epuck_emulator {
namespace {

const EmulatorType kType{.name = "epuck",
                         .kind = hal::epuck::kName,
                         .summary = "An e-puck's stock firmware: pty:NAME, serial:DEVICE@115200, tcp-listen:PORT.",
                         .puppet = "<puppet library=\"puppet\" …>",
                         .needs = &port_types_of<hal::FrontLed, hal::Microphones>,
                         .ports = &body_ports,
                         .faults = [] { return kFaults.manual(); },
                         .read = &read_options<Options>,
                         .run = &run_emulator<Options, PortBody, run>};

const EmulatorType kType2{.name = "epuck2",
                          .kind = hal::epuck2::kName,
                          .summary = "An e-puck2: as an e-puck, or its radio with epuck-tcp-listen:PORT.",
                          .puppet = "<puppet library=\"puppet\" …>",
                          .needs = &port_types_of<hal::FrontLed, hal::Microphones>,
                          .ports = &body_ports,
                          .faults = [] { return kFaults.manual(); },
                          .read = &read_options<Epuck2Options>,
                          .run = &run_emulator<Epuck2Options, PortBody, run>};

}  // namespace

void register_emulator(hal::Registrar& registrar) {
  registrar.add(kType);
  registrar.add(kType2);
}

}  // namespace tandem::bridges::epuck_emulator
