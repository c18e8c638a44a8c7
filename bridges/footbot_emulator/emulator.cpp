#include "bridges/footbot_emulator/emulator.hpp"

#include <algorithm>
#include <cerrno>
#include <deque>
#include <poll.h>
#include <time.h>

#include "bridges/footbot_emulator/faults.hpp"
#include "bridges/footbot_emulator/host_side.hpp"

namespace tandem::bridges::footbot_emulator {
namespace {

using hal::TimeNs;

constexpr TimeNs kMostBacklogNs = 20 * hal::kNsPerMs;  // on the bus; then the host waits
constexpr TimeNs kStopNs = 20 * hal::kNsPerMs;         // the stop flag is looked at this often

TimeNs monotonic_ns() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return static_cast<TimeNs>(t.tv_sec) * hal::kNsPerSecond + t.tv_nsec;
}

hal::Result<Protocol> protocol_of(const std::string& firmware) {
  if (firmware == "v4") return Protocol::V4;
  if (firmware == "v5") return Protocol::V5;
  return hal::Error{"a foot-bot has no firmware '" + firmware + "'; there are v4 and v5, after the protocol's version"};
}

class Server {
 public:
  Server(const Options& options, std::unique_ptr<EventLog> log_file, FaultPlan faults, EmulatedBody& body,
         Protocol protocol)
      : options_(options),
        log_file_(std::move(log_file)),
        faults_(std::move(faults)),
        sink_([this](TimeNs at, std::string_view name, const EventFields& fields) { tell(at, name, fields); }),
        robot_({.protocol = protocol}, body, sink_) {}

  hal::Status serve(const std::atomic<bool>& stop);

 private:
  void tell(TimeNs at, std::string_view name, const EventFields& fields);
  hal::Status open_side();
  hal::Status turn(TimeNs now);
  hal::Status apply_faults(TimeNs now);
  void put_on_bus(TimeNs now);
  void show_host(TimeNs now);
  bool is_full(TimeNs now) const noexcept { return bus_free_at_ > now + kMostBacklogNs; }
  TimeNs next_wake(TimeNs now) const;
  void wait_until(TimeNs at, TimeNs now) const;
  void tell_end(TimeNs at, const std::string& why);

  const Options& options_;
  std::unique_ptr<EventLog> log_file_;
  FaultPlan faults_;
  EventSink sink_;
  Footbot robot_;
  std::unique_ptr<HostSide> side_;  // none while hung up
  std::string link_;                // what is opened again after a hang-up
  TimeNs bus_free_at_ = 0;          // when the last frame of the host has passed
  std::deque<TimedFrame> to_robot_;
  std::deque<TimedFrame> to_host_;
  TimeNs last_told_ = 0;
};

// Stamps in the log never go back, although the robot's are of the past by up to one turn.
void Server::tell(TimeNs at, std::string_view name, const EventFields& fields) {
  last_told_ = std::max(last_told_, at);
  if (log_file_) log_file_->write(last_told_, name, fields);
  if (options_.events) options_.events(last_told_, name, fields);
}

// A port that was chosen freely is kept: hosts come back to where they were.
hal::Status Server::open_side() {
  auto side = open_host_side(link_, sink_);
  if (!side.ok()) return side.error();
  side_ = std::move(side).value();
  if (link_.starts_with("tcp-listen:") && link_.ends_with(":0")) {
    link_ = link_.substr(0, link_.size() - 1) + side_->path().substr(side_->path().rfind(':') + 1);
  }
  return {};
}

hal::Status Server::serve(const std::atomic<bool>& stop) {
  link_ = options_.link;
  if (const hal::Status opened = open_side(); !opened.ok()) return opened;
  const TimeNs start = monotonic_ns();
  faults_.begin(start);
  tell(start, "start",
       {{"firmware", options_.firmware}, {"link", options_.link}, {"path", side_->path()}, {"seed", options_.seed}});
  robot_.power_on(start);
  options_.log.info("foot-bot (" + options_.firmware + ") on " + side_->path());
  if (options_.ready) options_.ready(side_->path());
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
  const Module& left = robot_.module(Place::LeftMotor);
  const Module& right = robot_.module(Place::RightMotor);
  tell(at, "end",
       {{"why", why},
        {"left", left.words("speed")[0]},
        {"right", right.words("speed")[0]},
        {"wheels_commanded_t_ns", robot_.wheels_commanded_at().value_or(0)}});
}

hal::Status Server::turn(TimeNs now) {
  if (const hal::Status status = apply_faults(now); !status.ok()) return status;
  std::vector<Frame> from_host;
  if (side_ && !is_full(now)) {
    if (const hal::Status status = side_->take(now, from_host); !status.ok()) return status;
  }
  for (const Frame& frame : from_host) {
    bus_free_at_ = std::max(bus_free_at_, now) + duration_ns(frame);
    if (faults_.reaches_robot(bus_free_at_)) to_robot_.push_back({frame, bus_free_at_});
  }
  put_on_bus(now);
  show_host(now);
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
      to_robot_.clear();
      to_host_.clear();
      side_.reset();
    }
    if (change->begins) continue;
    if (fault.kind == FaultKind::Hangup) {
      if (const hal::Status opened = open_side(); !opened.ok()) return opened;
    }
    note("end");
  }
  return {};
}

void Server::put_on_bus(TimeNs now) {
  while (!to_robot_.empty() && to_robot_.front().at <= now) {
    robot_.receive(to_robot_.front().frame, to_robot_.front().at);
    to_robot_.pop_front();
  }
  robot_.run_until(now);
}

void Server::show_host(TimeNs now) {
  std::vector<TimedFrame> sent;
  robot_.take_sent(sent);
  std::vector<TimedFrame> arriving;
  for (const TimedFrame& frame : sent) faults_.to_host(frame, arriving);
  if (!side_) return;
  to_host_.insert(to_host_.end(), arriving.begin(), arriving.end());
  while (!to_host_.empty() && to_host_.front().at <= now) {
    side_->show(to_host_.front().frame, to_host_.front().at);
    to_host_.pop_front();
  }
  side_->flush(now);
}

TimeNs Server::next_wake(TimeNs now) const {
  TimeNs wake = std::min(now + kStopNs, robot_.next_event());
  if (!to_robot_.empty()) wake = std::min(wake, to_robot_.front().at);
  if (!to_host_.empty()) wake = std::min(wake, to_host_.front().at);
  if (is_full(now)) wake = std::min(wake, bus_free_at_ - kMostBacklogNs);
  if (const auto change = faults_.next_change_at()) wake = std::min(wake, *change);
  return wake;
}

void Server::wait_until(TimeNs at, TimeNs now) const {
  const TimeNs left = std::max<TimeNs>(0, at - now);
  const timespec t{static_cast<time_t>(left / hal::kNsPerSecond), static_cast<long>(left % hal::kNsPerSecond)};
  std::vector<pollfd> polls;
  if (side_ && !is_full(now)) side_->add_polls(polls);
  ::ppoll(polls.data(), polls.size(), &t, nullptr);  // a signal wakes it too
}

}  // namespace

hal::Status run(const Options& options, const std::atomic<bool>& stop) {
  const auto protocol = protocol_of(options.firmware);
  if (!protocol.ok()) return protocol.error();
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
  KinematicBody own_body({}, options.arena);
  EmulatedBody& body = options.body != nullptr ? *options.body : own_body;
  Server server(options, std::move(log_file), FaultPlan(std::move(faults), options.seed), body, protocol.value());
  return server.serve(stop);
}

}  // namespace tandem::bridges::footbot_emulator
