// Interface of a real robot behind the control interface: one class a kind of robot serves every command.
//
//   bridge->robot(), bridge->port()  a controller's ports; those that were taken decide what the robot is asked for
//   bridge->start()                  its own I/O thread opens the link and finds the robot
//   each tick: latch -> controller step -> commit
//   stop / resume                    by the judge of whether it may move
//   shut_down                        stops the robot, waits a little for it to confirm, closes the link
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/clock_estimator.hpp"
#include "bridges/robot_identity.hpp"
#include "bridges/round_trips.hpp"
#include "bridges/stop_messages.hpp"
#include "hal/port.hpp"
#include "hal/robot.hpp"
#include "hal/time.hpp"

namespace tandem::bridges {

/// Connecting: never answered yet. Suspect: some answers are missing, or it stopped by itself since the last `latch`
/// (a restart, its own fail-safe), even if it has recovered. Lost: none came for longer than the time-out.
enum class LinkHealth : std::uint8_t { Connecting, Active, Suspect, Lost };

/// Statistics of the conversation with one robot, in the same words for every kind.
struct LinkReport {
  std::uint64_t questions = 0;       ///< that want an answer
  std::uint64_t answers = 0;         ///< whole and plausible; never more than `questions`
  std::uint64_t time_outs = 0;       ///< answers that did not come, or not whole
  std::uint64_t bad_answers = 0;     ///< implausible ones
  std::uint64_t resynchronised = 0;  ///< times it was lost and found again
  std::uint64_t links_lost = 0;
  hal::TimeNs mean_round_trip_ns = 0;
  hal::TimeNs max_round_trip_ns = 0;
  hal::TimeNs median_round_trip_ns = 0;
  hal::TimeNs p99_round_trip_ns = 0;
  hal::TimeNs round_trip_jitter_ns = 0;  ///< mean change from one to the next
  std::optional<ClockState> clock = {};  ///< of the robot; nothing: its messages carry no stamps

  void set(const RoundTrips& trips) noexcept {
    mean_round_trip_ns = trips.mean_ns();
    max_round_trip_ns = trips.largest_ns();
    median_round_trip_ns = trips.durations.quantile_ns(0.5);
    p99_round_trip_ns = trips.durations.quantile_ns(0.99);
    round_trip_jitter_ns = trips.jitter_ns();
  }
};

/// Takes over what a bridge knows of itself, for reports: names in snake_case, values by type.
class StatusVisitor {
 public:
  virtual ~StatusVisitor() = default;
  virtual void text(std::string_view name, std::string_view value) = 0;
  virtual void count(std::string_view name, std::uint64_t value) = 0;
  virtual void number(std::string_view name, double value) = 0;
  virtual void flag(std::string_view name, bool value) = 0;
  /// Rows of values, each begun with `begin_row`.
  virtual void begin_list(std::string_view name) = 0;
  virtual void begin_row() = 0;
  virtual void end_row() = 0;
  virtual void end_list() = 0;
};

/// A port that was taken.
struct PortView {
  const hal::PortType* type;
  void* data;
};

/// A real robot. No call but `shut_down` waits for the robot; `latch`, `commit`, `stop`, `resume` do not allocate.
/// They, `robot()`, `port()` and `set_origin` belong to the loop's thread; the rest may be called from any. Times are
/// CLOCK_MONOTONIC.
class RobotBridge {
 public:
  virtual ~RobotBridge() = default;

  virtual hal::Robot& robot() noexcept = 0;
  /// The port of that type, taken if it was not yet, also where the configuration does not list it; null when the robot
  /// has no such device that can be reached. Compared by name, role and layout. Lives as long as the bridge.
  virtual void* port(const hal::PortType& type) noexcept = 0;
  /// Ports that were taken, in this order.
  virtual std::vector<PortView> taken() const = 0;
  /// Readings are stamped from here.
  virtual void set_origin(hal::TimeNs origin_ns) noexcept = 0;

  /// Starts the I/O thread. Once, after the ports were taken.
  virtual void start() = 0;
  /// Stops the robot, waits a little for it to confirm, ends the thread. The destructor does the same.
  virtual void shut_down() = 0;

  virtual void latch(hal::Tick tick, hal::TimeNs now) noexcept = 0;
  virtual void commit(hal::TimeNs now) noexcept = 0;
  /// Stops the robot now, keeps trying until it confirms, and ignores commands until `resume`. One that flies hovers.
  virtual void stop(hal::TimeNs now) noexcept = 0;
  /// `stop`; one that flies lands as well, without anybody's waiting.
  virtual void land(hal::TimeNs now) noexcept { stop(now); }
  virtual void resume() noexcept = 0;

  /// As of the last `latch`.
  virtual LinkHealth health() const noexcept = 0;
  /// Between the last two calls of `latch` the robot restarted, or its own fail-safe took over; also when all is well
  /// again.
  virtual bool stopped_itself() const noexcept { return false; }
  /// It answers, and is another one than the settings say: waiting for it is in vain. `trouble` says what differs.
  virtual bool mismatched() const noexcept { return false; }
  /// Whether the robot itself has confirmed the last `stop`, and nothing that moves it was sent since.
  virtual bool at_rest() const noexcept = 0;
  /// What is wrong, for people; empty when nothing is.
  virtual std::string trouble() const = 0;
  /// What people can look at when it does not answer: "is it switched on, …?"
  virtual std::string advice() const = 0;
  /// Who answers over which device. Words of the robot are absent until it has told them on the device as it is open
  /// now; while there is none, the device is the last one. `stop_version` tells when to ask again.
  virtual RobotIdentity identity() const = 0;
  /// How a guardian stops it as it is now, and its identity.
  virtual StopMessages stop_messages() const = 0;
  /// Cheap; grows whenever `identity` or `stop_messages` would answer otherwise. With a robot that becomes Active, at
  /// the latest.
  virtual std::uint64_t stop_version() const noexcept = 0;

  virtual LinkReport report() const = 0;
  /// Everything known, for the report.
  virtual void describe(StatusVisitor& visitor) const = 0;
};

}  // namespace tandem::bridges
