// Server of emulated robots and trackers, from start to stop, and that of robots on two wheels.
#pragma once
#include <algorithm>
#include <atomic>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bridges/emulation/delays.hpp"
#include "bridges/emulation/emulator_type.hpp"
#include "bridges/emulation/fault_table.hpp"
#include "bridges/emulation/item_line.hpp"
#include "bridges/emulation/serving.hpp"
#include "bridges/emulation/true_pose.hpp"
#include "bridges/emulation/wheeled_body.hpp"
#include "hal/log.hpp"

namespace tandem::bridges {

/// Options of every emulator's run.
struct ServerOptions {
  std::string link{};                                    ///< as the emulator reads it
  std::string log_file{};                                ///< one JSON object a line; empty: none
  std::vector<std::string> faults{};                     ///< as the emulator's table of faults reads them
  std::uint64_t seed = 1;                                ///< of the chance in the faults
  EventSink events{};                                    ///< gets what the log gets, on the thread of `run`
  hal::Log log{};                                        ///< for people
  std::function<void(const std::string& path)> ready{};  ///< called once, when a host can connect
};

/// What the command line may say to every robot on two wheels.
struct WheeledParams {
  PoseOptions poses{};
  WheelErrors wheels{};  ///< how the wheels of a body of its own err
  Delays delays{};
  void describe(hal::ParamVisitor& v) {
    poses.describe(v);
    wheels.describe(v);
    delays.describe(v);
  }
};

/// Options of robots on two wheels; `Body` is the emulator's interface of bodies.
template <class Body>
struct WheeledOptions : ServerOptions, WheeledParams {
  Body* body = nullptr;          ///< must outlive the run; none: one of its own, in `arena` if there is one
  std::optional<Arena> arena{};  ///< none: open ground
  std::function<std::optional<BodyPose>()> pose_elsewhere{};  ///< of `body`, the newest; none: unknown
};

/// Fills in what every emulator's options have.
inline void apply(const EmulatorRequest& request, ServerOptions& options) {
  options.link = request.link;
  options.log_file = request.log_file;
  options.faults = request.faults;
  options.log = request.log;
}
/// `EmulatorType::run` for a robot, whose body is another's where there are `ports`. `Options` are ServerOptions with a
/// `body` that describe what is read, and `shown(path)` of them tells people how a host reaches the robot.
template <class Options, class PortBody, auto run>
hal::Status run_emulator(const EmulatorRequest& request, SharedPorts* ports, const std::atomic<bool>& stop) {
  Options options = request.options == nullptr ? Options{} : *static_cast<const Options*>(request.options.get());
  apply(request, options);
  std::optional<PortBody> body;
  if (ports != nullptr) options.body = &body.emplace(*ports);
  if constexpr (requires { options.pose_elsewhere; }) {
    if (ports != nullptr) options.delays.body_s = options.wheels.delay_s;
    if (ports != nullptr) options.pose_elsewhere = [ports] { return ports->pose(); };
  }
  options.ready = [&](const std::string& path) {
    if (request.ready) request.ready(options.shown(path));
  };
  return run(options, stop);
}

/// Takes turns. All its functions are called on the thread of `serve`.
class Server {
 public:
  virtual ~Server() = default;
  /// Begins, takes turns until `stop` becomes true, which is noticed within 20 ms, and ends. Errors: of `begin`, of a
  /// turn.
  hal::Status serve(const std::atomic<bool>& stop);

 protected:
  explicit Server(EventSink tell) : tell_(std::move(tell)) {}

  virtual hal::Status begin() = 0;
  virtual hal::Status turn(hal::TimeNs now) = 0;
  /// When a turn has something to do, if nothing is heard before.
  virtual hal::TimeNs next_wake(hal::TimeNs now) const = 0;
  /// What a turn is worth as soon as there is something to read or write.
  virtual void add_polls(hal::TimeNs /*now*/, std::vector<pollfd>& /*polls*/) const {}
  /// Looks at what was polled. Errors: the line has gone.
  virtual hal::Status polled(const std::vector<pollfd>& /*polls*/) const { return {}; }
  /// `served` is what the turns came to.
  virtual void end(hal::TimeNs now, const hal::Status& served) = 0;

