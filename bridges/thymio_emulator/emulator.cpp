#include "bridges/thymio_emulator/emulator.hpp"

#include <algorithm>
#include <deque>
#include <memory>
#include <poll.h>
#include <time.h>

#include "bridges/aseba_emulation/host_line.hpp"
#include "bridges/thymio_emulator/faults.hpp"

namespace tandem::bridges::thymio_emulator {
namespace {

using hal::TimeNs;

constexpr TimeNs kStopNs = 20 * hal::kNsPerMs;  // the stop flag is looked at this often

TimeNs monotonic_ns() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return static_cast<TimeNs>(t.tv_sec) * hal::kNsPerSecond + t.tv_nsec;
}

class Server {
 public:
  Server(const Options& options, std::unique_ptr<EventLog> log_file, FaultPlan faults, EmulatedBody& body)
      : options_(options),
        log_file_(std::move(log_file)),
        faults_(std::move(faults)),
        sink_([this](TimeNs at, std::string_view name, const EventFields& fields) { tell(at, name, fields); }),
        robot_({.node = static_cast<std::uint8_t>(options.node)}, body, sink_) {}

  hal::Status serve(const std::atomic<bool>& stop);

 private:
  void tell(TimeNs at, std::string_view name, const EventFields& fields);
  hal::Status open_line();
  hal::Status turn(TimeNs now);
  hal::Status apply_faults(TimeNs now);
  void show_hosts(TimeNs now);
  TimeNs next_wake(TimeNs now) const;
  void wait_until(TimeNs at, TimeNs now) const;
  void tell_end(TimeNs at, const std::string& why);

  const Options& options_;
  std::unique_ptr<EventLog> log_file_;
  FaultPlan faults_;
  EventSink sink_;
  Thymio robot_;
  std::unique_ptr<aseba_emulation::HostLine> line_;  // none while hung up
  std::string link_;                                 // what is opened again after a hang-up
  std::deque<TimedMessage> to_hosts_;
  TimeNs last_told_ = 0;
};

// Stamps in the log never go back, although the robot's are of the past by up to one turn.
void Server::tell(TimeNs at, std::string_view name, const EventFields& fields) {
  last_told_ = std::max(last_told_, at);
  if (log_file_) log_file_->write(last_told_, name, fields);
  if (options_.events) options_.events(last_told_, name, fields);
}

// A port that was chosen freely is kept: hosts come back to where they were.
hal::Status Server::open_line() {
  auto line = aseba_emulation::open_host_line(link_, "an emulated Thymio", kBaud, sink_);
  if (!line.ok()) return line.error();
  line_ = std::move(line).value();
  link_ = line_->link();
  return {};
}

hal::Status Server::serve(const std::atomic<bool>& stop) {
  link_ = options_.link;
  if (const hal::Status opened = open_line(); !opened.ok()) return opened;
  const TimeNs start = monotonic_ns();
  faults_.begin(start);
  tell(start, "start", {{"link", options_.link}, {"path", line_->path()}, {"seed", options_.seed}});
  robot_.power_on(start);
  options_.log.info("Thymio on " + line_->path());
  if (options_.ready) options_.ready(line_->path());
  while (!stop.load(std::memory_order_relaxed)) {
    const TimeNs now = monotonic_ns();
    if (const hal::Status status = turn(now); !status.ok()) {
      tell_end(monotonic_ns(), status.error().message);
      return status;
    }
    wait_until(next_wake(now), now);
  }
  const TimeNs end = monotonic_ns();
  robot_.run_until(end);
  tell_end(end, "stopped");
  return {};
}

void Server::tell_end(TimeNs at, const std::string& why) {
  tell(at, "end",
       {{"why", why},
        {"left", robot_.left_target()},
        {"right", robot_.right_target()},
        {"wheels_commanded_t_ns", robot_.wheels_commanded_at().value_or(0)}});
}

hal::Status Server::turn(TimeNs now) {
  if (const hal::Status status = apply_faults(now); !status.ok()) return status;
  std::vector<Message> from_hosts;
  if (line_) {
    if (const hal::Status status = line_->take(now, from_hosts); !status.ok()) return status;
  }
  for (const Message& message : from_hosts) {
    if (faults_.reaches_robot(now)) robot_.receive(message, now);
  }
  robot_.run_until(now);
  show_hosts(now);
  return {};
}

// What the log says of a fault's end has come true.
hal::Status Server::apply_faults(TimeNs now) {
  while (const auto change = faults_.next_change(now)) {
    const Fault& fault = *change->fault;
    const auto note = [&](const char* phase) { tell(change->at, "fault", {{"fault", fault.text}, {"phase", phase}}); };
    if (change->begins) note("begin");
    apply(*change, robot_);
    if (fault.kind == FaultKind::Hangup) {
      to_hosts_.clear();
      line_.reset();
    }
    if (change->begins) continue;
    if (fault.kind == FaultKind::Hangup) {
      if (const hal::Status opened = open_line(); !opened.ok()) return opened;
    }
    note("end");
  }
  return {};
}

void Server::show_hosts(TimeNs now) {
  std::vector<TimedMessage> sent, arriving;
  robot_.take_sent(sent);
  for (const TimedMessage& message : sent) faults_.to_host(message, arriving);
  if (!line_) return;
  to_hosts_.insert(to_hosts_.end(), arriving.begin(), arriving.end());
  for (; !to_hosts_.empty() && to_hosts_.front().at <= now; to_hosts_.pop_front()) {
    line_->tell(to_hosts_.front().message, now);
  }
  line_->flush(now);
}

TimeNs Server::next_wake(TimeNs now) const {
  TimeNs wake = std::min(now + kStopNs, robot_.next_event());
  if (!to_hosts_.empty()) wake = std::min(wake, to_hosts_.front().at);
  if (const auto change = faults_.next_change_at()) wake = std::min(wake, *change);
  return wake;
}

void Server::wait_until(TimeNs at, TimeNs now) const {
  const TimeNs left = std::max<TimeNs>(0, at - now);
  const timespec t{static_cast<time_t>(left / hal::kNsPerSecond), static_cast<long>(left % hal::kNsPerSecond)};
  std::vector<pollfd> polls;
  if (line_) line_->add_polls(polls);
  ::ppoll(polls.data(), polls.size(), &t, nullptr);  // a signal wakes it too
}

}  // namespace

hal::Status run(const Options& options, const std::atomic<bool>& stop) {
  if (options.node < 1 || options.node > 255) {
    return hal::Error{"a node has a number from 1 to 255, not " + std::to_string(options.node)};
  }
  std::vector<Fault> faults;
  for (const std::string& text : options.faults) {
    auto fault = parse_fault(text);
    if (!fault.ok()) return fault.error();
    faults.push_back(std::move(fault).value());
  }
  std::unique_ptr<EventLog> log_file;
  if (!options.log_file.empty()) {
    auto opened = EventLog::open(options.log_file);
    if (!opened.ok()) return opened.error();
    log_file = std::move(opened).value();
  }
  OpenGround ground;
  EmulatedBody& body = options.body != nullptr ? *options.body : ground;
  Server server(options, std::move(log_file), FaultPlan(std::move(faults), options.seed), body);
  return server.serve(stop);
}

}  // namespace tandem::bridges::thymio_emulator
