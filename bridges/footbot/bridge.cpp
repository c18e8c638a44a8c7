#include "bridges/footbot/bridge.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <poll.h>

#include "bridges/footbot/stop_body.hpp"
#include "bridges/link/link_text.hpp"
#include "hal/check.hpp"
#include "hal/robot/footbot.hpp"

namespace tandem::bridges::footbot {
namespace {

using hal::TimeNs;

constexpr TimeNs kLongestWait = 20 * hal::kNsPerMs;  // then deadlines and the end are looked at
constexpr TimeNs kBlindWait = hal::kNsPerMs;         // where there is nothing to wait on

}  // namespace

FootbotBridge::FootbotBridge(BridgeSettings settings, aseba::MessageLinkOpener opener, hal::Log log)
    : settings_(std::move(settings)), link_(std::move(opener)), driver_(settings_.driver, link_, std::move(log)) {}

FootbotBridge::~FootbotBridge() {
  shut_down();
}

void FootbotBridge::before_start() {
  driver_.note_ports();
  stop_version_ = driver_.wiring().rest_version();
}

/// Every interruption stops the robot, also one that is over already.
Interruptions FootbotBridge::interruptions() const noexcept {
  const DriverStatistics& s = driver_.statistics();
  return {s.link_stops + s.watchdog_stops + s.restarts, s.restarts};
}

// --- the thread ---

void FootbotBridge::run() {
  while (!ending_) {
    const TimeNs now = monotonic_ns();
    TimeNs wait = 0;
    int descriptor = -1;
    {
      const std::lock_guard lock(mutex_);
      const RobotState before = driver_.state();
      driver_.pump(now);
      stop_version_ = driver_.wiring().rest_version();
      if (driver_.state() != before) changed_.notify_all();
      wait = std::clamp<TimeNs>(driver_.next_deadline() - now, 0, kLongestWait);
      descriptor = link_.descriptor();
    }
    wait_outside(wait, descriptor);
  }
  run_shutdown();
}

void FootbotBridge::wait_outside(TimeNs timeout_ns, int descriptor) {
  if (descriptor < 0) timeout_ns = std::min(timeout_ns, kBlindWait);
  pollfd p{descriptor, POLLIN, 0};
  const timespec t{0, static_cast<long>(timeout_ns)};
  const bool ready = ::ppoll(&p, descriptor < 0 ? 0 : 1, &t, nullptr) > 0;
  if (!ready || (p.revents & POLLIN) != 0) return;
  const timespec pause{0, kBlindWait};  // the line is dead: a loop of waits must not spin
  ::nanosleep(&pause, nullptr);
}

void FootbotBridge::run_shutdown() {
  const TimeNs end = monotonic_ns() + settings_.shutdown_ns;
  for (bool said = false; true; said = true) {
    int descriptor = -1;
    {
      const std::lock_guard lock(mutex_);
      const TimeNs now = monotonic_ns();
      if (!said) {
        driver_.stop(now);
      } else {
        driver_.pump(now);
      }
      if (settings_.driver.observe || driver_.at_rest() || now >= end || link_.state() != aseba::Carrier::Up) return;
      descriptor = link_.descriptor();
    }
    wait_outside(kBlindWait, descriptor);
  }
}

// --- the loop ---

hal::Status FootbotBridge::wait_active(TimeNs timeout_ns) {
  std::unique_lock lock(mutex_);
  if (active_within(lock, timeout_ns)) return {};
  const std::string who = "foot-bot '" + std::string(driver_.robot().id()) + "' is not there: ";
  if (!link_.trouble().empty()) return hal::Error{who + link_.trouble()};
  const std::string trouble = driver_.trouble();
  return hal::Error{who + (trouble.empty() ? "its nodes do not answer" : trouble) + "; " + advice()};
}

// --- what is known ---

std::string FootbotBridge::trouble() const {
  const std::lock_guard lock(mutex_);
  return link_.trouble().empty() ? driver_.trouble() : link_.trouble();
}

std::string FootbotBridge::advice() const {
  return "is it switched on, and are its nodes and their variables called as in the map?";
}

std::string FootbotBridge::identity() const {
  const std::lock_guard lock(mutex_);
  std::string modules;
  for (const NodeStatus& node : driver_.wiring().nodes()) {
    if (node.state == aseba::NodeState::Ready) modules += (modules.empty() ? "" : ", ") + node.name;
  }
  return modules;
}

std::string FootbotBridge::link() const {
  const std::lock_guard lock(mutex_);
  return link_.name();
}

StopMessages FootbotBridge::stop_messages() const {
  const std::lock_guard lock(mutex_);
  return {.robot = settings_.driver.robot.id,
          .kind = std::string(hal::footbot::kName),
          .link = absolute_link(settings_.link),
          .body = to_stop_body(driver_.wiring().rest_messages()),
          .version = driver_.wiring().rest_version()};
}

LinkReport FootbotBridge::report() const {
  const std::lock_guard lock(mutex_);
  LinkReport report;
  TimeNs sum_round_trip_ns = 0;
  for (const NodeStatus& node : driver_.wiring().nodes()) {
    report.questions += node.statistics.reads;
    report.answers += node.statistics.answers;
    report.time_outs += node.statistics.asked_again + node.statistics.unanswered;
    report.bad_answers += node.statistics.wrong_length + node.statistics.not_understood;
    sum_round_trip_ns += node.statistics.sum_round_trip_ns;
    report.max_round_trip_ns = std::max(report.max_round_trip_ns, node.statistics.max_round_trip_ns);
  }
  if (report.answers > 0) report.mean_round_trip_ns = sum_round_trip_ns / static_cast<TimeNs>(report.answers);
  report.resynchronised = driver_.statistics().recovered;
  report.links_lost = driver_.statistics().lost;
  return report;
}

void FootbotBridge::describe(StatusVisitor& visitor) const {
  const BridgeStatus s = status();
  visitor.text("state", state_name(s.state));
  visitor.count("messages_in", s.messages.received);
  visitor.count("messages_out", s.messages.sent);
  visitor.count("messages_dropped", s.messages.dropped);
  visitor.count("interruptions", s.driver.link_stops);
  visitor.count("restarts", s.driver.restarts);
  visitor.count("stops_for_want_of_commands", s.driver.watchdog_stops);
  visitor.count("other_hosts", s.network.other_hosts);
  visitor.count("not_understood", s.network.not_understood);
  visitor.count("counter_jumps", s.wiring.counter_jumps);
  visitor.count("not_obeyed", s.wiring.not_obeyed);
  visitor.count("commands_clamped", s.driver.clamped);
  visitor.count("commands_not_finite", s.driver.not_finite);
  visitor.count("links_opened", s.links_opened);
  visitor.begin_list("nodes");
  for (const NodeStatus& n : s.nodes) {
    visitor.begin_row();
    visitor.text("name", n.name);
    visitor.number("id", n.id);
    visitor.flag("needed", n.needed);
    visitor.text("state", aseba::node_state_name(n.state));
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

bool FootbotBridge::at_rest() const noexcept {
  const std::lock_guard lock(mutex_);
  return driver_.at_rest();
}

BridgeStatus FootbotBridge::status() const {
  const std::lock_guard lock(mutex_);
  BridgeStatus status;
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

}  // namespace tandem::bridges::footbot
