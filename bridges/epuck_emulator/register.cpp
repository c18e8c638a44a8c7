#include "bridges/epuck_emulator/register.hpp"

#include <array>

#include "bridges/emulation/emulator_type.hpp"
#include "bridges/epuck_emulator/body.hpp"
#include "bridges/epuck_emulator/emulator.hpp"
#include "bridges/epuck_emulator/faults.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/leds.hpp"
#include "hal/robot/epuck2.hpp"

namespace tandem::bridges::epuck_emulator {
namespace {

struct Own : WheeledParams {
  std::string firmware = "gctronic";
  std::int64_t selector = 3;
  bool cliff_sensors = false;
  bool ground_board = true;
  void describe(hal::ParamVisitor& v) {
    v.text("firmware", firmware, "btcom, gctronic, webots or epuck2.");
    v.integer("selector", selector, {0, 15}, "Position of the rotary switch.");
    v.flag("cliff_sensors", cliff_sensors, "The ground board has two cliff sensors.");
    v.flag("ground_board", ground_board, "It has ground sensors; else the firmware answers zeros.");
    WheeledParams::describe(v);
  }
};

struct OwnOfEpuck2 : Own {
  OwnOfEpuck2() {
    firmware = "epuck2";
    cliff_sensors = true;
  }
};

template <class OwnOptions>
hal::Status run_type(const EmulatorRequest& request, SharedPorts* ports, const std::atomic<bool>& stop) {
  const OwnOptions own =
      request.options != nullptr ? *static_cast<const OwnOptions*>(request.options.get()) : OwnOptions{};
  Options options;
  options.firmware = own.firmware;
  options.robot.selector = static_cast<std::uint8_t>(own.selector);
  options.robot.cliff_sensors = own.cliff_sensors;
  options.robot.ground_board = own.ground_board;
  std::optional<PortBody> body;
  apply(request, own, ports, body, options);
  options.ready = [&request](const std::string& path) {
    if (request.ready)
      request.ready("e-puck's firmware on " + path + ": connect with --link " +
                    (path.starts_with("tcp:") || path.starts_with("epuck-tcp:") ? path : "serial:" + path + "@115200"));
  };
  return run(options, stop);
}

const EmulatorType kType{.name = "epuck",
                         .kind = hal::epuck::kName,
                         .summary = "An e-puck's stock firmware: pty:NAME, serial:DEVICE@115200, tcp-listen:PORT.",
                         .puppet = "<puppet library=\"puppet\" …>",
                         .needs = &port_types_of<hal::FrontLed, hal::Microphones>,
                         .ports = &body_ports,
                         .faults = [] { return kFaults.manual(); },
                         .read = &read_options<Own>,
                         .run = &run_type<Own>};

const EmulatorType kType2{.name = "epuck2",
                          .kind = hal::epuck2::kName,
                          .summary = "An e-puck2: as an e-puck, or its radio with epuck-tcp-listen:PORT.",
                          .puppet = "<puppet library=\"puppet\" …>",
                          .needs = &port_types_of<hal::FrontLed, hal::Microphones>,
                          .ports = &body_ports,
                          .faults = [] { return kFaults.manual(); },
                          .read = &read_options<OwnOfEpuck2>,
                          .run = &run_type<OwnOfEpuck2>};

}  // namespace

void register_emulator(hal::Registrar& registrar) {
  registrar.add(kType);
  registrar.add(kType2);
}

}  // namespace tandem::bridges::epuck_emulator
