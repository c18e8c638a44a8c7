#include "bridges/thymio_emulator/register.hpp"

#include <optional>

#include "bridges/emulation/emulator_type.hpp"
#include "bridges/thymio_emulator/emulator.hpp"
#include "bridges/thymio_emulator/port_body.hpp"
#include "hal/device/wheels.hpp"
#include "hal/robot/thymio.hpp"

namespace tandem::bridges::thymio_emulator {
namespace {

struct Own {
  std::int64_t node = 1;
  PoseOptions poses{};
  WheelErrors wheels{};
  Delays delays{};
  void describe(hal::ParamVisitor& v) {
    v.integer("node", node, {1, 255}, "Its number, where several share a switch.");
    poses.describe(v);
    wheels.describe(v);
    delays.describe(v);
  }
};

/// How a host reaches the Thymio that is shown at `path`.
std::string host_link(const std::string& path) {
  return path.starts_with("tcp:") ? path : "serial:" + path + "@" + std::to_string(kBaud);
}

hal::Status run_type(const EmulatorRequest& request, SharedPorts* ports, const std::atomic<bool>& stop) {
  Options options;
  apply(request, options);
  if (request.options != nullptr) {
    const Own& own = *static_cast<const Own*>(request.options.get());
    options.node = own.node;
    options.poses = own.poses;
    options.wheels = own.wheels;
    options.delays = own.delays;
  }
  options.ready = [&request](const std::string& path) {
    if (request.ready) request.ready("Thymio on " + path + ": connect with --link " + host_link(path));
  };
  std::optional<PortBody> body;
  if (ports != nullptr) {
    options.body = &body.emplace(*ports);
    options.delays.body_s = options.wheels.delay_s;
    options.pose_elsewhere = [ports] { return ports->pose(); };
  }
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
                         .read = &read_options<Own>,
                         .run = &run_type};

}  // namespace

void register_emulator(hal::Registrar& registrar) {
  registrar.add(kType);
}

}  // namespace tandem::bridges::thymio_emulator
