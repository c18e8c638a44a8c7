// What the wheels of a real robot may do, and when: one table, and the way back from a stop.
#pragma once
#include <cstdint>
#include <span>
#include <string_view>

#include "hal/device/flight.hpp"
#include "hal/device/wheels.hpp"
#include "hal/params.hpp"
#include "hal/port.hpp"
#include "hal/time.hpp"

namespace tandem::mixed_reality {

enum class RunPhase : std::uint8_t { Waiting, Running, Stopping };

/// Connecting: never answered yet. Suspect: some answers are missing. Lost: none came for longer than the time-out.
enum class LinkHealth : std::uint8_t { Connecting, Active, Suspect, Lost };

/// All that decides whether a real robot may move.
struct Conditions {
  RunPhase run = RunPhase::Running;
  bool controller_failed = false;  ///< it threw, or a hook stopped it
  LinkHealth link = LinkHealth::Connecting;
  hal::Validity pose = hal::Validity::Absent;
};

/// What the table says to some conditions.
struct Verdict {
  bool may_drive = false;         ///< false: the wheels get 0, every tick
  bool controller_steps = false;  ///< false: it is held, so that it does not run away from a robot that does not follow
  std::string_view reason;        ///< why it may not drive, for people; "driving" when it may
};

/// A row of the table: applies where `applies` is true; the first that does decides.
struct SafetyRule {
  bool (*applies)(const Conditions&) noexcept;
  Verdict verdict;
};
std::span<const SafetyRule> safety_table() noexcept;

/// The verdict of the first row that applies. The last row applies always.
Verdict judge(const Conditions& conditions) noexcept;

/// How a stopped robot gets under way again.
struct RearmParams {
  double settle_s = 0.3;    ///< all must have been well for this long
  double ramp_m_s2 = 0.25;  ///< then the wheels' largest speed grows from 0 by this
  void describe(hal::ParamVisitor& v) {
    v.number("rearm_after", settle_s, hal::unit::s, {0.0, 60.0},
             "All must have been well for this long before a stopped robot drives again.");
    v.number("rearm_ramp", ramp_m_s2, hal::unit::m_s2, {0.001, 100.0},
             "Its wheels' largest speed then grows from 0 by this.");
  }
};

/// Applies the table tick by tick. Stops at once; lets go only after a while, and then by and by.
class Supervisor {
 public:
  explicit Supervisor(const RearmParams& params) : params_(params) {}

  /// Once a tick, before the controllers step. `now_ns` on the run's clock.
  const Verdict& judge(const Conditions& conditions, hal::TimeNs now_ns) noexcept;

  /// What of `wanted` goes to the robot in this tick. The curve driven stays the same while the speed is held back.
  hal::WheelSpeeds allowed(const hal::WheelSpeeds& wanted, hal::TimeNs now_ns) const noexcept;

  /// The same for a robot that flies.
  hal::QuadrotorSpeed allowed(const hal::QuadrotorSpeed& wanted, hal::TimeNs now_ns) const noexcept;

  const Verdict& verdict() const noexcept { return verdict_; }
  std::uint64_t stops() const noexcept { return stops_; }    ///< from driving to not
  std::uint64_t rearms() const noexcept { return rearms_; }  ///< from not driving to driving, the first time included

 private:
  RearmParams params_;
  Verdict verdict_;
  bool well_ = false;  // as the table says, without the time to settle
  hal::TimeNs well_since_ns_ = 0;
  hal::TimeNs armed_at_ns_ = 0;
  std::uint64_t stops_ = 0, rearms_ = 0;
};

}  // namespace tandem::mixed_reality
