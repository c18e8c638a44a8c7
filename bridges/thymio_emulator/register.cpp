#include "bridges/thymio_emulator/register.hpp"

#include <optional>

#include "bridges/emulation/emulator_type.hpp"
#include "bridges/thymio_emulator/body.hpp"
#include "bridges/thymio_emulator/emulator.hpp"
#include "bridges/thymio_emulator/faults.hpp"
#include "hal/device/wheels.hpp"
#include "hal/robot/thymio.hpp"

namespace tandem::bridges::thymio_emulator {
namespace {

struct Own : WheeledParams {
  std::int64_t node = 1;
  void describe(hal::ParamVisitor& v) {
    v.integer("node", node, {1, 255}, "Its number, where several share a switch.");
    WheeledParams::describe(v);
  }
};

/// How a host reaches the Thymio that is shown at `path`.
std::string host_link(const std::string& path) {
  return path.starts_with("tcp:") ? path : "serial:" + path + "@" + std::to_string(kBaud);
}

hal::Status run_type(const EmulatorRequest& request, SharedPorts* ports, const std::atomic<bool>& stop) {
  const Own own = request.options == nullptr ? Own{} : *static_cast<const Own*>(request.options.get());
  Options options;
  options.node = own.node;
  std::optional<PortBody> body;
  apply(request, own, ports, body, options);
  options.ready = [&request](const std::string& path) {
    if (request.ready) request.ready("Thymio on " + path + ": connect with --link " + host_link(path));
  };
  return run(options, stop);
}

const EmulatorType kType{.name = "thymio",
                         .kind = hal::thymio::kName,
                         .summary =
                             "A Thymio II, as USB or ASEBA's switch shows it: pty:NAME, serial:DEVICE, "
                             "tcp-listen:PORT.",
                         .puppet = "<thymio_puppet library=\"puppet\" …>",
                         .needs = &port_types_of<hal::WheelSpeeds>,
                         .ports = &body_ports,
                         .faults = [] { return kFaults.manual(); },
                         .read = &read_options<Own>,
                         .run = &run_type};

}  // namespace

void register_emulator(hal::Registrar& registrar) {
  registrar.add(kType);
}

}  // namespace tandem::bridges::thymio_emulator
