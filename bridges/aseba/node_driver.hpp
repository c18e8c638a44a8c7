// A robot of ASEBA nodes without threads: its bus, the wiring of its ports, and safety, driven by the owner of the
// time.
//   absent --link up--> searching --every needed node is there--> ready --its values came--> active
//   active --a needed node does not answer, or describes itself again--> suspect --it answers--> active
//   active, suspect --a needed node is silent, or nothing passes on the link--> lost --it is back--> ready
//
// A tick of the caller:   latch(tick, now) -> controller step -> commit(now)
// Between ticks, whenever something may have come or `next_deadline()` is due: pump(now).
// Commands leave within `commit`. Readings are asked for just before the next `latch`, as early as they took of late to
// come: they are young when the controller sees them. No time-out counts what our own thread was late.
//
// Nodes may keep their last command for ever. So the robot is told to rest in every case of the table, and told again
// until it has confirmed:
//   needed node lost, link lost, not yet active  -> rest; drives on once all answer again
//   such a node restarted: it holds zeros that were never written, or its counters start again
//                                                -> rest, and told as a stop of the robot's own
//   no commit for `command_timeout_ns`           -> rest, until the next commit
//   `stop`                                       -> rest until `resume`
//   command not finite, or beyond the limits     -> the safe one, or clamped; counted
//
// `Parts` is what one kind of robot adds:
//   Settings, Robot, Wiring     classes: a NodeDriverSettings, a NodeRobot, a NodeWiring
//   kNoun                       "foot-bot", in messages
//   make_robot(const Settings&), make_wiring(const Settings&, Network&, Robot&)
// A wiring carries values between the robot's ports and the nodes' variables. It has these, whose contracts stand in
// bridges/footbot/wiring.hpp: note_demand, look, look_for_restarts, serve, fill, ask, command, rest, rests,
// complete, lost_needed, oldest_ns, trouble, needed_trouble, nodes, rest_messages, rest_version, statistics.
#pragma once
#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "bridges/aseba/network.hpp"
#include "bridges/aseba/rest_message.hpp"
#include "bridges/bridged_robot.hpp"
#include "bridges/link/stall_meter.hpp"
#include "bridges/reckoning.hpp"
#include "hal/log.hpp"

namespace tandem::bridges::aseba {

enum class RobotState : std::uint8_t { Absent, Searching, Ready, Active, Suspect, Lost };
const char* state_name(RobotState state) noexcept;

/// A node that a robot has, as it is on the bus.
struct NodeStatus {
  std::string name;  ///< its own, or the expected one while it is not there
  int id = -1;       ///< -1: not there
  NodeState state = NodeState::Absent;
  bool needed = false;            ///< without it the robot does not drive
  std::string trouble;            ///< why it cannot be used; "" when it can
  std::uint64_t times_wired = 0;  ///< more than once: it was lost, restarted, or another one took its place
  NodeStatistics statistics = {};
};

/// Ports of a robot of nodes, on two wheels, whose odometry follows from the wheels' encoders.
class NodeRobot : public BridgedRobot {
 public:
  NodeRobot(std::string_view noun, const hal::RobotKind& kind, RobotSettings settings,
            std::span<const hal::PortType* const> types);

  /// Whether the port is read or written, be it only the odometry. `type` is one that the robot was made with.
  bool uses(const hal::PortType& type) const noexcept;
  template <class T>
  bool uses() const noexcept {
    return uses(hal::port_type<T>());
  }
  /// What follows from the readings that were just filled: clock and odometry.
  void complete(hal::Tick tick) noexcept;

 private:
  Reckoning reckoning_;
};

/// What all wirings have.
class NodeWiring {
 public:
  /// Grows whenever `rest_messages` may have changed.
  std::uint64_t rest_version() const noexcept { return rest_version_; }
  /// Forgets what was to be written: it rests from now on.
  void forget_writes(hal::TimeNs now) noexcept {
    network_.forget_writes();
    rested_ns_ = now;
  }

 protected:
  /// `network` must outlive this. `observe`: nothing is ever written.
  NodeWiring(Network& network, bool observe) : network_(network), observe_(observe) {}

  /// Whether other nodes are there than at the last look, or others are described.
  bool others_are_there() noexcept;
  static NodeStatus status_of(const Node* node, std::string name, bool needed, std::string trouble,
                              std::uint64_t times_wired);
  /// Nothing where they are too many.
  static std::optional<RestMessage> rest_message(const Node& node, std::size_t address,
                                                 std::span<const std::int16_t> words, bool confirm);

