#include "bridges/epuck_emulator/emulator.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <poll.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include "bridges/emulation/serial_port.hpp"
#include "bridges/emulation/serving.hpp"
#include "bridges/emulation/tcp_port.hpp"
#include "bridges/epuck_emulator/faults.hpp"
#include "bridges/epuck_emulator/radio.hpp"

namespace tandem::bridges::epuck_emulator {
namespace {

using hal::TimeNs;

constexpr TimeNs kBatchNs = hal::kNsPerMs;  // bytes of one burst are handed over this often, as a serial adapter does
constexpr TimeNs kNoiseNs = 5 * hal::kNsPerMs;  // a garbled line is not quiet either
constexpr std::size_t kQueueBytes = 4096;       // the host's driver holds as much
constexpr unsigned long kRobotBaud = 115200;
constexpr const char* kName = "an emulated e-puck";
constexpr std::string_view kTcp = "tcp-listen:", kRadio = "epuck-tcp-listen:";

hal::Result<std::unique_ptr<HostLine>> open_line(const std::string& link) {
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

/// Wakes poll() at an absolute time.
class AlarmClock {
 public:
  AlarmClock() : descriptor_(timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC)) {}
  ~AlarmClock() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  AlarmClock(const AlarmClock&) = delete;
  AlarmClock& operator=(const AlarmClock&) = delete;

  bool works() const noexcept { return descriptor_ >= 0; }
  int descriptor() const noexcept { return descriptor_; }
  void set(TimeNs at) const {
    at = std::max<TimeNs>(at, 1);  // 0 would switch it off
    itimerspec setting{};
    setting.it_value.tv_sec = static_cast<time_t>(at / hal::kNsPerSecond);
    setting.it_value.tv_nsec = static_cast<long>(at % hal::kNsPerSecond);
    timerfd_settime(descriptor_, TFD_TIMER_ABSTIME, &setting, nullptr);
  }

 private:
  int descriptor_;
};

/// A wire: bytes in the order of the times at which they are through.
using Wire = std::deque<SentByte>;

/// When it is worth waking up for `wire`: with its last byte, or a batch after its first.
std::optional<TimeNs> batch_at(const Wire& wire) {
  if (wire.empty()) return std::nullopt;
  return std::max(wire.front().at, std::min(wire.back().at, wire.front().at + kBatchNs));
}

class Server {
 public:
  Server(const Options& options, std::unique_ptr<HostLine> port, const EventSink& events, FaultPlan faults,
         EmulatedBody& body, KinematicBody* own_body, Firmware::Options robot)
      : options_(options),
        port_(std::move(port)),
        tell_(in_order(events)),
        faults_(std::move(faults)),
        firmware_(robot, body, tell_),
        to_robot_delay_ns_(delay_ns(robot.delays.to_robot_s)),
        to_host_delay_ns_(delay_ns(robot.delays.to_host_s)),
        link_(port_->link()),
        path_(port_->path()),
        own_body_(own_body),
        poses_(options.poses.poses_hz) {
    if (options_.link.starts_with(kRadio)) radio_.emplace(firmware_);
  }

  hal::Status serve(const std::atomic<bool>& stop);

 private:
  hal::Status turn(TimeNs now);
  hal::Status apply_faults(TimeNs now);
  hal::Status take_in(TimeNs now);
  void greet_host(TimeNs now);
  void run_robot(TimeNs now);
  void give_out(TimeNs now);
  void make_noise(TimeNs now);
  void tell_pose(TimeNs now);
  bool same_baud(TimeNs now);
  TimeNs next_wake(TimeNs now) const;
  hal::Status wait_until(TimeNs due) const;

