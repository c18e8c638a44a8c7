// The part of an eye-bot's firmware that decides whether it flies: modes, controlling hub, fail-safes.
#pragma once
#include <array>
#include <optional>
#include <string_view>

#include "bridges/eyebot_emulator/commands.hpp"
#include "bridges/eyebot_emulator/sender.hpp"
#include "hal/time.hpp"

namespace tandem::bridges::eyebot_emulator {

/// The numbers are the protocol's.
enum class Mode : std::int8_t {
  Off,
  Idle,
  TakeOff,
  Hover,
  Position,
  Velocity,
  Land,
  Attaching,
  Attached,
  Detaching,
  Estop
};
inline constexpr std::size_t kModes = 11;
std::string_view name_of(Mode mode);

/// The numbers are the protocol's.
enum class Failsafe : std::int8_t { None, CommandTimeout, LinkLost, LowBattery, NoPosition, Geofence, Hardware };
inline constexpr std::size_t kFailsafes = 7;
std::string_view name_of(Failsafe failsafe);
std::string_view name_of(Verdict verdict);
/// "none" for numbers that are no action.
std::string_view name_of_action(std::int8_t action);

/// Parameters of the supervisor.
struct Conditions {
  bool hardware_fault = false;
  bool battery_critical = false;
  bool position_valid = true;
  bool inside_fence = true;
  bool on_ground = true;
  bool at_ceiling = false;
  bool ceiling_seen = false;
  double height_m = 0.0;  ///< above the ground, as far as the robot knows
};

/// A table of modes and orders with a ladder of fail-safes above it. No clock: times are told to it and never decrease.
///
/// Fail-safes, highest first: hardware fault and critical battery land the robot; without a position it sinks blindly;
/// outside of its fence it hovers at the fence; without its hub it hovers and, 10 s after it heard it last, lands and
/// is free for another hub; a setpoint older than it is valid leaves it hovering. The highest one that holds is
/// reported; any that lands wins over those that hover. At the ceiling only the two highest matter. All but the
/// time-out and the missing position are latched until they are cleared, which fails while their cause lasts.
class Supervisor {
 public:
  static constexpr hal::TimeNs kLinkLostNs = 2 * hal::kNsPerSecond;   ///< without a heartbeat of the hub in control
  static constexpr hal::TimeNs kLinkGoneNs = 10 * hal::kNsPerSecond;  ///< it lands, and may be taken by another
  static constexpr double kTakeOffHeight_m = 0.95;                    ///< where taking off, to 1 m, turns into hovering
  static constexpr double kDetachDrop_m = 0.3;                        ///< [chosen] where detaching ends
  static constexpr double kClimb_m_s = 0.5;                           ///< the robot's own speeds
  static constexpr double kSink_m_s = 0.3;                            ///< as the protocol's blind descent, too

  /// From Off to Idle.
  void power_on() {
    if (mode_ == Mode::Off) mode_ = Mode::Idle;
  }

  /// An order of `session`. @returns what is acknowledged; nothing has changed unless it is Ok (clearing fail-safes may
  /// have cleared some, and still fail)
  Answer order(std::int32_t session, const ModeCommand& command, hal::TimeNs at);
  /// A velocity (`mode` Velocity) or a place (Position) to fly at or to, valid until `until` if that is given.
  Answer setpoint(std::int32_t session, Mode mode, std::optional<hal::TimeNs> until, hal::TimeNs at);
  /// A hub lives.
  void heartbeat(std::int32_t session, hal::TimeNs at) {
    if (session != 0 && session == controller_) heard_ = at;
  }
  /// What the robot senses at `at`: carries out fail-safes, and ends what is complete.
  void update(const Conditions& conditions, hal::TimeNs at);

  Mode mode() const noexcept { return mode_; }
  Failsafe failsafe() const noexcept;
  bool armed() const noexcept { return armed_; }
  bool magnet() const noexcept { return magnet_; }
  /// Session of the hub in control; 0: none.
  std::int32_t controller() const noexcept { return controller_; }
  bool motors() const noexcept;
  /// Sinking without a position.
  bool blind() const noexcept { return mode_ == Mode::Land && failsafe() == Failsafe::NoPosition; }
  /// Of climbing or sinking in a mode that does.
  double speed_m_s() const noexcept { return speed_m_s_; }

 private:
  bool flies() const noexcept { return motors(); }
  bool holds(Failsafe f) const noexcept { return holds_[static_cast<std::size_t>(f)]; }
  void set(Failsafe f, bool value) noexcept { holds_[static_cast<std::size_t>(f)] = value; }
  bool must_land() const noexcept;
  bool may_command(std::int32_t session) const noexcept { return controller_ == 0 || session == controller_; }

  Answer arm(std::int32_t session, hal::TimeNs at);
  Answer disarm();
  Answer manoeuvre(Action action, double speed_m_s);
  Answer clear(hal::TimeNs at);
  void stop();
  void enter(Mode mode, double speed_m_s = 0.0);
  void raise(hal::TimeNs at);
  void obey_failsafes();
  void finish();
  void release() { controller_ = 0; }

  Mode mode_ = Mode::Off;
  bool armed_ = false;
  bool magnet_ = false;
  bool stop_cleared_ = false;
  bool link_gone_ = false;  // lost for so long that it lands
  bool landing_blindly_ = false;
  double speed_m_s_ = 0.0;
  double detached_at_m_ = 0.0;
  std::int32_t controller_ = 0;
  hal::TimeNs heard_ = 0;  // of the hub in control
  std::optional<hal::TimeNs> valid_until_{};
  std::array<bool, kFailsafes> holds_{};
  Conditions seen_{};
};

}  // namespace tandem::bridges::eyebot_emulator