  EventSink tell_;
};

/// Server of one robot on two wheels: its faults, the line that may hang up, its true pose.
///
/// `Robot` is made of its options, a body and a sink, and has power_on, run_until, next_event and first_driven_at;
/// `Plan` is a FaultSchedule with the kind Hangup; `Own` is a WheeledBodyOf; `Line` has path and link.
template <class Robot, class Plan, class Own, class Line>
class WheeledServer : public Server {
 protected:
  /// `name` of the robot, for people.
  template <class Body>
  WheeledServer(const WheeledOptions<Body>& options, const EventSink& events, Plan faults,
                const typename Robot::Options& robot, std::string name)
      : Server(in_order(events)),
        faults_(std::move(faults)),
        has_own_body_(options.body == nullptr),
        own_body_(options.poses.start, options.arena, options.wheels),
        robot_(robot, has_own_body_ ? own_body_ : *options.body, tell_),
        to_robot_delay_ns_(delay_ns(options.delays.to_robot_s)),
        to_host_delay_ns_(delay_ns(options.delays.to_host_s)),
        served_(options),
        name_(std::move(name)),
        link_(options.link),
        pose_elsewhere_(options.pose_elsewhere),
        poses_(options.poses.poses_hz) {}

  virtual hal::Result<std::unique_ptr<Line>> open_line(const std::string& link) = 0;
  /// Forgets what is on its way.
  virtual void forget() = 0;
  /// What the log's first line says.
  virtual EventFields start_fields() const = 0;
  /// Does what concerns the robot and its own body.
  virtual void apply_fault(const typename Plan::Change& change) = 0;
  /// From the line to the robot.
  virtual hal::Status take_in(hal::TimeNs now) = 0;
  /// From the robot to the line.
  virtual void give_out(hal::TimeNs now) = 0;
  /// When what is on its way arrives.
  virtual hal::TimeNs next_arrival(hal::TimeNs now) const = 0;
  /// How its wheels are commanded, for the last line of the log.
  virtual EventFields last_command() const = 0;

  hal::Status begin() final {
    if (const hal::Status opened = open(); !opened.ok()) return opened;
    const hal::TimeNs start = monotonic_ns();
    faults_.begin(start);
    tell_(start, "start", start_fields());
    robot_.power_on(start);
    served_.log.info(name_ + " on " + line_->path());
    if (served_.ready) served_.ready(line_->path());
    return {};
  }
  hal::Status turn(hal::TimeNs now) final {
    hal::Status status = apply_changes(faults_, now, tell_, [this](const typename Plan::Change& change) {
      apply_fault(change);
      if (change.fault->kind != Plan::Kind::Hangup) return hal::Status{};
      forget();
      line_.reset();
      return change.begins ? hal::Status{} : open();
    });
    if (status.ok()) status = take_in(now);
    if (!status.ok()) return status;
    robot_.run_until(now);
    if (const auto at = robot_.first_driven_at()) faults_.driven(*at, now);
    poses_.turn(
        now, [this](hal::TimeNs at) { return pose(at); }, tell_);
    give_out(now);
    return {};
  }
  hal::TimeNs next_wake(hal::TimeNs now) const final {
    const hal::TimeNs wake = std::min({now + kStopNs, poses_.due(), next_arrival(now)});
    return std::min(wake, faults_.next_change_at().value_or(wake));
  }
  void end(hal::TimeNs now, const hal::Status& served) final {
    if (served.ok()) robot_.run_until(now);
    EventFields fields = last_command();
    fields.insert(fields.begin(), EventField("why", served.ok() ? "stopped" : served.error().message));
    tell_(now, "end", fields);
  }

  std::unique_ptr<Line> line_;  // none while hung up
  Plan faults_;
  bool has_own_body_;  // else its body lives in another
  Own own_body_;
  Robot robot_;
  hal::TimeNs to_robot_delay_ns_, to_host_delay_ns_;

