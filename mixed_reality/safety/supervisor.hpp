// The safety table of real robots: what each may do and when, for all kinds and commands, and the way back from a stop.
//
//   every tick: conditions -> judge -> verdict;  command -> allow -> what goes to the robot
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "bridges/robot_bridge.hpp"
#include "hal/port.hpp"
#include "hal/time.hpp"
#include "mixed_reality/safety/proof.hpp"
#include "mixed_reality/safety/rearm.hpp"

namespace tandem::mixed_reality {

using bridges::LinkHealth;

/// All that decides whether a real robot may move. What happened "since the last judgement" is reported once and
/// remembered by the supervisor; the rest is told as it is in every tick.
struct Conditions {
  RunPhase run = RunPhase::Running;
  bool emergency_stop = false;        ///< a person stopped all robots, and has not armed this one since
  bool operator_holds = false;        ///< a person holds it
  bool hook_holds = false;            ///< a hook does
  bool controller_failed = false;     ///< it threw
  bool hub_was_frozen = false;        ///< since the last judgement: it did not run for so long that it counted as dead
  bool guardian_gone = false;         ///< it would not be stopped if this program died
  bool robot_stopped_itself = false;  ///< since the last judgement: it restarted, or its own fail-safe took over
  Doubt doubt = Doubt::None;          ///< since the last judgement: it is perhaps not the robot that was armed
  bool battery_low = false;
  LinkHealth link = LinkHealth::Connecting;
  bool readings_missing = false;  ///< one that the controller asked for never came
  hal::Validity pose = hal::Validity::Absent;
  bool pose_disputed = false;   ///< sources of the pose say different places
  bool links_swapped = false;   ///< since the last judgement: its wheels roll as another robot is seen to move
  bool pose_jumped = false;     ///< since the last judgement: farther than its wheels can have brought the robot
  bool wheels_differ = false;   ///< since the last judgement: they roll, and the robot does not move as they say
  bool being_replaced = false;  ///< another robot is to take its place
  bool replaced = false;        ///< it took another one's place, or was to be replaced by one that never came, and a
                                ///< person has not armed it since
};

/// Owner of a halt.
enum class StopOwner : std::uint8_t {
  Nobody,
  Run,
  Operator,
  Hook,
  Controller,
  Hub,
  Guardian,
  Robot,
  Battery,
  Link,
  Readings,
  Pose
};
inline constexpr std::size_t kStopOwners = 12;
/// As in reports: "link".
std::string_view name_of(StopOwner owner) noexcept;

/// Answer of the safety table to some conditions.
struct Verdict {
  bool may_drive = false;         ///< false: it gets safe commands, every tick
  bool controller_steps = false;  ///< false: it is held, so that it does not run away from a robot that does not follow
  bool land = false;              ///< a robot that flies is to come down where it is
  StopOwner owner = StopOwner::Run;
  std::string_view reason;  ///< why it may not drive, for people; "driving" when it may
};

/// Condition for driving again when the cause is gone; each asks for more than the one before it. With the policy
/// Never, those from Rearm on last until the end of the run.
enum class Recovery : std::uint8_t {
  Ends,      ///< time to settle: its holder lets go
  Settle,    ///< time to settle; a person's re-arm with the policy Operator
  Rearm,     ///< a person's re-arm; with the policy Time, that time
  Operator,  ///< a person's re-arm
  Proof      ///< a person's re-arm that names the robot: it is not proved to be the one that was armed
};

/// A row of the table: applies where `applies` is true; the first that does decides.
struct SafetyRule {
  bool (*applies)(const Conditions&) noexcept;
  Verdict verdict;
  Recovery recovery = Recovery::Ends;
  std::string_view waiting = {};  ///< the reason while the condition is gone and the re-arm is waited for
};
std::span<const SafetyRule> safety_table() noexcept;

/// The verdict of the first row that applies. The last row applies always.
Verdict judge(const Conditions& conditions) noexcept;

/// Applies the table tick by tick. Stops at once; lets go only after a while, and then by and by.
///
/// A stop that needs a re-arm is remembered, whatever else holds the robot meanwhile. Before the run nothing is: its
/// start arms the robots that are there.
class Supervisor {
 public:
  explicit Supervisor(const RearmParams& params) : params_(params) {}

  /// Once a tick, before the controllers step. `now_ns` on the run's clock.
  const Verdict& judge(const Conditions& conditions, hal::TimeNs now_ns) noexcept;
  /// A person re-arms the robot: what needed that is forgotten. It then settles, if all is well. Nothing with the
  /// policy Never, and where no robot answers.
  void rearm() noexcept;
  /// Whether it stands only for want of a re-arm.
  bool awaits_rearm() const noexcept { return well_ && latched_ != nullptr; }
  /// Whether it is perhaps not the robot that was armed, or has lost its memory, and was not re-armed since.
  bool unproved() const noexcept { return latched_ != nullptr && latched_->recovery == Recovery::Proof; }

  /// Leaves of a command what goes to the robot in this tick: the safe one while it may not drive; then, of those that
  /// move it, what is no faster than a limit that grows evenly from 0. `at`: where the robot is; null: unknown.
  void allow(const hal::PortType& type, void* command, const hal::Pose* at, hal::TimeNs now_ns) const noexcept;
  template <hal::ActuatorPort Port>
  Port allowed(Port wanted, hal::TimeNs now_ns, const hal::Pose* at = nullptr) const noexcept {
    allow(hal::port_type<Port>(), &wanted, at, now_ns);
    return wanted;
  }

  const Verdict& verdict() const noexcept { return verdict_; }
  std::uint64_t stops() const noexcept { return stops_; }    ///< from driving to not
  std::uint64_t rearms() const noexcept { return rearms_; }  ///< from not driving to driving, the first time included
  /// Of those stops, the ones that this owner began.
  std::uint64_t stops_by(StopOwner owner) const noexcept { return stops_by_[static_cast<std::size_t>(owner)]; }

 private:
  bool rearmed(hal::TimeNs now_ns) const noexcept;
  void latch(const Conditions& conditions) noexcept;

  RearmParams params_;
  Verdict verdict_;
  bool well_ = false;                    // as the table says, without the time to settle
  const SafetyRule* latched_ = nullptr;  // the stop that needs a re-arm
  bool operator_held_ = false, disarmed_ = false;
  bool answers_ = false;
  bool has_driven_ = false;  // since the start
  hal::TimeNs well_since_ns_ = 0;
  hal::TimeNs armed_at_ns_ = 0;
  std::uint64_t stops_ = 0, rearms_ = 0;
  std::array<std::uint64_t, kStopOwners> stops_by_{};
};

}  // namespace tandem::mixed_reality
