#include "bridges/thymio_emulator/emulator.hpp"

#include <algorithm>
#include <deque>
#include <memory>

#include "bridges/aseba_emulation/host_line.hpp"
#include "bridges/emulation/serving.hpp"
#include "bridges/thymio_emulator/faults.hpp"

namespace tandem::bridges::thymio_emulator {
namespace {

using hal::TimeNs;

class Server {
 public:
  Server(const Options& options, const EventSink& events, FaultPlan faults, EmulatedBody& body, OpenGround* ground)
      : options_(options),
        faults_(std::move(faults)),
        tell_(in_order(events)),
        robot_({.node = static_cast<std::uint8_t>(options.node), .delays = options.delays}, body, tell_),
        to_hosts_delay_ns_(delay_ns(options.delays.to_host_s)),
        to_robot_(options.delays.to_robot_s),
        ground_(ground),
        poses_(options.poses.poses_hz) {}

  hal::Status serve(const std::atomic<bool>& stop);

 private:
  hal::Status open_line();
  hal::Status turn(TimeNs now);
  hal::Status apply_faults(TimeNs now);
  void show_hosts(TimeNs now);
  void tell_pose(TimeNs now);
  TimeNs next_wake(TimeNs now) const;
  hal::Status wait(TimeNs wake, TimeNs now) const;
  void tell_end(TimeNs at, const std::string& why);

  const Options& options_;
  FaultPlan faults_;
  EventSink tell_;
  Thymio robot_;
  TimeNs to_hosts_delay_ns_;
  DelayLine<Message> to_robot_;
  std::unique_ptr<aseba_emulation::HostLine> line_;  // none while hung up
  std::string link_;                                 // what is opened again after a hang-up
  std::deque<TimedMessage> to_hosts_;
  OpenGround* ground_;  // null: its body lives in another
  PoseTeller poses_;
};

// A port that was chosen freely is kept: hosts come back to where they were.
hal::Status Server::open_line() {
  auto line = aseba_emulation::open_host_line(link_, "an emulated Thymio", kBaud, tell_);
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
  tell_(start, "start", {{"link", options_.link}, {"path", line_->path()}, {"seed", options_.seed}});
  robot_.power_on(start);
  options_.log.info("Thymio on " + line_->path());
  if (options_.ready) options_.ready(line_->path());
  const hal::Status served = turn_until(
      stop, tell_, [this](TimeNs now) { return turn(now); }, [this](TimeNs now) { return next_wake(now); },
      [this](TimeNs wake, TimeNs now) { return wait(wake, now); });
  const TimeNs end = monotonic_ns();
  if (served.ok()) robot_.run_until(end);
  tell_end(end, served.ok() ? "stopped" : served.error().message);
  return served;
}

void Server::tell_end(TimeNs at, const std::string& why) {
  tell_(at, "end",
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
    if (faults_.reaches_robot(now)) to_robot_.put(now, message);
  }
  to_robot_.take(now, [this](TimeNs at, const Message& message) { robot_.receive(message, at); });
  robot_.run_until(now);
  if (const auto at = robot_.first_driven_at()) faults_.driven(*at, now);
  tell_pose(now);
  show_hosts(now);
  return {};
}

void Server::tell_pose(TimeNs now) {
  const auto pose_at = [this](TimeNs at) -> std::optional<BodyPose> {
    if (ground_ == nullptr) return options_.pose_elsewhere ? options_.pose_elsewhere() : std::nullopt;
    ground_->advance(at);
    return ground_->pose();
  };
  poses_.turn(now, pose_at, tell_);
}

hal::Status Server::apply_faults(TimeNs now) {
  return apply_changes(faults_, now, tell_, [this](const FaultPlan::Change& change) {
    const Fault& fault = *change.fault;
    apply(change, robot_);
    if (fault.kind != FaultKind::Hangup) return hal::Status{};
    to_hosts_.clear();
    to_robot_.clear();
    line_.reset();
    return change.begins ? hal::Status{} : open_line();
  });
}

void Server::show_hosts(TimeNs now) {
  std::vector<TimedMessage> sent, arriving;
  robot_.take_sent(sent);
  for (const TimedMessage& message : sent) faults_.to_host(message, arriving);
  if (!line_) return;
  for (TimedMessage& m : arriving) to_hosts_.push_back({std::move(m.message), m.at + to_hosts_delay_ns_});
  for (; !to_hosts_.empty() && to_hosts_.front().at <= now; to_hosts_.pop_front()) {
    line_->tell(to_hosts_.front().message, now);
  }
  line_->flush(now);
}

TimeNs Server::next_wake(TimeNs now) const {
  TimeNs wake = std::min(now + kStopNs, robot_.next_event());
  if (!to_hosts_.empty()) wake = std::min(wake, to_hosts_.front().at);
  if (const auto at = to_robot_.next_at()) wake = std::min(wake, *at);
  if (const auto change = faults_.next_change_at()) wake = std::min(wake, *change);
  wake = std::min(wake, poses_.due());
  return wake;
}

hal::Status Server::wait(TimeNs wake, TimeNs now) const {
  std::vector<pollfd> polls;
  if (line_) line_->add_polls(polls);
  wait_for(polls, wake, now);
  return {};
}

}  // namespace

hal::Status run(const Options& options, const std::atomic<bool>& stop) {
  if (options.node < 1 || options.node > 255) {
    return hal::Error{"a node has a number from 1 to 255, not " + std::to_string(options.node)};
  }
  auto faults = read_faults(options.faults, &parse_fault);
  if (!faults.ok()) return faults.error();
  auto events = open_event_sink(options.log_file, options.events);
  if (!events.ok()) return events.error();
  OpenGround ground(options.poses.start, options.wheels);
  EmulatedBody& body = options.body != nullptr ? *options.body : ground;
  Server server(options, events.value(), FaultPlan(std::move(faults).value(), options.seed), body,
                options.body == nullptr ? &ground : nullptr);
  return server.serve(stop);
}

}  // namespace tandem::bridges::thymio_emulator
