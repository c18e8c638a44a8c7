#include "bridges/footbot_emulator/register.hpp"

#include "bridges/emulation/emulator_type.hpp"
#include "bridges/footbot_emulator/body.hpp"
#include "bridges/footbot_emulator/emulator.hpp"
#include "bridges/footbot_emulator/faults.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::bridges::footbot_emulator {
namespace {

const EmulatorType kType{
    .name = "footbot",
    .kind = hal::footbot::kName,
    .summary = "A foot-bot's modules behind a CAN adapter or its switch: pty:NAME, can:INTERFACE, tcp-listen:PORT.",
    .puppet = "<footbot_puppet library=\"puppet\" …>",
    .needs = &port_types_of<hal::WheelSpeeds>,
    .ports = &body_ports,
    .faults = [] { return kFaults.manual(); },
    .read = &read_options<Options>,
    .run = &run_emulator<Options, PortBody, run>};

}  // namespace

void register_emulator(hal::Registrar& registrar) {
  registrar.add(kType);
}

}  // namespace tandem::bridges::footbot_emulator
