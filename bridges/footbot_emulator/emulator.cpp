#include "bridges/footbot_emulator/emulator.hpp"

#include <algorithm>
#include <cerrno>
#include <deque>

#include "bridges/emulation/serving.hpp"
#include "bridges/footbot_emulator/faults.hpp"
#include "bridges/footbot_emulator/host_side.hpp"

namespace tandem::bridges::footbot_emulator {
namespace {

using hal::TimeNs;

constexpr TimeNs kMostBacklogNs = 20 * hal::kNsPerMs;  // on the bus; then the host waits

hal::Result<Protocol> protocol_of(const std::string& firmware) {
  if (firmware == "v4") return Protocol::V4;
  if (firmware == "v5") return Protocol::V5;
  return hal::Error{"a foot-bot has no firmware '" + firmware + "'; there are v4 and v5, after the protocol's version"};
}

class Server {
 public:
  Server(const Options& options, const EventSink& events, FaultPlan faults, EmulatedBody& body, KinematicBody* own_body,
         Protocol protocol)
      : options_(options),
        faults_(std::move(faults)),
        tell_(in_order(events)),
        robot_({.protocol = protocol, .delays = options.delays}, body, tell_),
        to_robot_delay_ns_(delay_ns(options.delays.to_robot_s)),
        to_host_delay_ns_(delay_ns(options.delays.to_host_s)),
        own_body_(own_body),
        poses_(options.poses.poses_hz) {}

  hal::Status serve(const std::atomic<bool>& stop);

 private:
  hal::Status open_side();
  hal::Status turn(TimeNs now);
  hal::Status apply_faults(TimeNs now);
  void put_on_bus(TimeNs now);
  void show_host(TimeNs now);
  void tell_pose(TimeNs now);
  bool is_full(TimeNs now) const noexcept { return bus_free_at_ > now + kMostBacklogNs; }
  TimeNs next_wake(TimeNs now) const;
  hal::Status wait(TimeNs wake, TimeNs now) const;
  void tell_end(TimeNs at, const std::string& why);

  const Options& options_;
  FaultPlan faults_;
  EventSink tell_;
  Footbot robot_;
  TimeNs to_robot_delay_ns_, to_host_delay_ns_;
  std::unique_ptr<HostSide> side_;  // none while hung up
  std::string link_;                // what is opened again after a hang-up
  TimeNs bus_free_at_ = 0;          // when the last frame of the host has passed
  std::deque<TimedFrame> to_robot_;
  std::deque<TimedFrame> to_host_;
  KinematicBody* own_body_;  // null: it lives in another
  PoseTeller poses_;
};

// A port that was chosen freely is kept: hosts come back to where they were.
hal::Status Server::open_side() {
  auto side = open_host_side(link_, tell_);
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
  tell_(start, "start",
        {{"firmware", options_.firmware}, {"link", options_.link}, {"path", side_->path()}, {"seed", options_.seed}});
  robot_.power_on(start);
  options_.log.info("foot-bot (" + options_.firmware + ") on " + side_->path());
  if (options_.ready) options_.ready(side_->path());
  const hal::Status served = turn_until(
      stop, tell_, [this](TimeNs now) { return turn(now); }, [this](TimeNs now) { return next_wake(now); },
      [this](TimeNs wake, TimeNs now) { return wait(wake, now); });
  const TimeNs end = monotonic_ns();
  if (served.ok()) robot_.run_until(end);
  tell_end(end, served.ok() ? "stopped" : served.error().message);
  return served;
}

void Server::tell_end(TimeNs at, const std::string& why) {
  const Module& left = robot_.module(Place::LeftMotor);
  const Module& right = robot_.module(Place::RightMotor);
  tell_(at, "end",
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
    if (faults_.reaches_robot(bus_free_at_)) to_robot_.push_back({frame, bus_free_at_ + to_robot_delay_ns_});
  }
  put_on_bus(now);
  show_host(now);
  return {};
}

hal::Status Server::apply_faults(TimeNs now) {
  return apply_changes(faults_, now, tell_, [this](const FaultPlan::Change& change) {
    const Fault& fault = *change.fault;
    apply(change, robot_);
    if (own_body_ != nullptr && fault.kind == FaultKind::Carry)
      own_body_->carry(change.at, fault.carried[0], fault.carried[1], fault.carried[2]);
    if (own_body_ != nullptr && fault.kind == FaultKind::Held) own_body_->hold(change.at, change.begins);
    if (fault.kind != FaultKind::Hangup) return hal::Status{};
    to_robot_.clear();
    to_host_.clear();
    side_.reset();
    return change.begins ? hal::Status{} : open_side();
  });
}

void Server::put_on_bus(TimeNs now) {
  while (!to_robot_.empty() && to_robot_.front().at <= now) {
    robot_.receive(to_robot_.front().frame, to_robot_.front().at);
    to_robot_.pop_front();
  }
  robot_.run_until(now);
  if (const auto at = robot_.first_driven_at()) faults_.driven(*at, now);
  tell_pose(now);
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

void Server::show_host(TimeNs now) {
  std::vector<TimedFrame> sent;
  robot_.take_sent(sent);
  std::vector<TimedFrame> arriving;
  for (const TimedFrame& frame : sent) faults_.to_host(frame, arriving);
  if (!side_) return;
  for (const TimedFrame& f : arriving) to_host_.push_back({f.frame, f.at + to_host_delay_ns_});
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
  wake = std::min(wake, poses_.due());
  if (is_full(now)) wake = std::min(wake, bus_free_at_ - kMostBacklogNs);
  if (const auto change = faults_.next_change_at()) wake = std::min(wake, *change);
  return wake;
}

hal::Status Server::wait(TimeNs wake, TimeNs now) const {
  std::vector<pollfd> polls;
  if (side_ && !is_full(now)) side_->add_polls(polls);
  wait_for(polls, wake, now);
  return {};
}

}  // namespace

hal::Status run(const Options& options, const std::atomic<bool>& stop) {
  const auto protocol = protocol_of(options.firmware);
  if (!protocol.ok()) return protocol.error();
  auto faults = read_faults(options.faults, &parse_fault);
  if (!faults.ok()) return faults.error();
  auto events = open_event_sink(options.log_file, options.events);
  if (!events.ok()) return events.error();
  KinematicBody own_body(options.poses.start, options.arena, options.wheels);
  EmulatedBody& body = options.body != nullptr ? *options.body : own_body;
  Server server(options, events.value(), FaultPlan(std::move(faults).value(), options.seed), body,
                options.body == nullptr ? &own_body : nullptr, protocol.value());
  return server.serve(stop);
}

}  // namespace tandem::bridges::footbot_emulator