  Network& network_;
  bool observe_;
  std::uint64_t rest_version_ = 0;
  hal::TimeNs rested_ns_ = 0;  // when everything was last ordered to rest

 private:
  std::uint64_t seen_ = ~std::uint64_t{0};  // fingerprint of the nodes
};

struct NodeDriverSettings {
  RobotSettings robot = {};
  NetworkTiming timing = {};
  /// The robot is stopped when no commit came for so long: the loop hangs, or the controller does.
  hal::TimeNs command_timeout_ns = 500 * hal::kNsPerMs;
  /// Age of a needed reading from which the robot is stopped, beside what this machine was late of late (StallMeter);
  /// 0: two and a half ticks, at least 250 ms.
  hal::TimeNs suspect_ns = 0;
  bool observe = false;  ///< nothing is ever written
};

struct NodeDriverStatistics {
  std::uint64_t commits = 0;
  std::uint64_t clamped = 0;         ///< commands beyond the robot's limits
  std::uint64_t not_finite = 0;      ///< commands with NaN or infinity: made safe
  std::uint64_t rearmed = 0;         ///< times that driving started again after an interruption
  std::uint64_t watchdog_stops = 0;  ///< for want of commits
  std::uint64_t link_stops = 0;      ///< because a needed node, or the link, did not answer
  std::uint64_t restarts = 0;        ///< of nodes that it never drives without, since it was first active
  std::uint64_t stops_confirmed = 0;
  std::uint64_t recovered = 0;  ///< times it became Active again
  std::uint64_t lost = 0;       ///< times it became Lost
  std::uint64_t stalls = 0;     ///< times that our own thread came too late
  hal::TimeNs longest_stall_ns = 0;
};

namespace detail {
inline constexpr hal::TimeNs kSayAgain = 50 * hal::kNsPerMs;  // a stop that is not confirmed
inline constexpr hal::TimeNs kLeastSuspect = 250 * hal::kNsPerMs;
inline constexpr hal::TimeNs kSpare = 8 * hal::kNsPerMs;  // between the last answer and the tick that uses it

/// The lines of the nodes, with the robot's name before them.
hal::Log named(const hal::Log& log, const std::string& who);
}  // namespace detail

/// Not thread-safe.
template <class Parts>
class NodeDriver {
 public:
  using Settings = typename Parts::Settings;
  using Robot = typename Parts::Robot;
  using Wiring = typename Parts::Wiring;

  /// `link` must outlive this.
  NodeDriver(Settings settings, MessageLink& link, hal::Log log = {})
      : settings_(std::move(settings)),
        log_(std::move(log)),
        robot_(Parts::make_robot(settings_)),
        network_(link, settings_.timing, detail::named(log_, who())),
        wiring_(Parts::make_wiring(settings_, network_, robot_)) {
    settings_.robot.tick_ns = std::max<hal::TimeNs>(settings_.robot.tick_ns, 1);
    if (settings_.suspect_ns <= 0) {
      settings_.suspect_ns = std::max(detail::kLeastSuspect, settings_.robot.tick_ns * 5 / 2);
    }
  }
  NodeDriver(const NodeDriver&) = delete;
  NodeDriver& operator=(const NodeDriver&) = delete;

  /// To construct a controller with, and to take further ports from.
  Robot& robot() noexcept { return robot_; }
  const Robot& robot() const noexcept { return robot_; }