  const Options& options_;
  std::unique_ptr<HostLine> port_;  // none while hung up
  EventSink tell_;
  FaultPlan faults_;
  Firmware firmware_;
  TimeNs to_robot_delay_ns_, to_host_delay_ns_;
  std::string link_, path_;
  std::optional<Radio> radio_;
  std::uint64_t hosts_ = 0;  // of the radio
  AlarmClock alarm_;
  Wire to_robot_;
  Wire to_host_;
  TimeNs line_free_at_ = 0;  // when the last byte from the host is through
  TimeNs next_noise_ = 0;
  unsigned long host_baud_ = kRobotBaud;
  std::vector<SentByte> sent_;
  KinematicBody* own_body_;  // null: it lives in another
  PoseTeller poses_;
};

hal::Status Server::serve(const std::atomic<bool>& stop) {
  if (!alarm_.works()) return hal::Error{std::string("cannot make a timer: ") + std::strerror(errno)};
  const TimeNs start = monotonic_ns();
  faults_.begin(start);
  tell_(start, "start",
        {{"firmware", facts_of(firmware_.options().variant).name},
         {"link", options_.link},
         {"path", port_->path()},
         {"device", port_->device()},
         {"seed", options_.seed}});
  firmware_.power_on(start);
  options_.log.info("e-puck (" + options_.firmware + ") on " + path_);
  if (options_.ready) options_.ready(path_);
  const hal::Status served = turn_until(
      stop, tell_, [this](TimeNs now) { return turn(now); }, [this](TimeNs now) { return next_wake(now); },
      [this](TimeNs wake, TimeNs) { return wait_until(wake); });
  const TimeNs end = monotonic_ns();
  if (served.ok()) firmware_.run_until(end);
  tell_(end, "end", {{"why", served.ok() ? "stopped" : served.error().message}});
  return served;
}

hal::Status Server::turn(TimeNs now) {
  if (const hal::Status status = apply_faults(now); !status.ok()) return status;
  if (const hal::Status status = take_in(now); !status.ok()) return status;
  run_robot(now);
  tell_pose(now);
  make_noise(now);
  give_out(now);
  return {};
}

hal::Status Server::apply_faults(TimeNs now) {
  return apply_changes(faults_, now, tell_, [this](const FaultPlan::Change& change) -> hal::Status {
    const FaultKind kind = change.fault->kind;
    if (kind == FaultKind::Reset) firmware_.reset(change.at, "fault");
    if (kind == FaultKind::Truncate) radio_ ? radio_->cut_next_answer() : firmware_.cut_next_answer();
    if (kind == FaultKind::Garbage && change.begins) next_noise_ = change.at;
    if (kind != FaultKind::Hangup) return {};
    to_robot_.clear();
    to_host_.clear();
    port_.reset();
    if (change.begins) return {};
    auto again = open_line(link_);
    if (!again.ok()) return again.error();
    port_ = std::move(again).value();
    return {};
  });
}

// Reads no more than the host's driver would let go: a byte each 87 microseconds gets through.
hal::Status Server::take_in(TimeNs now) {
  if (!port_ || to_robot_.size() >= kQueueBytes) return {};
  std::array<std::uint8_t, kQueueBytes> buffer{};
  const auto count = port_->read(std::span(buffer).first(kQueueBytes - to_robot_.size()));
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

void Server::greet_host(TimeNs now) {
  const auto* const tcp = dynamic_cast<const TcpPort*>(port_.get());
  if (tcp == nullptr || tcp->hosts() == hosts_) return;
  hosts_ = tcp->hosts();
  to_robot_.clear();
  to_host_.clear();
  if (radio_) radio_->new_host();
  tell_(now, "host", {{"connected", true}, {"hosts", hosts_}});
}

void Server::run_robot(TimeNs now) {
  while (!to_robot_.empty() && to_robot_.front().at <= now) {
    const SentByte next = to_robot_.front();
    to_robot_.pop_front();
    const auto byte = faults_.to_robot(next.byte, next.at);
    if (!byte) continue;
    for (int times = faults_.doubles(next.at) ? 2 : 1; times > 0; --times)
      radio_ ? radio_->receive(*byte, next.at) : firmware_.receive(*byte, next.at);
  }
  radio_ ? radio_->run_until(now) : firmware_.run_until(now);
  if (const auto at = firmware_.first_driven_at()) faults_.driven(*at, now);
  sent_.clear();
  radio_ ? radio_->take_sent(now, sent_) : firmware_.take_sent(now, sent_);
  for (const SentByte& s : sent_) {
    const auto byte = faults_.to_host(s.byte, s.at);
    if (!byte || !port_) continue;
    const TimeNs at = s.at + to_host_delay_ns_ + faults_.delay_ns(s.at);
    const SentByte sent{*byte, to_host_.empty() ? at : std::max(at, to_host_.back().at)};
    to_host_.push_back(sent);
    if (faults_.doubles(s.at)) to_host_.push_back(sent);
  }
}

void Server::tell_pose(TimeNs now) {
  const auto pose_at = [this](TimeNs at) -> std::optional<BodyPose> {
    if (own_body_ == nullptr) return options_.pose_elsewhere ? options_.pose_elsewhere() : std::nullopt;
    own_body_->advance(at);
    BodyPose pose = own_body_->pose();
    pose.taken_ns = at;
    return pose;
  };
  poses_.turn(now, pose_at, tell_);
}

void Server::make_noise(TimeNs now) {
  for (; next_noise_ <= now && faults_.active(FaultKind::Garbage, next_noise_); next_noise_ += kNoiseNs) {
    const auto byte = faults_.to_host(0, next_noise_);
    if (byte && port_) to_host_.push_back({*byte, now});
  }
}

void Server::give_out(TimeNs now) {
  std::vector<std::uint8_t> due;
  while (!to_host_.empty() && to_host_.front().at <= now) {
    due.push_back(to_host_.front().byte);
    to_host_.pop_front();
  }
  if (due.empty() || !port_) return;
  if (!same_baud(now)) {
    for (std::uint8_t& byte : due) byte = faults_.garble(byte);
  }
  const std::size_t gone = port_->write(due);
  if (gone < due.size()) tell_(now, "overflow", {{"buffer", "host"}, {"bytes", due.size() - gone}});
}

bool Server::same_baud(TimeNs now) {
  const unsigned long baud = port_->host_baud();
  if (baud != host_baud_) tell_(now, "baud", {{"host", baud}, {"robot", kRobotBaud}});
  host_baud_ = baud;
  return baud == kRobotBaud;
}

TimeNs Server::next_wake(TimeNs now) const {
  TimeNs wake = now + kStopNs;
  const auto consider = [&wake](const std::optional<TimeNs>& at) {
    if (at) wake = std::min(wake, *at);
  };
  consider(batch_at(to_robot_));
  consider(batch_at(to_host_));
  consider(faults_.next_change_at());
  consider(poses_.due());
  consider(radio_ ? radio_->next_event(kBatchNs) : firmware_.next_event(kBatchNs));
  if (faults_.active(FaultKind::Garbage, now)) consider(next_noise_);
  return wake;
}

hal::Status Server::wait_until(TimeNs due) const {
  alarm_.set(due);
  std::array<pollfd, 2> waits{{{alarm_.descriptor(), POLLIN, 0}, {port_ ? port_->descriptor() : -1, POLLIN, 0}}};
  if (to_robot_.size() >= kQueueBytes) waits[1].fd = -1;
  const int woken = ::poll(waits.data(), waits.size(), -1);  // a signal wakes it too
  // A host that hung up shows in reading; another one may come.
  const bool network = dynamic_cast<const TcpPort*>(port_.get()) != nullptr;
  const bool gone = !network && woken > 0 && (waits[1].revents & (POLLHUP | POLLERR | POLLNVAL)) != 0;
  if (gone) return hal::Error{"the serial line '" + port_->path() + "' has gone; was its cable pulled?"};
  return {};
}

}  // namespace

hal::Status run(const Options& options, const std::atomic<bool>& stop) {
  const auto variant = variant_from(options.firmware);
  if (!variant.ok()) return variant.error();
  auto faults = read_faults(options.faults, &parse_fault);
  if (!faults.ok()) return faults.error();
  auto events = open_event_sink(options.log_file, options.events);
  if (!events.ok()) return events.error();
  if (options.link.starts_with(kRadio) && variant.value() != Variant::Epuck2)
    return hal::Error{"only an e-puck2 has a radio of its own: write --firmware epuck2, or a link " +
                      std::string(kTcp) + "PORT"};
  auto port = open_line(options.link);
  if (!port.ok()) return port.error();

  KinematicBody own_body(options.poses.start, options.arena, options.wheels);
  EmulatedBody& body = options.body != nullptr ? *options.body : own_body;
  Firmware::Options robot = options.robot;
  robot.variant = variant.value();
  Server server(options, std::move(port).value(), events.value(), FaultPlan(std::move(faults).value(), options.seed),
                body, options.body == nullptr ? &own_body : nullptr, robot);
  return server.serve(stop);
}

}  // namespace tandem::bridges::epuck_emulator
