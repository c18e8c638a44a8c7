// Chooses the next order for the robot from its state and its task. A table: no time, no memory.
#pragma once
#include <cstdint>

#include "bridges/eyebot/mode_orders.hpp"
#include "hal/device/flight.hpp"

namespace tandem::bridges::eyebot {

/// The robot's mode as it reports it. The numbers are those of the wire.
enum class Mode : std::int8_t {
  Off = 0,
  Idle = 1,
  TakeOff = 2,
  Hover = 3,
  Position = 4,
  Velocity = 5,
  Land = 6,
  Attaching = 7,
  Attached = 8,
  Detaching = 9,
  Stopped = 10
};
/// Off for a number that is no mode.
Mode mode_of(std::int8_t number) noexcept;
const char* mode_name(Mode mode) noexcept;
hal::FlightPhase phase_of(Mode mode) noexcept;
/// None for a number that is no fail-safe.
hal::FlightFailsafe failsafe_of(std::int8_t number) noexcept;
const char* failsafe_name(hal::FlightFailsafe failsafe) noexcept;

/// It goes where commands say, or stays in the air for them.
bool obeys_setpoints(Mode mode) noexcept;
/// It stands on something, hangs on something, hovers, or is about to stand: nothing drives it on.
bool at_rest(Mode mode) noexcept;

/// The robot brings itself to safety, whatever it is told.
bool saves_itself(Mode mode, hal::FlightFailsafe failsafe) noexcept;
/// Its motors carry it.
bool in_the_air(Mode mode) noexcept;

/// Goal of the bridge.
enum class Goal : std::uint8_t {
  Obey,   ///< the controller's orders
  Hover,  ///< stay where it is, whatever the controller says
  Land    ///< stand on the ground with its motors off, or stay at the ceiling
};

struct Situation {
  Mode mode = Mode::Off;
  bool armed = false;
  hal::FlightFailsafe failsafe = hal::FlightFailsafe::None;
  bool controlled = false;  ///< by us: it has accepted our Arm
  Goal goal = Goal::Obey;
  hal::FlightOrder order = hal::FlightOrder::Fly;
  bool pending = false;      ///< the order was not carried out yet
  bool battery_low = false;  ///< one that is to hover lands instead
};

struct Step {
  Action action = Action::Nop;  ///< to be asked for now; Nop: nothing, or wait
  bool fly = false;             ///< velocities and places may be sent
  bool done = false;            ///< the order, or the goal, is reached
};

/// A robot that another hub controls is left alone when the goal is not to obey; otherwise it is asked for.
/// A fail-safe other than a lost link or a late command is the robot's own affair: nothing is asked against it.
Step next_step(const Situation& s) noexcept;

}  // namespace tandem::bridges::eyebot
