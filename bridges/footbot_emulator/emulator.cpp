#include "bridges/footbot_emulator/emulator.hpp"

#include <algorithm>
#include <deque>

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

class FootbotServer final : public WheeledServer<Footbot, FaultPlan, KinematicBody> {
 public:
  FootbotServer(const Options& options, const EventSink& events, FaultPlan faults, Protocol protocol)
      : WheeledServer(options, events, std::move(faults), {.protocol = protocol, .delays = options.delays}),
        options_(options) {}

 private:
  hal::Status open() override;
  void close() override;
  void power_on(TimeNs start) override;
  void apply_fault(const FaultPlan::Change& change) override;
  hal::Status take_in(TimeNs now) override;
  void give_out(TimeNs now) override;
  TimeNs next_arrival(TimeNs now) const override;
  void add_polls(TimeNs now, std::vector<pollfd>& polls) const override {
    if (side_ && !is_full(now)) side_->add_polls(polls);
  }
  EventFields last_command() const override;
  bool is_full(TimeNs now) const noexcept { return bus_free_at_ > now + kMostBacklogNs; }

  const Options& options_;
  std::unique_ptr<HostSide> side_;  // none while hung up
  TimeNs bus_free_at_ = 0;          // when the last frame of the host has passed
  std::deque<TimedFrame> to_robot_, to_host_;
};

hal::Status FootbotServer::open() {
  auto side = open_host_side(link_, tell_);
  if (!side.ok()) return side.error();
  side_ = std::move(side).value();
  if (link_.starts_with("tcp-listen:") && link_.ends_with(":0")) {
    link_ = link_.substr(0, link_.size() - 1) + side_->path().substr(side_->path().rfind(':') + 1);
  }
  return {};
}

void FootbotServer::close() {
  to_robot_.clear();
  to_host_.clear();
  side_.reset();
}

void FootbotServer::power_on(TimeNs start) {
  tell_(start, "start",
        {{"firmware", options_.firmware}, {"link", options_.link}, {"path", side_->path()}, {"seed", options_.seed}});
  robot_.power_on(start);
  options_.log.info("foot-bot (" + options_.firmware + ") on " + side_->path());
  if (options_.ready) options_.ready(side_->path());
}

EventFields FootbotServer::last_command() const {
  return {{"left", robot_.module(Place::LeftMotor).words("speed")[0]},
          {"right", robot_.module(Place::RightMotor).words("speed")[0]},
          {"wheels_commanded_t_ns", robot_.wheels_commanded_at().value_or(0)}};
}

void FootbotServer::apply_fault(const FaultPlan::Change& change) {
  const Fault& fault = *change.fault;
  apply(change, robot_);
  if (!has_own_body_) return;
  if (fault.kind == FaultKind::Carry) own_body_.carry(change.at, fault.carried[0], fault.carried[1], fault.carried[2]);
  if (fault.kind == FaultKind::Held) own_body_.hold(change.at, change.begins);
}

hal::Status FootbotServer::take_in(TimeNs now) {
  std::vector<Frame> from_host;
  if (side_ && !is_full(now)) {
    if (const hal::Status status = side_->take(now, from_host); !status.ok()) return status;
  }
  for (const Frame& frame : from_host) {
    bus_free_at_ = std::max(bus_free_at_, now) + duration_ns(frame);
    if (faults_.reaches_robot(bus_free_at_)) to_robot_.push_back({frame, bus_free_at_ + to_robot_delay_ns_});
  }
  take_due(to_robot_, now, [this](const TimedFrame& f) { robot_.receive(f.frame, f.at); });
  return {};
}

void FootbotServer::give_out(TimeNs now) {
  std::vector<TimedFrame> sent, arriving;
  robot_.take_sent(sent);
  for (const TimedFrame& frame : sent) faults_.to_host(frame, arriving);
  if (!side_) return;
  for (const TimedFrame& f : arriving) to_host_.push_back({f.frame, f.at + to_host_delay_ns_});
  take_due(to_host_, now, [this](const TimedFrame& f) { side_->show(f.frame, f.at); });
  side_->flush(now);
}

TimeNs FootbotServer::next_arrival(TimeNs now) const {
  const TimeNs next = robot_.next_event();
  return std::min(
      {next, first_at(to_robot_, next), first_at(to_host_, next), is_full(now) ? bus_free_at_ - kMostBacklogNs : next});
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