 private:
  /// At the start and after a hang-up. Then `link_` opens the same line again: hosts come back to where they were,
  /// although its port was chosen freely.
  hal::Status open() {
    auto line = open_line(link_);
    if (!line.ok()) return line.error();
    line_ = std::move(line).value();
    link_ = line_->link();
    return {};
  }
  std::optional<BodyPose> pose(hal::TimeNs at) {
    if (!has_own_body_) return pose_elsewhere_ ? pose_elsewhere_() : std::nullopt;
    own_body_.advance(at);
    return own_body_.pose();
  }

  const ServerOptions& served_;
  std::string name_, link_;
  std::function<std::optional<BodyPose>()> pose_elsewhere_;
  PoseTeller poses_;
};

/// What is on its way and when it arrives, in the order of arrival: each has a time `at`.
template <class Timed>
hal::TimeNs first_at(const std::deque<Timed>& line, hal::TimeNs otherwise) {
  return line.empty() ? otherwise : line.front().at;
}

/// Takes what has arrived by `now` off the line.
template <class Timed>
void take_due(std::deque<Timed>& line, hal::TimeNs now, const auto& use) {
  for (; !line.empty() && line.front().at <= now; line.pop_front()) use(line.front());
}

/// The same where the line carries whole messages or frames: of a `Timed`, which has a time `at`, what is `kItem`.
template <class Robot, class Plan, class Own, class Timed, class Item, Item Timed::*kItem>
class ItemServer : public WheeledServer<Robot, Plan, Own, ItemLine<Item>> {
 protected:
  using ItemServer::WheeledServer::WheeledServer;

  /// When an item of a host, taken in at `now`, has come through to the robot.
  virtual hal::TimeNs passed_at(const Item& /*item*/, hal::TimeNs now) { return now; }
  /// Until then nothing more is taken in.
  virtual hal::TimeNs full_until() const { return 0; }

 private:
  void forget() final {
    to_robot_.clear();
    to_host_.clear();
  }
  hal::Status take_in(hal::TimeNs now) final {
    std::vector<Item> from_hosts;
    if (this->line_ && full_until() <= now) {
      if (const hal::Status status = this->line_->take(now, from_hosts); !status.ok()) return status;
    }
    for (Item& item : from_hosts) {
      const hal::TimeNs at = passed_at(item, now);
      if (this->faults_.reaches_robot(at)) to_robot_.push_back({std::move(item), at + this->to_robot_delay_ns_});
    }
    take_due(to_robot_, now, [this](const Timed& t) { this->robot_.receive(t.*kItem, t.at); });
    return {};
  }
  void give_out(hal::TimeNs now) final {
    std::vector<Timed> sent, arriving;
    this->robot_.take_sent(sent);
    for (const Timed& t : sent) this->faults_.to_host(t, arriving);
    if (!this->line_) return;
    for (Timed& t : arriving) {
      t.at += this->to_host_delay_ns_;
      to_host_.push_back(std::move(t));
    }
    take_due(to_host_, now, [this](const Timed& t) { this->line_->tell(t.*kItem, t.at); });
    this->line_->flush(now);
  }
  hal::TimeNs next_arrival(hal::TimeNs now) const final {
    const hal::TimeNs next = this->robot_.next_event();
    return std::min(
        {next, first_at(to_robot_, next), first_at(to_host_, next), full_until() > now ? full_until() : next});
  }
  void add_polls(hal::TimeNs now, std::vector<pollfd>& polls) const final {
    if (this->line_ && full_until() <= now) this->line_->add_polls(polls);
  }

  std::deque<Timed> to_robot_, to_host_;
};

/// Opens the log and reads the faults of `options`, then serves. `make(events, faults)` gives the server.
template <class Fault, class Make>
hal::Status serve_with(const ServerOptions& options, const FaultTable<Fault>& table, const std::atomic<bool>& stop,
                       const Make& make) {
  auto faults = table.parse(options.faults);
  if (!faults.ok()) return faults.error();
  auto events = open_event_sink(options.log_file, options.events);
  if (!events.ok()) return events.error();
  return make(events.value(), std::move(faults).value()).serve(stop);
}

}  // namespace tandem::bridges
