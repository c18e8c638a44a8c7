#include "bridges/eyebot/flight_plan.hpp"

#include <array>

namespace tandem::bridges::eyebot {
namespace {

using hal::FlightFailsafe;
using hal::FlightOrder;

constexpr Step kWait = {};
constexpr Step kDone = {Action::Nop, false, true};
constexpr Step kFly = {Action::Nop, true, true};

constexpr Step ask(Action action) noexcept {
  return {action, false, false};
}

/// The way to the air, from wherever it is; done there.
Step rise(const Situation& s) noexcept {
  switch (s.mode) {
    case Mode::Idle:
      return ask(s.armed && s.controlled ? Action::TakeOff : Action::Arm);
    case Mode::Off:
    case Mode::Stopped:
    case Mode::TakeOff:
    case Mode::Detaching:
      return kWait;
    case Mode::Land:
    case Mode::Attaching:
      return ask(Action::Hover);
    case Mode::Hover:
    case Mode::Position:
    case Mode::Velocity:
    case Mode::Attached:
      return kDone;
  }
  return kWait;
}

Step sink(const Situation& s) noexcept {
  switch (s.mode) {
    case Mode::Idle:
      return s.armed && s.controlled ? ask(Action::Disarm) : kDone;
    case Mode::Off:
    case Mode::Stopped:
      return kDone;
    case Mode::Land:
    case Mode::Detaching:
      return kWait;
    case Mode::Attached:
      return ask(Action::Detach);
    case Mode::Attaching:
      return ask(Action::Hover);
    case Mode::TakeOff:
    case Mode::Hover:
    case Mode::Position:
    case Mode::Velocity:
      return ask(Action::Land);
  }
  return kWait;
}

Step attach(const Situation& s) noexcept {
  if (s.mode == Mode::Attached) return kDone;
  if (s.mode == Mode::Attaching) return kWait;
  const Step up = rise(s);
  return up.done ? ask(Action::Attach) : up;
}

Step fly(const Situation& s) noexcept {
  switch (s.mode) {
    case Mode::Hover:
    case Mode::Position:
    case Mode::Velocity:
      return s.controlled ? kFly : ask(Action::Arm);
    case Mode::Land:
    case Mode::Attaching:
      return ask(Action::Hover);
    case Mode::Off:
    case Mode::Idle:
    case Mode::TakeOff:
    case Mode::Attached:
    case Mode::Detaching:
    case Mode::Stopped:
      return kWait;
  }
  return kWait;
}

Step obey(const Situation& s) noexcept {
  switch (s.pending ? s.order : FlightOrder::Fly) {
    case FlightOrder::TakeOff:
      return rise(s);
    case FlightOrder::Land:
      return sink(s);
    case FlightOrder::Attach:
      return attach(s);
    case FlightOrder::Detach:
      return s.mode == Mode::Attached ? ask(Action::Detach) : kDone;
    case FlightOrder::Fly:
      break;
  }
  if (s.order != FlightOrder::Fly) return kDone;  // it was carried out: it stays as it is
  return fly(s);
}

/// After a lost link the robot waits to be told that it may go on.
bool waits_for_clearance(const Situation& s, const Step& step) noexcept {
  if (s.failsafe != FlightFailsafe::LinkLost) return false;
  return obeys_setpoints(s.mode) || (s.mode == Mode::Idle && step.action != Action::Nop);
}

}  // namespace

Mode mode_of(std::int8_t number) noexcept {
  return number >= 0 && number <= 10 ? static_cast<Mode>(number) : Mode::Off;
}

const char* mode_name(Mode mode) noexcept {
  static constexpr std::array<const char*, 11> kNames = {
      "off",       "idle",     "taking off", "hovering", "flying to a place", "flying", "landing",
      "attaching", "attached", "detaching",  "stopped"};
  return kNames[static_cast<std::size_t>(mode)];
}

hal::FlightPhase phase_of(Mode mode) noexcept {
  using hal::FlightPhase;
  static constexpr std::array<FlightPhase, 11> kPhases = {
      FlightPhase::Off,      FlightPhase::Landed,    FlightPhase::TakingOff, FlightPhase::Hovering,
      FlightPhase::Flying,   FlightPhase::Flying,    FlightPhase::Landing,   FlightPhase::Attaching,
      FlightPhase::Attached, FlightPhase::Detaching, FlightPhase::Stopped};
  return kPhases[static_cast<std::size_t>(mode)];
}

FlightFailsafe failsafe_of(std::int8_t number) noexcept {
  return number >= 0 && number <= 6 ? static_cast<FlightFailsafe>(number) : FlightFailsafe::None;
}

const char* failsafe_name(FlightFailsafe failsafe) noexcept {
  static constexpr std::array<const char*, 7> kNames = {"none",
                                                        "commands came too late",
                                                        "it lost its hub",
                                                        "its battery is low",
                                                        "it does not know where it is",
                                                        "it is at its fence",
                                                        "a device failed"};
  return kNames[static_cast<std::size_t>(failsafe)];
}

bool obeys_setpoints(Mode mode) noexcept {
  return mode == Mode::Hover || mode == Mode::Position || mode == Mode::Velocity;
}

bool at_rest(Mode mode) noexcept {
  return mode == Mode::Off || mode == Mode::Idle || mode == Mode::Hover || mode == Mode::Land ||
         mode == Mode::Attached || mode == Mode::Stopped;
}

bool saves_itself(Mode mode, FlightFailsafe failsafe) noexcept {
  return failsafe == FlightFailsafe::LowBattery || failsafe == FlightFailsafe::NoPosition ||
         failsafe == FlightFailsafe::Geofence || failsafe == FlightFailsafe::Hardware ||
         (failsafe == FlightFailsafe::LinkLost && mode == Mode::Land);
}

bool in_the_air(Mode mode) noexcept {
  return mode == Mode::TakeOff || mode == Mode::Attaching || mode == Mode::Detaching || obeys_setpoints(mode);
}

Step next_step(const Situation& s) noexcept {
  if (s.goal == Goal::Hover) {
    if (s.battery_low && s.controlled && in_the_air(s.mode)) return sink(s);
    if (at_rest(s.mode)) return kDone;
    return s.controlled ? ask(Action::Hover) : kWait;
  }
  if (s.goal == Goal::Land) {
    if (s.mode == Mode::Attached) return kDone;
    const Step step = sink(s);
    return s.controlled || step.done ? step : kWait;
  }
  Step step = obey(s);
  if (step.action == Action::Land || step.action == Action::Disarm) {
    return s.controlled ? step : ask(Action::Arm);  // landing is never against a fail-safe
  }
  if (saves_itself(s.mode, s.failsafe)) return {Action::Nop, false, step.done};
  if (waits_for_clearance(s, step)) step = {Action::ClearFailsafe, false, false};
  if (step.action != Action::Nop && !s.controlled) step.action = Action::Arm;
  return step;
}

}  // namespace tandem::bridges::eyebot
