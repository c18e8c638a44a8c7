#include "bridges/epuck_emulator/emulator.hpp"

#include <algorithm>
#include <deque>
#include <memory>

#include "bridges/emulation/serial_port.hpp"
#include "bridges/emulation/tcp_port.hpp"
#include "bridges/epuck_emulator/faults.hpp"
#include "bridges/epuck_emulator/radio.hpp"
#include "bridges/epuck_emulator/register.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/leds.hpp"
#include "hal/robot/epuck2.hpp"

namespace tandem::bridges::epuck_emulator {
namespace {

using hal::TimeNs;

constexpr TimeNs kBatchNs = hal::kNsPerMs;  // bytes of one burst are handed over this often, as a serial adapter does
constexpr TimeNs kNoiseNs = 5 * hal::kNsPerMs;  // a garbled line is not quiet either
constexpr std::size_t kQueueBytes = 4096;       // the host's driver holds as much
constexpr unsigned long kRobotBaud = 115200;
constexpr const char* kName = "an emulated e-puck";
constexpr std::string_view kTcp = "tcp-listen:", kRadio = "epuck-tcp-listen:";

/// A wire: bytes in the order of the times at which they are through.
using Wire = std::deque<SentByte>;

/// When it is worth waking up for `wire`: with its last byte, or a batch after its first.
std::optional<TimeNs> batch_at(const Wire& wire) {
  if (wire.empty()) return std::nullopt;
  return std::max(wire.front().at, std::min(wire.back().at, wire.front().at + kBatchNs));
}

class EpuckServer final : public WheeledServer<Firmware, FaultPlan, KinematicBody, HostLine> {
 public:
  EpuckServer(const Options& options, const EventSink& events, FaultPlan faults, const Firmware::Options& robot)
      : WheeledServer(options, events, std::move(faults), robot, "e-puck (" + options.firmware + ")"),
        options_(options) {
    if (options.link.starts_with(kRadio)) radio_.emplace(robot_);
  }

 private:
  hal::Result<std::unique_ptr<HostLine>> open_line(const std::string& link) override;
  void forget() override {
    to_robot_.clear();
    to_host_.clear();
  }
  EventFields start_fields() const override {
    return {{"firmware", facts_of(robot_.options().variant).name},
            {"link", options_.link},
            {"path", line_->path()},
            {"device", line_->device()},
            {"seed", options_.seed}};
  }
  void apply_fault(const FaultPlan::Change& change) override;
  hal::Status take_in(TimeNs now) override;
  void give_out(TimeNs now) override;
  TimeNs next_arrival(TimeNs now) const override;
  void add_polls(TimeNs now, std::vector<pollfd>& polls) const override;
  hal::Status polled(const std::vector<pollfd>& polls) const override;
  EventFields last_command() const override { return {}; }

  hal::Status read_line(TimeNs now);
  void greet_host(TimeNs now);
  void run_robot(TimeNs now);
  void take_sent(TimeNs now);
  void make_noise(TimeNs now);
  void write_line(TimeNs now);
  bool same_baud(TimeNs now);

