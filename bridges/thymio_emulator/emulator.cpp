#include "bridges/thymio_emulator/emulator.hpp"

#include <algorithm>
#include <deque>
#include <memory>

#include "bridges/aseba_emulation/host_line.hpp"
#include "bridges/thymio_emulator/faults.hpp"
#include "bridges/thymio_emulator/register.hpp"
#include "hal/device/wheels.hpp"
#include "hal/robot/thymio.hpp"

namespace tandem::bridges::thymio_emulator {
namespace {

using hal::TimeNs;

class ThymioServer final : public WheeledServer<Thymio, FaultPlan, KinematicBody> {
 public:
  ThymioServer(const Options& options, const EventSink& events, FaultPlan faults)
      : WheeledServer(options, events, std::move(faults),
                      {.node = static_cast<std::uint8_t>(options.node), .delays = options.delays}),
        options_(options),
        to_robot_(options.delays.to_robot_s) {}

 private:
  hal::Status open() override;
  void close() override;
  void power_on(TimeNs start) override;
  void apply_fault(const FaultPlan::Change& change) override { apply(change, robot_); }
  hal::Status take_in(TimeNs now) override;
  void give_out(TimeNs now) override;
  TimeNs next_arrival(TimeNs now) const override;
  void add_polls(TimeNs /*now*/, std::vector<pollfd>& polls) const override {
    if (line_) line_->add_polls(polls);
  }
  EventFields last_command() const override;

  const Options& options_;
  DelayLine<Message> to_robot_;
  std::unique_ptr<aseba_emulation::HostLine> line_;  // none while hung up
  std::deque<TimedMessage> to_hosts_;
};

hal::Status ThymioServer::open() {
  auto line = aseba_emulation::open_host_line(link_, "an emulated Thymio", kBaud, tell_);
  if (!line.ok()) return line.error();
  line_ = std::move(line).value();
  link_ = line_->link();
  return {};
}

void ThymioServer::close() {
  to_hosts_.clear();
  to_robot_.clear();
  line_.reset();
}

void ThymioServer::power_on(TimeNs start) {
  tell_(start, "start", {{"link", options_.link}, {"path", line_->path()}, {"seed", options_.seed}});
  robot_.power_on(start);
  options_.log.info("Thymio on " + line_->path());
  if (options_.ready) options_.ready(line_->path());
}

EventFields ThymioServer::last_command() const {
  return {{"left", robot_.left_target()},
          {"right", robot_.right_target()},
          {"wheels_commanded_t_ns", robot_.wheels_commanded_at().value_or(0)}};
}

hal::Status ThymioServer::take_in(TimeNs now) {
  std::vector<Message> from_hosts;
  if (line_) {
    if (const hal::Status status = line_->take(now, from_hosts); !status.ok()) return status;
  }
  for (const Message& message : from_hosts) {
    if (faults_.reaches_robot(now)) to_robot_.put(now, message);
  }
  to_robot_.take(now, [this](TimeNs at, const Message& message) { robot_.receive(message, at); });
  return {};
}

void ThymioServer::give_out(TimeNs now) {
  std::vector<TimedMessage> sent, arriving;
  robot_.take_sent(sent);
  for (const TimedMessage& message : sent) faults_.to_host(message, arriving);
  if (!line_) return;
  for (TimedMessage& m : arriving) to_hosts_.push_back({std::move(m.message), m.at + to_host_delay_ns_});
  take_due(to_hosts_, now, [&](const TimedMessage& m) { line_->tell(m.message, now); });
  line_->flush(now);
}

TimeNs ThymioServer::next_arrival(TimeNs /*now*/) const {
  const TimeNs next = robot_.next_event();
  return std::min({next, first_at(to_hosts_, next), to_robot_.next_at().value_or(next)});
}

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
