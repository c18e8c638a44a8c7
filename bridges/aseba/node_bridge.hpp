// A real robot of ASEBA nodes behind the control interface, with its own I/O thread.
//
//   NodeBridge<Parts> bridge(settings, opener, log);
//   controller = type.construct(memory, bridge.robot(), params);   // takes its ports: they decide what is asked for
//   bridge.start();
//   each tick:  bridge.latch(tick, now);  controller step;  bridge.commit(now);
//   ~NodeBridge: the robot is stopped.
//
// The thread takes in what arrives, answers time-outs, opens the link anew when it was lost, and stops the robot when
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

#include "bridges/aseba/node_driver.hpp"
#include "bridges/aseba/reopening_messages.hpp"
#include "bridges/driver_bridge.hpp"
#include "bridges/link/device.hpp"
#include "bridges/link/link_text.hpp"

namespace tandem::bridges::aseba {

template <class Parts>
struct NodeBridgeSettings {
  typename Parts::Settings driver;
  std::string link = {};                          ///< as the experiment says it, for whoever stops the robot without us
  hal::TimeNs shutdown_ns = 300 * hal::kNsPerMs;  ///< how long the end waits for the robot to confirm its stop
};

/// A copy of everything that can be told about the bridge.
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

/// Owns link and thread.
template <class Parts>
class NodeBridge final : public DriverBridge<NodeBridge<Parts>, typename Parts::Robot> {
  using Base = DriverBridge<NodeBridge<Parts>, typename Parts::Robot>;

 public:
  using Settings = NodeBridgeSettings<Parts>;
  using Status = NodeBridgeStatus<Parts>;

  /// `opener` is called from threads of the bridge, from now on, and again whenever the link is gone. Times given to
  /// the bridge are CLOCK_MONOTONIC.
  NodeBridge(Settings settings, MessageLinkOpener opener, hal::Log log = {});
  /// Stops the robot, waits at most `shutdown_ns` for it to confirm, closes the link.
  ~NodeBridge() override;

  /// Errors: not active within `timeout_ns`; says what is known (link does not open, which node is missing …).
  hal::Status wait_active(hal::TimeNs timeout_ns);

  bool at_rest() const noexcept override;
  std::string trouble() const override;
  std::string advice() const override;
  RobotIdentity identity() const override;
  /// The body is that of rest_message.hpp.
  StopMessages stop_messages() const override;
  std::uint64_t stop_version() const noexcept override { return stop_version_; }
  LinkReport report() const override;
  void describe(StatusVisitor& visitor) const override;

  // What a loop asks in every tick; `status` copies much more.
  Status status() const;

 private:
  friend Base;
  using Base::changed_;
  using Base::ending_;
  using Base::mutex_;
  void before_start();
  void run();
  Interruptions interruptions() const noexcept;
  void after_command(hal::TimeNs) noexcept { note_link(); }
  void note_link() noexcept;
  RobotIdentity who() const;
  void run_shutdown();

  Settings settings_;
  ReopeningMessages link_;
  NodeDriver<Parts> driver_;
  RobotIdentity reached_;  // by the last link that was opened, without the robot's own words
  std::atomic<std::uint64_t> stop_version_{0};
};

namespace detail {
inline constexpr hal::TimeNs kLongestWait = 20 * hal::kNsPerMs;  // then deadlines and the end are looked at
inline constexpr hal::TimeNs kBlindWait = hal::kNsPerMs;         // where there is nothing to wait on

/// Until there is input at `descriptor`, at most `timeout_ns`.
void wait_for_input(hal::TimeNs timeout_ns, int descriptor);
}  // namespace detail

template <class Parts>
NodeBridge<Parts>::NodeBridge(Settings settings, MessageLinkOpener opener, hal::Log log)
    : settings_(std::move(settings)), link_(std::move(opener)), driver_(settings_.driver, link_, std::move(log)) {
  reached_.link = absolute_link(settings_.link);
}

template <class Parts>
NodeBridge<Parts>::~NodeBridge() {
  this->shut_down();
}

template <class Parts>
void NodeBridge<Parts>::before_start() {
  driver_.note_ports();
  note_link();
}

template <class Parts>
void NodeBridge<Parts>::note_link() noexcept {
  if (link_.openings() != reached_.session) {
    reached_.session = link_.openings();
    reached_.device = device_of(link_.descriptor());
  }
  stop_version_ = driver_.wiring().rest_version() + reached_.session;
}

template <class Parts>
/// Every interruption stops the robot, also one that is over already.
Interruptions NodeBridge<Parts>::interruptions() const noexcept {
  const NodeDriverStatistics& s = driver_.statistics();
  return {s.link_stops + s.watchdog_stops + s.restarts, s.restarts};
}

// --- the thread ---

template <class Parts>
void NodeBridge<Parts>::run() {
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

template <class Parts>
void NodeBridge<Parts>::run_shutdown() {
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

// --- the loop ---

template <class Parts>
hal::Status NodeBridge<Parts>::wait_active(hal::TimeNs timeout_ns) {
  std::unique_lock lock(mutex_);
  if (this->active_within(lock, timeout_ns)) return {};
  const std::string who = std::string(Parts::kNoun) + " '" + std::string(driver_.robot().id()) + "' is not there: ";
  if (!link_.trouble().empty()) return hal::Error{who + link_.trouble()};
  const std::string trouble = driver_.trouble();
  return hal::Error{who + (trouble.empty() ? "its nodes do not answer" : trouble) + "; " + advice()};
}

// --- what is known ---

template <class Parts>
std::string NodeBridge<Parts>::trouble() const {
  const std::lock_guard lock(mutex_);
  return link_.trouble().empty() ? driver_.trouble() : link_.trouble();
}

template <class Parts>
std::string NodeBridge<Parts>::advice() const {
  return std::string(Parts::kAdvice);
}

template <class Parts>
RobotIdentity NodeBridge<Parts>::who() const {
  RobotIdentity all = reached_;
  driver_.wiring().identify(all);
  return all;
}

template <class Parts>
RobotIdentity NodeBridge<Parts>::identity() const {
  const std::lock_guard lock(mutex_);
  return who();
}

template <class Parts>
StopMessages NodeBridge<Parts>::stop_messages() const {
  const std::lock_guard lock(mutex_);
  return {.robot = settings_.driver.robot.id,
          .kind = std::string(Parts::kKind),
          .link = reached_.link,
          .body = to_stop_body(driver_.wiring().rest_messages()),
          .version = stop_version_,
          .name = Parts::name_on_link(settings_.driver),
          .identity = who()};
}

template <class Parts>
LinkReport NodeBridge<Parts>::report() const {
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

template <class Parts>
void NodeBridge<Parts>::describe(StatusVisitor& visitor) const {
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

template <class Parts>
bool NodeBridge<Parts>::at_rest() const noexcept {
  const std::lock_guard lock(mutex_);
  return driver_.at_rest();
}

template <class Parts>
NodeBridgeStatus<Parts> NodeBridge<Parts>::status() const {
  const std::lock_guard lock(mutex_);
  Status status;
  status.state = driver_.state();
  status.trouble = link_.trouble().empty() ? driver_.trouble() : link_.trouble();
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

}  // namespace tandem::bridges::aseba