  /// Ports were taken: from now on they count. Every `commit` does the same.
  void note_ports() noexcept { wiring_.note_demand(); }
  /// Fills the ports that were taken with the newest values.
  void latch(hal::Tick tick, hal::TimeNs now) noexcept {
    latched_ns_ = now;
    wiring_.fill(now);
    robot_.complete(tick);
  }
  /// Filters the commands and sends what changed, asks for new readings.
  void commit(hal::TimeNs now) noexcept {
    ++statistics_.commits;
    last_commit_ns_ = now;
    wiring_.note_demand();
    update_state(now);
    const bool drive = !halted_ && !settings_.observe && state_ == RobotState::Active;
    if (drive) {
      at_rest_ = resting_ = false;
      driving_ = true;
      send_commands(now);
    } else {
      interrupted_ = interrupted_ || was_active_;
      if (driving_) rest(now);
      wiring_.command(false, now);
    }
    plan_question(now);
    pump(now);
  }
  /// Takes in what has arrived, applies time-outs, sends what is due. Never waits.
  void pump(hal::TimeNs now) noexcept {
    take_turn(now);
    bool more = wiring_.serve(now);
    more = look_for_restarts(now) || more;
    if (wiring_.look()) {
      if (!driving_) wiring_.command(false, now);  // a module that is new here rests until told otherwise
      ask(now);
      more = true;
    } else if ((ask_at_ns_ != 0 && now >= ask_at_ns_) || now - asked_ns_ >= settings_.robot.tick_ns * 5 / 2) {
      ask(now);  // as planned; or the loop does not run, or not yet
      more = true;
    }
    update_state(now);
    if (driving_ && state_ != RobotState::Active) {
      ++statistics_.link_stops;
      rest(now);
      more = true;
    }
    if (driving_ && now - last_commit_ns_ > settings_.command_timeout_ns) {
      ++statistics_.watchdog_stops;
      log_.warning(who() + "stopped, no commands came for " + std::to_string((now - last_commit_ns_) / hal::kNsPerMs) +
                   " ms");
      rest(now);
      more = true;
    }
    if (resting_ && wiring_.rests()) {
      resting_ = false;
      at_rest_ = true;
      ++statistics_.stops_confirmed;
    }
    if (resting_ && now - rest_said_ns_ >= detail::kSayAgain) {
      rest_said_ns_ = now;
      wiring_.rest(now);
      more = true;
    }
    if (more) network_.poll(now);
  }
  hal::TimeNs next_deadline() const noexcept {
    hal::TimeNs deadline = std::min(network_.next_deadline(), asked_ns_ + settings_.robot.tick_ns * 5 / 2);
    if (ask_at_ns_ != 0) deadline = std::min(deadline, ask_at_ns_);
    if (driving_) deadline = std::min(deadline, last_commit_ns_ + settings_.command_timeout_ns + 1);
    if (resting_) deadline = std::min(deadline, rest_said_ns_ + detail::kSayAgain);
    return deadline;
  }

  /// Stops the robot now and keeps it stopped until `resume`.
  void stop(hal::TimeNs now) noexcept {
    halted_ = true;
    rest(now);
    pump(now);
  }
  void resume() noexcept { halted_ = false; }

  RobotState state() const noexcept { return state_; }
  bool stopped() const noexcept { return halted_; }
  /// The last stop was confirmed by the robot, and nothing that moves it was sent since.
  bool at_rest() const noexcept { return at_rest_; }
  /// Why it is not Active, or what else is missing; for people.
  std::string trouble() const {
    if (network_.carrier() != Carrier::Up) return "nothing passes on the link";
    const std::string missing = wiring_.needed_trouble();
    if (!missing.empty()) return missing;
    if (state_ == RobotState::Suspect) return "a node that is needed does not answer";
    return wiring_.trouble();
  }
  const NodeDriverStatistics& statistics() const noexcept { return statistics_; }
  const Wiring& wiring() const noexcept { return wiring_; }
  const Network& network() const noexcept { return network_; }

