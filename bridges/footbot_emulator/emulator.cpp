#include "bridges/footbot_emulator/emulator.hpp"

#include <algorithm>
#include <memory>

#include "bridges/footbot_emulator/faults.hpp"
#include "bridges/footbot_emulator/host_side.hpp"
#include "bridges/footbot_emulator/register.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::bridges::footbot_emulator {
namespace {

using hal::TimeNs;

constexpr TimeNs kMostBacklogNs = 20 * hal::kNsPerMs;  // on the bus; then the host waits

hal::Result<Protocol> protocol_of(const std::string& firmware) {
  if (firmware == "v4") return Protocol::V4;
  if (firmware == "v5") return Protocol::V5;
  return hal::Error{"a foot-bot has no firmware '" + firmware + "'; there are v4 and v5, after the protocol's version"};
}

class FootbotServer final
    : public ItemServer<Footbot, FaultPlan, KinematicBody, TimedFrame, Frame, &TimedFrame::frame> {
 public:
  FootbotServer(const Options& options, const EventSink& events, FaultPlan faults, Protocol protocol)
      : ItemServer(options, events, std::move(faults), {.protocol = protocol, .delays = options.delays},
                   "foot-bot (" + options.firmware + ")"),
        options_(options) {}

 private:
  hal::Result<std::unique_ptr<HostSide>> open_line(const std::string& link) override {
    return open_host_side(link, tell_);
  }
  EventFields start_fields() const override {
    return {{"firmware", options_.firmware}, {"link", options_.link}, {"path", line_->path()}, {"seed", options_.seed}};
  }
  void apply_fault(const FaultPlan::Change& change) override;
  TimeNs passed_at(const Frame& frame, TimeNs now) override {
    return bus_free_at_ = std::max(bus_free_at_, now) + duration_ns(frame);
  }
  TimeNs full_until() const override { return bus_free_at_ - kMostBacklogNs; }
  EventFields last_command() const override {
    return {{"left", robot_.module(Place::LeftMotor).words("speed")[0]},
            {"right", robot_.module(Place::RightMotor).words("speed")[0]},
            {"wheels_commanded_t_ns", robot_.wheels_commanded_at().value_or(0)}};
  }

  const Options& options_;
  TimeNs bus_free_at_ = 0;  // when the last frame of the host has passed
};

void FootbotServer::apply_fault(const FaultPlan::Change& change) {
  const Fault& fault = *change.fault;
  apply(change, robot_);
  if (!has_own_body_) return;
  if (fault.kind == FaultKind::Carry) own_body_.carry(change.at, fault.carried[0], fault.carried[1], fault.carried[2]);
  if (fault.kind == FaultKind::Held) own_body_.hold(change.at, change.begins);
}

}  // namespace

hal::Status run(const Options& options, const std::atomic<bool>& stop) {
  const auto protocol = protocol_of(options.firmware);
  if (!protocol.ok()) return protocol.error();
  return serve_with(options, kFaults, stop, [&](const EventSink& events, std::vector<Fault> faults) {
    return FootbotServer(options, events, FaultPlan(std::move(faults), options.seed), protocol.value());
  });
}

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
