// One e-puck without threads: robot, session and safety, driven by the owner of the time.
//
// A tick of the caller:   latch(tick, now) -> controller step -> commit(now) -> pump(link, now)
// Between ticks, whenever bytes may have come or `next_deadline()` is due, and at least each 20 ms: pump(link, now).
//
// Commands leave at once. The question whose answer fills the ports of tick k + 1 leaves as late as it may: the next
// latch is foreseen from the last ones, a round trip is foreseen from the last ones and the bytes' own time, and a
// margin grows when answers came too late. When a tick is too short for that, both leave in one packet.
#pragma once
#include <memory>
#include <string>

#include "bridges/epuck/robot.hpp"
#include "bridges/link/link.hpp"
#include "bridges/link/stall_meter.hpp"
#include "hal/device/wheels.hpp"
#include "hal/log.hpp"

namespace tandem::bridges::epuck {

struct DriverSettings {
  RobotSettings robot = {};
  SessionTiming timing = {};
  WireForm wire = WireForm::Serial;
  /// The robot is stopped when no commit came for so long: the loop hangs, or the controller does.
  hal::TimeNs command_timeout_ns = 500 * hal::kNsPerMs;
};

struct DriverStatistics {
  std::uint64_t commits = 0;
  std::uint64_t clamped = 0;         ///< commands beyond the robot's speed
  std::uint64_t not_finite = 0;      ///< commands with NaN or infinity: made 0
  std::uint64_t rearmed = 0;         ///< times that driving started again after an interruption
  std::uint64_t watchdog_stops = 0;  ///< for want of commits
  std::uint64_t refused_bytes = 0;   ///< that the link did not take
  std::uint64_t late_answers = 0;    ///< not there when they were to be latched
  std::uint64_t stalls = 0;          ///< times that `pump` was called late (StallMeter)
};

/// Distance that the wheels rolled, by their counters.
struct Odometry {
  double left_m = 0.0;
  double right_m = 0.0;
  hal::TimeNs taken_ns = 0;   ///< when the robot measured it, on the link's clock; 0: nothing yet
  std::uint64_t rebased = 0;  ///< grows when motion in between is unknown (restart, long loss)
};

/// Safety as a table:
///   first connection, standing      -> commands pass
///   link lost, step lost, restart   -> robot stopped by the session; commands are ignored until a fresh answer
///   no commit for command_timeout   -> stop; the next commit's commands pass
///   `stop()`                        -> stop; commands are safe until `resume()`
///   NaN, infinite, too fast         -> 0, 0, clamped; counted
/// How fast it may drive after any of these is decided above. Not thread-safe.
class EpuckDriver {
 public:
  explicit EpuckDriver(DriverSettings settings, hal::Log log = {});

  /// To construct a controller with, and to take further ports from.
  EpuckRobot& robot() noexcept { return robot_; }
  const EpuckRobot& robot() const noexcept { return robot_; }

  /// Fills the ports that were taken with the newest values.
  void latch(hal::Tick tick, hal::TimeNs now) noexcept;
  /// Filters the commands, queues them and the next question. Send them at once with `pump`.
  void commit(hal::TimeNs now) noexcept;
  /// Sends what is due, takes in what has arrived, applies time-outs. Never waits.
  /// `latch`, `commit`, `pump`, `stop` and `resume` do not allocate.
  void pump(ByteLink& link, hal::TimeNs now) noexcept;
  /// There is no link at present.
  void link_gone(hal::TimeNs now) noexcept { session_->link_down(now); }
  hal::TimeNs next_deadline() const noexcept;
  /// Logs what has changed since the last call. For the thread that owns the link.
  void tell();

  /// Stops the robot and keeps it stopped, LEDs off, until `resume`. Sent with the next `pump`.
  void stop(hal::TimeNs now) noexcept;
  void resume() noexcept { halted_ = false; }
  /// The end: stops the robot whatever it is doing. Then pump until `idle`, for a little while.
  void shut_down(hal::TimeNs now) noexcept;

  SessionState state() const noexcept { return session_->state(); }
  const Conversation& session() const noexcept { return *session_; }
  /// Fills in what the robot has told of itself since the link was opened.
  void identify(RobotIdentity& identity) const;
  /// The link is of no more use, although it is open: close it, say `link_gone`, reopen it.
  bool wants_new_link() const noexcept { return session_->wants_new_link(); }
  const DriverStatistics& statistics() const noexcept { return statistics_; }
  Odometry odometry() const noexcept;
  bool stopped() const noexcept { return halted_; }
  /// The robot itself has confirmed that it stands, and nothing that moves it was sent since.
  bool at_rest() const noexcept { return session_->at_rest(); }
  /// Nothing is awaited from the robot.
  bool idle() const noexcept { return session_->idle(); }

 private:
  void send(ByteLink& link) noexcept;
  void tell_accelerometer(const std::string& who);
  void tell_untold(const std::string& who);
  hal::WheelSpeeds filtered() noexcept;
  void foresee_latch(hal::TimeNs now) noexcept;
  void judge_margin() noexcept;
  void ask_when_due(hal::TimeNs now) noexcept;
  void notice_stall(hal::TimeNs now) noexcept;

  DriverSettings settings_;
  hal::Log log_;
  EpuckRobot robot_;
  const hal::DifferentialDrive& wheels_;
  std::unique_ptr<Conversation> session_;
  DriverStatistics statistics_;
  SessionState logged_ = SessionState::Absent;
  bool halted_ = false;
  bool moving_ = false;            // speeds other than 0 were handed to the session
  bool interrupted_ = false;       // the next driving starts again
  std::uint64_t armed_epoch_ = 0;  // 0: not yet
  hal::TimeNs last_commit_ns_ = 0;
  hal::TimeNs next_latch_ns_ = 0;  // foreseen; 0: not yet
  hal::TimeNs ask_due_ns_;         // never: no question waits for its time
  hal::TimeNs asked_ns_ = 0;       // for the next latch; 0: not
  hal::TimeNs margin_ns_;
  StallMeter stalls_;
  std::uint64_t told_watchdog_stops_ = 0;
  std::string logged_untold_;
  AccelerometerCheck::Verdict logged_accelerometer_ = AccelerometerCheck::Verdict::Unchecked;
};

}  // namespace tandem::bridges::epuck
