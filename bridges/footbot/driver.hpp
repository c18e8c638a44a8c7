// One foot-bot without threads: its bus, the wiring of its ports, and safety, driven by whoever owns the time.
//
//   absent --link up--> searching --every needed node is there--> ready --its values came--> active
//   active --a needed node does not answer, or describes itself anew--> suspect --it answers--> active
//   active, suspect --a needed node is silent, or nothing passes on the link--> lost --it is back--> ready
//
// A tick of the caller:   latch(tick, now) -> controller step -> commit(now)
// Between ticks, whenever something may have come or `next_deadline()` is due: pump(now).
// Commands leave within `commit`. Readings are asked for just before the next `latch`, as early as they took of late to
// come: they are young when the controller sees them. No time-out counts what our own thread was late.
//
// The modules have no watchdog of their own: they keep their last command for ever. So the robot is told to rest in
// every case of the table, and told again until it has confirmed:
//   needed node lost, link lost, not yet active  -> rest; drives on once all answer again
//   such a node restarted: it holds zeros that nobody wrote, or its counters begin anew
//                                                -> rest, and told as a stop of the robot's own
//   no commit for `command_timeout_ns`           -> rest, until the next commit
//   `stop`                                       -> rest until `resume`
//   command not finite, or beyond the limits     -> the safe one, or clamped; counted
#pragma once
#include <string>

#include "bridges/aseba/network.hpp"
#include "bridges/footbot/wiring.hpp"
#include "bridges/link/stall_meter.hpp"
#include "hal/log.hpp"

namespace tandem::bridges::footbot {

enum class RobotState : std::uint8_t { Absent, Searching, Ready, Active, Suspect, Lost };
const char* state_name(RobotState state) noexcept;

struct DriverSettings {
  RobotSettings robot = {};
  FootbotMap map = {};
  aseba::NetworkTiming timing = {};
  /// The robot is stopped when no commit came for so long: the loop hangs, or the controller does.
  hal::TimeNs command_timeout_ns = 500 * hal::kNsPerMs;
  /// Age of a needed reading from which the robot is stopped, beside what this machine was late of late (StallMeter);
  /// 0: two and a half ticks, at least 250 ms.
  hal::TimeNs suspect_ns = 0;
  bool observe = false;  ///< nothing is ever written
};

struct DriverStatistics {
  std::uint64_t commits = 0;
  std::uint64_t clamped = 0;         ///< commands beyond the robot's limits
  std::uint64_t not_finite = 0;      ///< commands with NaN or infinity: made safe
  std::uint64_t rearmed = 0;         ///< times that driving began anew after an interruption
  std::uint64_t watchdog_stops = 0;  ///< for want of commits
  std::uint64_t link_stops = 0;      ///< because a needed node, or the link, did not answer
  std::uint64_t restarts = 0;        ///< of modules that it never drives without, since it was first active
  std::uint64_t stops_confirmed = 0;
  std::uint64_t recovered = 0;  ///< times it became Active again
  std::uint64_t lost = 0;       ///< times it became Lost
  std::uint64_t stalls = 0;     ///< times that our own thread came too late
  hal::TimeNs longest_stall_ns = 0;
};

/// Not thread-safe.
class FootbotDriver {
 public:
  /// `link` must outlive this.
  FootbotDriver(DriverSettings settings, aseba::MessageLink& link, hal::Log log = {});
  FootbotDriver(const FootbotDriver&) = delete;
  FootbotDriver& operator=(const FootbotDriver&) = delete;

  /// To construct a controller with, and to take further ports from.
  FootbotRobot& robot() noexcept { return robot_; }
  const FootbotRobot& robot() const noexcept { return robot_; }

  /// Ports were taken: from now on they count. Every `commit` does the same.
  void note_ports() noexcept { wiring_.note_demand(); }
  /// Fills the ports that were taken with the newest values.
  void latch(hal::Tick tick, hal::TimeNs now) noexcept;
  /// Filters the commands and sends what changed, asks for new readings.
  void commit(hal::TimeNs now) noexcept;
  /// Takes in what has arrived, applies time-outs, sends what is due. Never waits.
  void pump(hal::TimeNs now) noexcept;
  hal::TimeNs next_deadline() const noexcept;

  /// Stops the robot now and keeps it stopped until `resume`.
  void stop(hal::TimeNs now) noexcept;
  void resume() noexcept { halted_ = false; }

  RobotState state() const noexcept { return state_; }
  bool stopped() const noexcept { return halted_; }
  /// The last stop was confirmed by the robot, and nothing that moves it was sent since.
  bool at_rest() const noexcept { return at_rest_; }
  /// Why it is not Active, or what else is missing; for people.
  std::string trouble() const;
  const DriverStatistics& statistics() const noexcept { return statistics_; }
  const Wiring& wiring() const noexcept { return wiring_; }
  const aseba::Network& network() const noexcept { return network_; }

 private:
  void update_state(hal::TimeNs now);
  RobotState judge(hal::TimeNs now) const noexcept;
  void rest(hal::TimeNs now) noexcept;
  void count(const hal::Limited& limited) noexcept;
  void filter_commands() noexcept;
  void send_commands(hal::TimeNs now) noexcept;
  void ask(hal::TimeNs now) noexcept;
  void plan_question(hal::TimeNs now) noexcept;
  void take_turn(hal::TimeNs now) noexcept;
  bool look_for_restarts(hal::TimeNs now) noexcept;

  DriverSettings settings_;
  hal::Log log_;
  FootbotRobot robot_;
  aseba::Network network_;
  Wiring wiring_;
  DriverStatistics statistics_;
  RobotState state_ = RobotState::Absent;
  bool was_active_ = false;
  bool halted_ = false;
  bool driving_ = false;      // commands, and not rest, were sent last
  bool interrupted_ = false;  // the next driving begins anew
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

}  // namespace tandem::bridges::footbot
