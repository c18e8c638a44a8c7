#include "bridges/eyebot_emulator/supervisor.hpp"

#include <algorithm>
#include <cmath>

namespace tandem::bridges::eyebot_emulator {
namespace {

constexpr std::array<std::string_view, kModes> kModeNames = {
    "off", "idle", "takeoff", "hover", "position", "velocity", "land", "attaching", "attached", "detaching", "estop"};
constexpr std::array<std::string_view, kFailsafes> kFailsafeNames = {
    "none", "cmd_timeout", "link_lost", "low_battery", "no_position", "geofence", "hardware"};
constexpr std::array<std::string_view, 7> kVerdictNames = {
    "ok", "rejected_mode", "rejected_range", "rejected_stale", "rejected_source", "unsupported", "failed"};
constexpr std::array<std::string_view, 10> kActionNames = {"nop",  "arm",    "disarm", "takeoff", "hover",
                                                           "land", "attach", "detach", "estop",   "clear_failsafe"};

/// The highest first.
constexpr std::array<Failsafe, 6> kLadder = {Failsafe::Hardware, Failsafe::LowBattery, Failsafe::NoPosition,
                                             Failsafe::Geofence, Failsafe::LinkLost,   Failsafe::CommandTimeout};

constexpr std::uint16_t bit(Mode mode) {
  return static_cast<std::uint16_t>(1U << static_cast<unsigned>(mode));
}

/// What an order makes of which modes. In its own mode an order is accepted and changes nothing.
struct Row {
  Action action;
  std::uint16_t from;
  Mode to;
  Mode done;              ///< what it leads to: an order that has been carried out is accepted, too
  bool despite_failsafe;  ///< of those that hover
  double speed_m_s;       ///< the robot's own
};

constexpr std::uint16_t kFlying = bit(Mode::Hover) | bit(Mode::Position) | bit(Mode::Velocity);
constexpr std::array<Row, 5> kTable = {{
    {Action::TakeOff, bit(Mode::Idle), Mode::TakeOff, Mode::Hover, false, Supervisor::kClimb_m_s},
    {Action::Hover, kFlying | bit(Mode::TakeOff) | bit(Mode::Land) | bit(Mode::Attaching) | bit(Mode::Detaching),
     Mode::Hover, Mode::Hover, true, 0.0},
    {Action::Land, kFlying | bit(Mode::TakeOff) | bit(Mode::Attaching) | bit(Mode::Detaching), Mode::Land, Mode::Idle,
     true, Supervisor::kSink_m_s},
    {Action::Attach, kFlying, Mode::Attaching, Mode::Attached, false, Supervisor::kClimb_m_s},
    {Action::Detach, bit(Mode::Attached), Mode::Detaching, Mode::Detaching, false, Supervisor::kSink_m_s},
}};

Answer rejected(Verdict verdict, std::string text) {
  return {verdict, std::move(text)};
}

Answer wrong_mode(Mode mode) {
  return rejected(Verdict::RejectedMode, "not in mode " + std::string(name_of(mode)));
}

}  // namespace

std::string_view name_of(Mode mode) {
  return kModeNames[static_cast<std::size_t>(mode)];
}
std::string_view name_of(Failsafe failsafe) {
  return kFailsafeNames[static_cast<std::size_t>(failsafe)];
}
std::string_view name_of(Verdict verdict) {
  return kVerdictNames[static_cast<std::size_t>(verdict)];
}
std::string_view name_of_action(std::int8_t action) {
  if (action < 0 || static_cast<std::size_t>(action) >= kActionNames.size()) return "none";
  return kActionNames[static_cast<std::size_t>(action)];
}

bool Supervisor::motors() const noexcept {
  return mode_ != Mode::Off && mode_ != Mode::Idle && mode_ != Mode::Attached && mode_ != Mode::Estop;
}

Failsafe Supervisor::failsafe() const noexcept {
  for (const Failsafe f : kLadder) {
    if (holds(f)) return f;
  }
  return Failsafe::None;
}

bool Supervisor::must_land() const noexcept {
  return holds(Failsafe::Hardware) || holds(Failsafe::LowBattery) || holds(Failsafe::NoPosition) || link_gone_;
}

void Supervisor::enter(Mode mode, double speed_m_s) {
  mode_ = mode;
  speed_m_s_ = speed_m_s;
  valid_until_.reset();
  landing_blindly_ = false;
  if (mode == Mode::Attaching) magnet_ = true;
  if (mode == Mode::Detaching) detached_at_m_ = seen_.height_m;
  if (mode != Mode::Attaching && mode != Mode::Attached && mode != Mode::Estop) magnet_ = false;
}

Answer Supervisor::order(std::int32_t session, const ModeCommand& command, hal::TimeNs at) {
  if (name_of_action(command.action) == "none") {
    return rejected(Verdict::Unsupported, "there is no action " + std::to_string(command.action));
  }
  if (mode_ == Mode::Off) return wrong_mode(mode_);
  const auto action = static_cast<Action>(command.action);
  if (action == Action::Nop) return {};
  if (action == Action::Estop) {
    stop();
    return {};
  }
  const bool needs_control = action != Action::Arm && action != Action::Disarm && action != Action::ClearFailsafe;
  if (!may_command(session) || (needs_control && session != controller_)) {
    return rejected(Verdict::RejectedSource, controller_ != 0 ? "another hub is in control" : "nobody is in control");
  }
  if (!std::isfinite(command.param) || command.param < 0.0F) {
    return rejected(Verdict::RejectedRange, "a speed is a number from 0 on");
  }
  if (action == Action::Arm) return arm(session, at);
  if (action == Action::Disarm) return disarm();
  if (action == Action::ClearFailsafe) return clear(at);
  return manoeuvre(action, static_cast<double>(command.param));
}

Answer Supervisor::arm(std::int32_t session, hal::TimeNs at) {
  if (mode_ == Mode::Estop) return wrong_mode(mode_);
  const bool on_ground = mode_ == Mode::Idle;
  const bool only_late = failsafe() == Failsafe::None || failsafe() == Failsafe::CommandTimeout;
  if (on_ground && !armed_ && !only_late) {
    return rejected(Verdict::RejectedMode, "fail-safe " + std::string(name_of(failsafe())));
  }
  if (on_ground) set(Failsafe::CommandTimeout, false);  // it ends with the next valid command
  if (session != controller_) heard_ = at;
  controller_ = session;
  armed_ = true;
  return {};
}

Answer Supervisor::disarm() {
  if (mode_ == Mode::Estop) {
    if (!stop_cleared_) return rejected(Verdict::RejectedMode, "the emergency stop is not cleared");
    const bool hangs = magnet_ && seen_.at_ceiling;
    if (!hangs && !seen_.on_ground) return rejected(Verdict::RejectedMode, "it falls");
    enter(hangs ? Mode::Attached : Mode::Idle);
  }
  if (flies()) return wrong_mode(mode_);
  release();
  armed_ = false;
  return {};
}

Answer Supervisor::manoeuvre(Action action, double speed_m_s) {
  const Row& row = *std::ranges::find(kTable, action, &Row::action);
  if (!armed_) return rejected(Verdict::RejectedMode, "not armed");
  const bool despite = row.despite_failsafe && (row.to == Mode::Land || !must_land());
  const bool only_late = failsafe() == Failsafe::None || failsafe() == Failsafe::CommandTimeout;
  if (!only_late && !despite) {
    return rejected(Verdict::RejectedMode, "fail-safe " + std::string(name_of(failsafe())));
  }
  if (mode_ == row.to || mode_ == row.done) {
    set(Failsafe::CommandTimeout, false);
    return {};
  }
  if ((row.from & bit(mode_)) == 0) return wrong_mode(mode_);
  if (action == Action::Attach && !seen_.ceiling_seen) return rejected(Verdict::Failed, "there is no ceiling in sight");
  set(Failsafe::CommandTimeout, false);
  enter(row.to, speed_m_s > 0.0 ? speed_m_s : row.speed_m_s);
  return {};
}

Answer Supervisor::clear(hal::TimeNs at) {
  stop_cleared_ = mode_ == Mode::Estop;
  const std::array<std::pair<Failsafe, bool>, 4> causes = {
      {{Failsafe::Hardware, seen_.hardware_fault},
       {Failsafe::LowBattery, seen_.battery_critical},
       {Failsafe::Geofence, !seen_.inside_fence && flies()},
       {Failsafe::LinkLost, controller_ != 0 && at - heard_ >= kLinkLostNs}}};
  std::string lasting;
  for (const auto& [failsafe, lasts] : causes) {
    if (holds(failsafe) && lasts) lasting += (lasting.empty() ? "" : ", ") + std::string(name_of(failsafe));
    set(failsafe, holds(failsafe) && lasts);
  }
  link_gone_ = false;
  if (!lasting.empty()) return rejected(Verdict::Failed, lasting + ": the cause lasts");
  return {};
}

void Supervisor::stop() {
  const bool magnet = magnet_;  // one that holds goes on to hold: motors off is what was asked for
  enter(Mode::Estop);
  magnet_ = magnet;
  armed_ = false;
  stop_cleared_ = false;
}

Answer Supervisor::setpoint(std::int32_t session, Mode mode, std::optional<hal::TimeNs> until, hal::TimeNs at) {
  if (controller_ == 0 || session != controller_) {
    return rejected(Verdict::RejectedSource, controller_ != 0 ? "another hub is in control" : "nobody is in control");
  }
  if ((kFlying & bit(mode_)) == 0) return wrong_mode(mode_);
  if (failsafe() != Failsafe::None && failsafe() != Failsafe::CommandTimeout) {
    return rejected(Verdict::RejectedMode, "fail-safe " + std::string(name_of(failsafe())));
  }
  if (until && *until <= at) return rejected(Verdict::RejectedStale, "it was valid for no time");
  set(Failsafe::CommandTimeout, false);
  enter(mode);
  valid_until_ = until;
  return {};
}

void Supervisor::raise(hal::TimeNs at) {
  if (seen_.hardware_fault) set(Failsafe::Hardware, true);
  if (seen_.battery_critical) set(Failsafe::LowBattery, true);
  set(Failsafe::NoPosition, !seen_.position_valid);
  if (flies() && !seen_.inside_fence) set(Failsafe::Geofence, true);
  if (controller_ != 0 && at - heard_ >= kLinkLostNs) set(Failsafe::LinkLost, true);
  if (controller_ != 0 && at - heard_ >= kLinkGoneNs) {
    release();
    link_gone_ = flies();
    if (mode_ == Mode::Idle) armed_ = false;
  }
  if (valid_until_ && at >= *valid_until_) {
    set(Failsafe::CommandTimeout, true);
    enter(Mode::Hover);
  }
}

void Supervisor::obey_failsafes() {
  const bool failing = holds(Failsafe::Hardware) || holds(Failsafe::LowBattery);
  if (mode_ == Mode::Attached && failing) enter(Mode::Land, kSink_m_s);
  if (!flies()) return;
  if (must_land() && mode_ != Mode::Land) {
    const bool blindly = failsafe() == Failsafe::NoPosition;
    enter(Mode::Land, kSink_m_s);
    landing_blindly_ = blindly;
  } else if (landing_blindly_ && !must_land()) {
    enter(Mode::Hover);
  } else if ((holds(Failsafe::Geofence) || holds(Failsafe::LinkLost)) && mode_ != Mode::Land) {
    if (mode_ != Mode::Hover) enter(Mode::Hover);
  }
}

void Supervisor::finish() {
  if (mode_ == Mode::TakeOff && seen_.height_m >= kTakeOffHeight_m) return enter(Mode::Hover);
  if (mode_ == Mode::Attaching && seen_.at_ceiling) return enter(Mode::Attached);
  const bool clear_of_ceiling = seen_.height_m <= detached_at_m_ - kDetachDrop_m || seen_.on_ground;
  if (mode_ == Mode::Detaching && clear_of_ceiling) return enter(Mode::Hover);
  if (mode_ == Mode::Land && seen_.on_ground) {
    enter(Mode::Idle);
    if (controller_ == 0) armed_ = false;
    link_gone_ = false;
  }
}

void Supervisor::update(const Conditions& conditions, hal::TimeNs at) {
  seen_ = conditions;
  if (mode_ == Mode::Off) return;
  raise(at);
  if (mode_ == Mode::Estop) return;
  finish();
  obey_failsafes();
}

}  // namespace tandem::bridges::eyebot_emulator