  const Options& options_;
  std::optional<Radio> radio_;
  std::uint64_t hosts_ = 0;  // of the radio
  Wire to_robot_, to_host_;
  TimeNs line_free_at_ = 0;  // when the last byte from the host is through
  TimeNs next_noise_ = 0;
  unsigned long host_baud_ = kRobotBaud;
  std::vector<SentByte> sent_;
};

hal::Result<std::unique_ptr<HostLine>> EpuckServer::open_line(const std::string& link) {
  const auto tcp = [&link](std::string_view scheme, std::string_view host) -> hal::Result<std::unique_ptr<HostLine>> {
    auto port = TcpPort::open(scheme.substr(0, scheme.size() - 1), host, link.substr(scheme.size()), kRobotBaud);
    if (!port.ok()) return port.error();
    return std::unique_ptr<HostLine>(std::move(port).value());
  };
  if (link.starts_with(kRadio)) return tcp(kRadio, "epuck-tcp");
  if (link.starts_with(kTcp)) return tcp(kTcp, "tcp");
  auto port = SerialPort::open(link, kName, kRobotBaud);
  if (!port.ok())
    return hal::Error{port.error().message + "; or " + std::string(kTcp) + "PORT, " + std::string(kRadio) + "PORT"};
  return std::unique_ptr<HostLine>(std::move(port).value());
}

void EpuckServer::apply_fault(const FaultPlan::Change& change) {
  const FaultKind kind = change.fault->kind;
  if (kind == FaultKind::Reset) robot_.reset(change.at, "fault");
  if (kind == FaultKind::Truncate) radio_ ? radio_->cut_next_answer() : robot_.cut_next_answer();
  if (kind == FaultKind::Garbage && change.begins) next_noise_ = change.at;
}

hal::Status EpuckServer::take_in(TimeNs now) {
  const hal::Status read = read_line(now);
  if (read.ok()) run_robot(now);
  return read;
}

void EpuckServer::give_out(TimeNs now) {
  take_sent(now);
  make_noise(now);
  write_line(now);
}

// Reads no more than the host's driver would let go: a byte each 87 microseconds gets through.
hal::Status EpuckServer::read_line(TimeNs now) {
  if (!line_ || to_robot_.size() >= kQueueBytes) return {};
  std::array<std::uint8_t, kQueueBytes> buffer{};
  const auto count = line_->read(std::span(buffer).first(kQueueBytes - to_robot_.size()));
  if (!count.ok()) return count.error();
  greet_host(now);
  if (count.value() == 0) return {};
  const bool clear = same_baud(now);
  for (std::size_t i = 0; i < count.value(); ++i) {
    line_free_at_ = std::max(line_free_at_, now) + (radio_ ? 0 : kByteNs);
    to_robot_.push_back({clear ? buffer[i] : faults_.garble(buffer[i]), line_free_at_ + to_robot_delay_ns_});
  }
  return {};
}

void EpuckServer::greet_host(TimeNs now) {
  const auto* const tcp = dynamic_cast<const TcpPort*>(line_.get());
  if (tcp == nullptr || tcp->hosts() == hosts_) return;
  hosts_ = tcp->hosts();
  to_robot_.clear();
  to_host_.clear();
  if (radio_) radio_->new_host();
  tell_(now, "host", {{"connected", true}, {"hosts", hosts_}});
}

void EpuckServer::run_robot(TimeNs now) {
  take_due(to_robot_, now, [this](const SentByte& next) {
    const auto byte = faults_.to_robot(next.byte, next.at);
    for (int times = !byte ? 0 : faults_.doubles(next.at) ? 2 : 1; times > 0; --times)
      radio_ ? radio_->receive(*byte, next.at) : robot_.receive(*byte, next.at);
  });
  radio_ ? radio_->run_until(now) : robot_.run_until(now);
}

void EpuckServer::take_sent(TimeNs now) {
  sent_.clear();
  radio_ ? radio_->take_sent(now, sent_) : robot_.take_sent(now, sent_);
  for (const SentByte& s : sent_) {
    const auto byte = faults_.to_host(s.byte, s.at);
    if (!byte || !line_) continue;
    const TimeNs at = s.at + to_host_delay_ns_ + faults_.delay_ns(s.at);
    const SentByte sent{*byte, to_host_.empty() ? at : std::max(at, to_host_.back().at)};
    to_host_.push_back(sent);
    if (faults_.doubles(s.at)) to_host_.push_back(sent);
  }
}

void EpuckServer::make_noise(TimeNs now) {
  for (; next_noise_ <= now && faults_.active(FaultKind::Garbage, next_noise_); next_noise_ += kNoiseNs) {
    const auto byte = faults_.to_host(0, next_noise_);
    if (byte && line_) to_host_.push_back({*byte, now});
  }
}

void EpuckServer::write_line(TimeNs now) {
  std::vector<std::uint8_t> due;
  take_due(to_host_, now, [&due](const SentByte& sent) { due.push_back(sent.byte); });
  if (due.empty() || !line_) return;
  if (!same_baud(now)) {
    for (std::uint8_t& byte : due) byte = faults_.garble(byte);
  }
  const std::size_t gone = line_->write(due);
  if (gone < due.size()) tell_(now, "overflow", {{"buffer", "host"}, {"bytes", due.size() - gone}});
}

bool EpuckServer::same_baud(TimeNs now) {
  const unsigned long baud = line_->host_baud();
  if (baud != host_baud_) tell_(now, "baud", {{"host", baud}, {"robot", kRobotBaud}});
  host_baud_ = baud;
  return baud == kRobotBaud;
}

TimeNs EpuckServer::next_arrival(TimeNs now) const {
  TimeNs next = now + kStopNs;
  for (const auto& at :
       {batch_at(to_robot_), batch_at(to_host_), radio_ ? radio_->next_event(kBatchNs) : robot_.next_event(kBatchNs)})
    next = std::min(next, at.value_or(next));
  return faults_.active(FaultKind::Garbage, now) ? std::min(next, next_noise_) : next;
}

void EpuckServer::add_polls(TimeNs /*now*/, std::vector<pollfd>& polls) const {
  if (line_) polls.push_back({to_robot_.size() < kQueueBytes ? line_->descriptor() : -1, POLLIN, 0});
}

// A host that hung up shows in reading; another one may come.
hal::Status EpuckServer::polled(const std::vector<pollfd>& polls) const {
  const bool network = dynamic_cast<const TcpPort*>(line_.get()) != nullptr;
  const bool gone = !network && !polls.empty() && (polls[0].revents & (POLLHUP | POLLERR | POLLNVAL)) != 0;
  if (gone) return hal::Error{"the serial line '" + line_->path() + "' has gone; was its cable pulled?"};
  return {};
}

}  // namespace

hal::Status run(const Options& options, const std::atomic<bool>& stop) {
  const auto variant = variant_from(options.firmware);
  if (!variant.ok()) return variant.error();
  if (options.link.starts_with(kRadio) && variant.value() != Variant::Epuck2)
    return hal::Error{"only an e-puck2 has a radio of its own: write --firmware epuck2, or a link " +
                      std::string(kTcp) + "PORT"};
  Firmware::Options robot = options.robot;
  robot.variant = variant.value();
  robot.delays = options.delays;
  return serve_with(options, kFaults, stop, [&](const EventSink& events, std::vector<Fault> faults) {
    return EpuckServer(options, events, FaultPlan(std::move(faults), options.seed), robot);
  });
}

namespace {

const EmulatorType kType{.name = "epuck",
                         .kind = hal::epuck::kName,
                         .summary = "An e-puck's stock firmware: pty:NAME, serial:DEVICE@115200, tcp-listen:PORT.",
                         .puppet = "<puppet library=\"puppet\" …>",
                         .needs = &port_types_of<hal::FrontLed, hal::Microphones>,
                         .ports = &body_ports,
                         .faults = [] { return kFaults.manual(); },
                         .read = &read_options<Options>,
                         .run = &run_emulator<Options, PortBody, run>};

const EmulatorType kType2{.name = "epuck2",
                          .kind = hal::epuck2::kName,
                          .summary = "An e-puck2: as an e-puck, or its radio with epuck-tcp-listen:PORT.",
                          .puppet = "<puppet library=\"puppet\" …>",
                          .needs = &port_types_of<hal::FrontLed, hal::Microphones>,
                          .ports = &body_ports,
                          .faults = [] { return kFaults.manual(); },
                          .read = &read_options<Epuck2Options>,
                          .run = &run_emulator<Epuck2Options, PortBody, run>};

}  // namespace

void register_emulator(hal::Registrar& registrar) {
  registrar.add(kType);
  registrar.add(kType2);
}

}  // namespace tandem::bridges::epuck_emulator
