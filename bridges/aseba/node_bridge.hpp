// A real robot of ASEBA nodes behind the control interface, with its own I/O thread.
//
//   NodeBridge<Parts> bridge(settings, opener, log);
//   controller = type.construct(memory, bridge.robot(), params);   // takes its ports: they decide what is asked for
//   bridge.start();
//   each tick:  bridge.latch(tick, now);  controller step;  bridge.commit(now);
//   ~NodeBridge: the robot is stopped.
//
// The thread takes in what arrives, answers time-outs, reopens the link when it was lost, and stops the robot when
// the loop stops committing. When this process is killed, a guardian (bridges/guardian), where one was started, stops
// the robot.
//
// `Parts` has, beside what node_driver.hpp says of them:
//   kKind      name of the kind of robot, for its `StopperType`
//   kAdvice    what people can look at when it does not answer
//   name_on_link(const Settings&)    which robot, where several share the link; else ""
// and its wiring `identify(RobotIdentity&)`, which fills in the robot's words, and `describe(StatusVisitor&)`.
#pragma once
#include <algorithm>
#include <atomic>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "bridges/aseba/message_link_text.hpp"
#include "bridges/aseba/node_driver.hpp"
#include "bridges/aseba/reopening_messages.hpp"
#include "bridges/bridge_type.hpp"
#include "bridges/driver_bridge.hpp"
#include "bridges/link/device.hpp"
#include "bridges/link/link_text.hpp"

namespace tandem::bridges::aseba {

template <class Parts>
struct NodeBridgeSettings {
  typename Parts::Settings driver;
  std::string link = {};                          ///< as the experiment says it, to stop the robot without us
  hal::TimeNs shutdown_ns = 300 * hal::kNsPerMs;  ///< how long the end waits for the robot to confirm its stop
};

/// A copy of everything known about the bridge.
template <class Parts>
struct NodeBridgeStatus {
  RobotState state = RobotState::Absent;
  std::string trouble;       ///< why it is not active, or what is missing; `link_trouble` when there is some
  std::string link_trouble;  ///< the opener's message, when it has failed since the link was last open
  std::string link;
  bool stopped = false;  ///< by `stop`
  bool at_rest = false;  ///< and the robot has confirmed it
  std::vector<NodeStatus> nodes;
  NodeDriverStatistics driver;
  typename Parts::Wiring::Statistics wiring;
  NetworkStatistics network;
  MessageLinkStatistics messages;  ///< over all links that were opened
  std::uint64_t links_opened = 0;
};

namespace detail {
inline constexpr hal::TimeNs kLongestWait = 20 * hal::kNsPerMs;  // then deadlines and the end are looked at
inline constexpr hal::TimeNs kBlindWait = hal::kNsPerMs;         // where there is nothing to wait on

/// Until there is input at `descriptor`, at most `timeout_ns`.
void wait_for_input(hal::TimeNs timeout_ns, int descriptor);
}  // namespace detail

/// Owns link and thread.
template <class Parts>
class NodeBridge final : public DriverBridge<NodeBridge<Parts>, typename Parts::Robot> {
  using Base = DriverBridge<NodeBridge<Parts>, typename Parts::Robot>;

 public:
  using Settings = NodeBridgeSettings<Parts>;
  using Status = NodeBridgeStatus<Parts>;

  /// `opener` is called from threads of the bridge, from now on, and again whenever the link is gone. Times given to
  /// the bridge are CLOCK_MONOTONIC.
  NodeBridge(Settings settings, MessageLinkOpener opener, hal::Log log = {})
      : settings_(std::move(settings)), link_(std::move(opener)), driver_(settings_.driver, link_, std::move(log)) {
    reached_.link = absolute_link(settings_.link);
  }
  /// Stops the robot, waits at most `shutdown_ns` for it to confirm, closes the link.
  ~NodeBridge() override { this->shut_down(); }

  std::string advice() const override { return std::string(Parts::kAdvice); }
  /// The body is that of rest_message.hpp.
  StopMessages stop_messages() const override {
    const std::lock_guard lock(mutex_);
    return {.robot = settings_.driver.robot.id,
            .kind = std::string(Parts::kKind),
            .link = reached_.link,
            .body = to_stop_body(driver_.wiring().rest_messages()),
            .version = stop_version_,
            .name = Parts::name_on_link(settings_.driver),
            .identity = who()};
  }
  std::uint64_t stop_version() const noexcept override { return stop_version_; }
  LinkReport report() const override {
    const std::lock_guard lock(mutex_);
    LinkReport report;
    RoundTrips round_trips;
    for (const NodeStatus& node : driver_.wiring().nodes()) {
      report.questions += node.statistics.reads;
      report.answers += node.statistics.answers;
      report.time_outs += node.statistics.asked_again + node.statistics.unanswered;
      report.bad_answers += node.statistics.wrong_length + node.statistics.not_understood;
      round_trips.add(node.statistics.round_trips);
    }
    report.set(round_trips);
    report.resynchronised = driver_.statistics().recovered;
    report.links_lost = driver_.statistics().lost;
    return report;
  }
  void describe(StatusVisitor& visitor) const override {
    const Status s = status();
    visitor.text("state", state_name(s.state));
    visitor.count("messages_in", s.messages.received);
    visitor.count("messages_out", s.messages.sent);
    visitor.count("messages_dropped", s.messages.dropped);
    visitor.count("interruptions", s.driver.link_stops);
    visitor.count("restarts", s.driver.restarts);
    visitor.count("stops_for_want_of_commands", s.driver.watchdog_stops);
    visitor.count("other_hosts", s.network.other_hosts);
    visitor.count("not_understood", s.network.not_understood);
    s.wiring.describe(visitor);
    visitor.count("commands_clamped", s.driver.clamped);
    visitor.count("commands_not_finite", s.driver.not_finite);
    visitor.count("links_opened", s.links_opened);
    visitor.begin_list("nodes");
    for (const NodeStatus& n : s.nodes) {
      visitor.begin_row();
      visitor.text("name", n.name);
      visitor.number("id", n.id);
      visitor.flag("needed", n.needed);
      visitor.text("state", node_state_name(n.state));
      visitor.text("trouble", n.trouble);
      visitor.count("reads", n.statistics.reads);
      visitor.count("answers", n.statistics.answers);
      visitor.count("unanswered", n.statistics.unanswered);
      visitor.count("writes", n.statistics.writes);
      visitor.count("times_lost", n.statistics.times_lost);
      visitor.count("times_ready", n.statistics.times_ready);
      visitor.end_row();
    }
    visitor.end_list();
  }

