#include "bridges/eyebot_emulator/register.hpp"

#include "bridges/emulation/emulator_type.hpp"
#include "bridges/eyebot_emulator/body.hpp"
#include "bridges/eyebot_emulator/emulator.hpp"
#include "bridges/eyebot_emulator/faults.hpp"
#include "hal/device/flight.hpp"

namespace tandem::bridges::eyebot_emulator {
namespace {

const EmulatorType kType{
    .name = "eyebot",
    .kind = hal::eyebot::kName,
    .summary = "Eye-bots on a network: lcm:udpm://GROUP:PORT?ttl=0.",
    .puppet = "<eyebot_puppet library=\"puppet\" …> with flight_task, quadrotor_speed, flight_state and positioning",
    .needs = &port_types_of<hal::FlightTask, hal::QuadrotorSpeed, hal::FlightState, hal::Positioning>,
    .ports = &body_ports,
    .faults = [] { return kFaults.manual(); },
    .read = &read_options<Options>,
    .run = &run_emulator<Options, PortBody, run>};

}  // namespace

void register_emulator(hal::Registrar& registrar) {
  registrar.add(kType);
}

}  // namespace tandem::bridges::eyebot_emulator
