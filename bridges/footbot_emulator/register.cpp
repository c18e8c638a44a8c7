#include "bridges/footbot_emulator/register.hpp"

#include "bridges/emulation/emulator_type.hpp"
#include "bridges/footbot_emulator/body.hpp"
#include "bridges/footbot_emulator/emulator.hpp"
#include "bridges/footbot_emulator/faults.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::bridges::footbot_emulator {
namespace {

struct Own : WheeledParams {
  std::string firmware = "v4";
  void describe(hal::ParamVisitor& v) {
    v.text("firmware", firmware, "v4 (the robots') or v5: which version of the protocol its modules speak.");
    WheeledParams::describe(v);
  }
};

/// How a host reaches the foot-bot that is shown at `path`.
std::string host_link(const std::string& path) {
  if (path.starts_with("tcp:") || path.starts_with("can:")) return path;
  return "slcan:" + path + "@1000000";
}

hal::Status run_type(const EmulatorRequest& request, SharedPorts* ports, const std::atomic<bool>& stop) {
  const Own own = request.options == nullptr ? Own{} : *static_cast<const Own*>(request.options.get());
  Options options;
  options.firmware = own.firmware;
  std::optional<PortBody> body;
  apply(request, own, ports, body, options);
  options.ready = [&request](const std::string& path) {
    if (request.ready) request.ready("foot-bot's modules on " + path + ": connect with --link " + host_link(path));
  };
  return run(options, stop);
}

const EmulatorType kType{
    .name = "footbot",
    .kind = hal::footbot::kName,
    .summary = "A foot-bot's modules behind a CAN adapter or its switch: pty:NAME, can:INTERFACE, tcp-listen:PORT.",
    .puppet = "<footbot_puppet library=\"puppet\" …>",
    .needs = &port_types_of<hal::WheelSpeeds>,
    .ports = &body_ports,
    .faults = [] { return kFaults.manual(); },
    .read = &read_options<Own>,
    .run = &run_type};

}  // namespace

void register_emulator(hal::Registrar& registrar) {
  registrar.add(kType);
}

}  // namespace tandem::bridges::footbot_emulator