 private:
  /// "foot-bot 'fb0': ", before lines of the log.
  std::string who() const { return std::string(Parts::kNoun) + " '" + settings_.robot.id + "': "; }
  void update_state(hal::TimeNs now) {
    const RobotState next = judge(now);
    if (next == state_) return;
    const RobotState before = state_;
    state_ = next;
    if (next == RobotState::Active) {
      statistics_.recovered += was_active_ ? 1 : 0;
      interrupted_ = interrupted_ || was_active_;
      was_active_ = true;
      const std::string missing = wiring_.trouble();
      log_.info(who() + "active" + (missing.empty() ? "" : ", but " + missing));
      return;
    }
    if (next == RobotState::Lost) ++statistics_.lost;
    if (before == RobotState::Active || next == RobotState::Lost) {
      log_.warning(who() + state_name(next) + ": " + trouble());
    }
  }
  RobotState judge(hal::TimeNs now) const noexcept {
    if (network_.carrier() != Carrier::Up) {
      if (was_active_) return RobotState::Lost;
      return state_ == RobotState::Absent ? RobotState::Absent : RobotState::Searching;
    }
    if (!wiring_.complete()) {
      if (!was_active_) return RobotState::Searching;
      return wiring_.lost_needed() ? RobotState::Lost : RobotState::Suspect;
    }
    const hal::TimeNs oldest = wiring_.oldest_ns();
    if (oldest == 0) return RobotState::Ready;
    if (now - std::min(oldest, now) <= settings_.suspect_ns + stalls_.patience_ns(now)) return RobotState::Active;
    return was_active_ ? RobotState::Suspect : RobotState::Ready;
  }
  void rest(hal::TimeNs now) noexcept {
    if (settings_.observe) return;
    driving_ = false;
    resting_ = true;
    at_rest_ = false;
    rest_said_ns_ = now;
    interrupted_ = true;
    wiring_.forget_writes(now);
    wiring_.rest(now);
  }
  void count(const hal::Limited& limited) noexcept {
    statistics_.clamped += limited.result == hal::LimitResult::Clamped ? 1 : 0;
    statistics_.not_finite += limited.result == hal::LimitResult::NotFinite ? 1 : 0;
  }
  /// Limits the commands in their ports.
  void filter_commands() noexcept {
    robot_.limit_commands([this](const hal::Limited& limited) { count(limited); });
    statistics_.rearmed += interrupted_ ? 1 : 0;
    interrupted_ = false;
  }
  /// What the controller wrote stays as it is: it may write once and never again.
  void send_commands(hal::TimeNs now) noexcept {
    robot_.keep_commands();
    filter_commands();
    wiring_.command(true, now);
    robot_.restore_commands();
  }
  void ask(hal::TimeNs now) noexcept {
    asked_ns_ = now;
    ask_at_ns_ = 0;
    answers_open_ = true;
    wiring_.ask(now);
  }
  /// The next tick's readings are asked for so late that they are just there when it begins.
  void plan_question(hal::TimeNs now) noexcept {
    const hal::TimeNs tick_ns = settings_.robot.tick_ns;
    const bool ticks = latched_ns_ != 0 && now - latched_ns_ < tick_ns;
    const hal::TimeNs lead = round_ns_ + round_ns_ / 4 + detail::kSpare;
    if (!ticks || round_ns_ == 0 || latched_ns_ + tick_ns - lead <= now) return ask(now);
    ask_at_ns_ = latched_ns_ + tick_ns - lead;
  }
  void take_turn(hal::TimeNs now) noexcept {
    const hal::TimeNs stall = stalls_.turn(now);
    if (stall > 0) {
      ++statistics_.stalls;
      statistics_.longest_stall_ns = std::max(statistics_.longest_stall_ns, stall);
      network_.stalled(stall);
    }
    network_.poll(now);
    if (!answers_open_ || network_.reading()) return;
    answers_open_ = false;
    round_ns_ = std::max<hal::TimeNs>({now - asked_ns_, round_ns_ - round_ns_ / 50, 1});
  }
  /// A module that lost its memory has stopped, and may have more than that to be told: nothing moves until the loop
  /// has been told. @returns whether there is something to send.
  bool look_for_restarts(hal::TimeNs now) noexcept {
    const std::string what = wiring_.look_for_restarts();
    if (what.empty() || !was_active_) return false;
    ++statistics_.restarts;
    log_.warning(who() + what);
    if (driving_) rest(now);
    return true;
  }

  Settings settings_;
  hal::Log log_;
  Robot robot_;
  Network network_;
  Wiring wiring_;
  NodeDriverStatistics statistics_;
  RobotState state_ = RobotState::Absent;
  bool was_active_ = false;
  bool halted_ = false;
  bool driving_ = false;      // commands, and not rest, were sent last
  bool interrupted_ = false;  // the next driving starts again
  hal::TimeNs last_commit_ns_ = 0;
  StallMeter stalls_;
  hal::TimeNs latched_ns_ = 0;
  hal::TimeNs asked_ns_ = 0;
  hal::TimeNs ask_at_ns_ = 0;  // 0: no question is planned
  bool answers_open_ = false;  // of the last question
  hal::TimeNs round_ns_ = 0;   // from a question to the last answer, the longest of late
  bool at_rest_ = false;
  bool resting_ = false;  // rest was said and is not confirmed
  hal::TimeNs rest_said_ns_ = 0;
};

}  // namespace tandem::bridges::aseba