  // What a loop asks in every tick; `status` copies much more.
  Status status() const {
    const std::lock_guard lock(mutex_);
    Status status;
    status.state = driver_.state();
    status.trouble = this->any_trouble();
    status.link_trouble = link_.trouble();
    status.link = link_.name();
    status.stopped = driver_.stopped();
    status.at_rest = driver_.at_rest();
    status.nodes = driver_.wiring().nodes();
    status.driver = driver_.statistics();
    status.wiring = driver_.wiring().statistics();
    status.network = driver_.network().statistics();
    status.messages = link_.statistics();
    status.links_opened = link_.openings();
    return status;
  }

 private:
  friend Base;
  using Base::changed_;
  using Base::ending_;
  using Base::mutex_;
  void before_start() {
    driver_.note_ports();
    note_link();
  }
  void run() {
    while (!ending_) {
      const hal::TimeNs now = monotonic_ns();
      hal::TimeNs wait = 0;
      int descriptor = -1;
      {
        const std::lock_guard lock(mutex_);
        const RobotState before = driver_.state();
        driver_.pump(now);
        note_link();
        if (driver_.state() != before) changed_.notify_all();
        wait = std::clamp<hal::TimeNs>(driver_.next_deadline() - now, 0, detail::kLongestWait);
        descriptor = link_.descriptor();
      }
      detail::wait_for_input(wait, descriptor);
    }
    run_shutdown();
  }
  /// Every interruption stops the robot, also one that is over already.
  Interruptions interruptions() const noexcept {
    const NodeDriverStatistics& s = driver_.statistics();
    return {s.link_stops + s.watchdog_stops + s.restarts, s.restarts};
  }
  void after_command(hal::TimeNs) noexcept { note_link(); }
  void note_link() noexcept {
    if (link_.openings() != reached_.session) {
      reached_.session = link_.openings();
      reached_.device = device_of(link_.descriptor());
    }
    stop_version_ = driver_.wiring().rest_version() + reached_.session;
  }
  std::string noun() const { return std::string(Parts::kNoun); }
  std::string link_trouble() const { return link_.trouble(); }
  std::string robot_trouble() const { return driver_.trouble(); }
  std::string silence() const {
    const std::string trouble = driver_.trouble();
    return trouble.empty() ? "its nodes do not answer" : trouble;
  }
  RobotIdentity who() const {
    RobotIdentity all = reached_;
    driver_.wiring().identify(all);
    return all;
  }
  void run_shutdown() {
    const hal::TimeNs end = monotonic_ns() + settings_.shutdown_ns;
    for (bool said = false; true; said = true) {
      int descriptor = -1;
      {
        const std::lock_guard lock(mutex_);
        const hal::TimeNs now = monotonic_ns();
        if (!said) {
          driver_.stop(now);
        } else {
          driver_.pump(now);
        }
        if (settings_.driver.observe || driver_.at_rest() || now >= end || link_.state() != Carrier::Up) return;
        descriptor = link_.descriptor();
      }
      detail::wait_for_input(detail::kBlindWait, descriptor);
    }
  }

  Settings settings_;
  ReopeningMessages link_;
  NodeDriver<Parts> driver_;
  RobotIdentity reached_;  // by the last link that was opened, without the robot's own words
  std::atomic<std::uint64_t> stop_version_{0};
};

/// `BridgeType::make` of such a robot, and with `check_by` what `check` begins with; `add(request, driver)` adds to the
/// driver's settings what is the kind's own.
template <class Parts>
struct NodeBridgeMaker {
  using Settings = NodeBridgeSettings<Parts>;
  using Prepared = std::pair<Settings, MessageLinkOpener>;

  template <hal::Status (*add)(const BridgeRequest&, typename Parts::Settings&)>
  static hal::Result<Prepared> prepare(const BridgeRequest& request) {
    auto opener = message_link_opener(request.link, {request.permit});
    if (!opener.ok()) return opener.error();
    Prepared prepared{{}, std::move(opener).value()};
    prepared.first.link = request.link;
    apply(request, prepared.first);
    if (const hal::Status added = add(request, prepared.first.driver); !added.ok()) return added.error();
    return prepared;
  }
  template <hal::Status (*add)(const BridgeRequest&, typename Parts::Settings&)>
  static MadeBridge make(const BridgeRequest& request, const hal::Log& log) {
    auto prepared = prepare<add>(request);
    if (!prepared.ok()) return prepared.error();
    auto& [settings, opener] = prepared.value();
    return std::unique_ptr<RobotBridge>(
        std::make_unique<NodeBridge<Parts>>(std::move(settings), std::move(opener), log));
  }
};

}  // namespace tandem::bridges::aseba
