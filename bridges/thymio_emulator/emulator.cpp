#include "bridges/thymio_emulator/emulator.hpp"

#include <memory>

#include "bridges/aseba_emulation/host_line.hpp"
#include "bridges/thymio_emulator/faults.hpp"
#include "bridges/thymio_emulator/register.hpp"
#include "hal/device/wheels.hpp"
#include "hal/robot/thymio.hpp"

namespace tandem::bridges::thymio_emulator {
namespace {

class ThymioServer final
    : public ItemServer<Thymio, FaultPlan, KinematicBody, TimedMessage, Message, &TimedMessage::message> {
 public:
  ThymioServer(const Options& options, const EventSink& events, FaultPlan faults)
      : ItemServer(options, events, std::move(faults),
                   {.node = static_cast<std::uint8_t>(options.node), .delays = options.delays}, "Thymio"),
        options_(options) {}

 private:
  hal::Result<std::unique_ptr<aseba_emulation::HostLine>> open_line(const std::string& link) override {
    return aseba_emulation::open_host_line(link, "an emulated Thymio", kBaud, tell_);
  }
  EventFields start_fields() const override {
    return {{"link", options_.link}, {"path", line_->path()}, {"seed", options_.seed}};
  }
  void apply_fault(const FaultPlan::Change& change) override { apply(change, robot_); }
  EventFields last_command() const override {
    return {{"left", robot_.left_target()},
            {"right", robot_.right_target()},
            {"wheels_commanded_t_ns", robot_.wheels_commanded_at().value_or(0)}};
  }

  const Options& options_;
};

}  // namespace

hal::Status run(const Options& options, const std::atomic<bool>& stop) {
  if (options.node < 1 || options.node > 255) {
    return hal::Error{"a node has a number from 1 to 255, not " + std::to_string(options.node)};
  }
  return serve_with(options, kFaults, stop, [&](const EventSink& events, std::vector<Fault> faults) {
    return ThymioServer(options, events, FaultPlan(std::move(faults), options.seed));
  });
}

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
