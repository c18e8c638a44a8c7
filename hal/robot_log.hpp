// Messages of controllers to people: each names its robot and the tick; their number is limited.
#pragma once
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include "hal/log.hpp"
#include "hal/time.hpp"

namespace tandem::hal {

/// Takes messages of one robot to the run's log, kBurst at once and then one each kRefill_ns of the run. The others go
/// where all are kept, if anywhere; else their number is told with the next. A value, to be kept by the controller.
/// Take it from Robot::log(); the default one drops everything.
class RobotLog {
 public:
  static constexpr int kBurst = 10;
  static constexpr TimeNs kRefill_ns = kNsPerSecond;

  /// The world that the robot is in.
  class Sink {
   public:
    virtual ~Sink() = default;
    virtual TimeNs now_ns() const noexcept = 0;  ///< since the start of the run
    /// `robot` is what the world gave the log; `left_out` messages before it were too many. May be called from several
    /// threads at once, for different robots.
    virtual void write(std::uint32_t robot, Severity severity, std::string_view text,
                       std::uint32_t left_out) noexcept = 0;
    /// Whether messages beyond the limit are kept, by `keep`.
    virtual bool keeps() const noexcept { return false; }
    /// Takes such a message; as `write`.
    virtual void keep(std::uint32_t /*robot*/, Severity /*severity*/, std::string_view /*text*/) noexcept {}
  };

  RobotLog() = default;
  /// `sink` must outlive all copies.
  RobotLog(Sink& sink, std::uint32_t robot) noexcept : sink_(&sink), robot_(robot) {}

  void info(std::string_view text) noexcept { write(Severity::Info, text); }
  void warning(std::string_view text) noexcept { write(Severity::Warning, text); }
  void error(std::string_view text) noexcept { write(Severity::Error, text); }

 private:
  void write(Severity severity, std::string_view text) noexcept;

  Sink* sink_ = nullptr;
  TimeNs free_ns_ = std::numeric_limits<TimeNs>::min();  // when as many may be written at once as at the start
  std::uint32_t robot_ = 0;
  std::uint32_t left_out_ = 0;
};

/// "robot 'ep3' at tick 120: text (7 messages before it were left out)": what a world hands to its log.
std::string message_of(std::string_view robot, Tick tick, std::string_view text, std::uint32_t left_out);

}  // namespace tandem::hal
