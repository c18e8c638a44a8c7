// A foot-bot as its CAN bus shows it: frames and times in, frames and times out.
#pragma once
#include "bridges/emulation/delays.hpp"
#include "bridges/footbot_emulator/assembler.hpp"
#include "bridges/footbot_emulator/body.hpp"
#include "bridges/footbot_emulator/bus.hpp"
#include "bridges/footbot_emulator/modules.hpp"

namespace tandem::bridges::footbot_emulator {

/// All modules, the bus between them and the body that they move. A state machine in explicit time, without a clock,
/// thread or file: what it does depends on its inputs alone. It has the robot's manners, good and bad: no answer to
/// what was not understood, no checks of addresses, no watchdog but a program's: wheels keep their last
/// speed for ever.
///
/// Events for the sink:
///   frame     way (in: from the host, out), frame
///   get, set  module, start, words or values (get_beyond, set_beyond: past the end of the variables)
///   describe  module: it was asked and answers
///   wheels    left, right (as received), by, changed: a motor was told a speed, or lost it by a restart
///   turret, gripper, scanner, leds, radio: what the devices do now
///   boot      module: it is there from now on
///   ignored   what no module obeys
class Footbot {
 public:
  struct Options {
    Protocol protocol = Protocol::V4;
    hal::TimeNs boot_ns = 200 * hal::kNsPerMs;  ///< from power to the first answer; deaf meanwhile
    hal::TimeNs answer_ns = hal::kNsPerMs / 2;  ///< from a question to the answer
    Delays delays{};                            ///< those of the link are its server's
  };

  /// `body` must outlive the robot. Nothing happens before `power_on`.
  Footbot(const Options& options, EmulatedBody& body, EventSink sink);

  /// All modules have started, at `at`.
  void power_on(hal::TimeNs at);
  /// A frame of the host has passed on the bus at `at`. Times of all calls must not decrease.
  void receive(const Frame& frame, hal::TimeNs at);
  /// Does everything that the robot does until `now`.
  void run_until(hal::TimeNs now);
  /// Moves the frames that have passed to the end of `out`.
  void take_sent(std::vector<TimedFrame>& out);
  /// When `run_until` will have something to do.
  hal::TimeNs next_event() const;

  /// Power is taken from a module and given back: deaf for `boot_ns`, then every variable is 0.
  void restart(Place place, hal::TimeNs at, std::string_view why);
  /// A module that is not on the bus, or is again.
  void set_missing(Place place, bool missing, hal::TimeNs at);
  /// It hears nothing, or cannot be heard.
  void set_deaf(Place place, bool deaf) { conduct(place).deaf = deaf; }
  void set_silent(Place place, bool silent) { conduct(place).silent = silent; }
  void set_lie(Place place, Lie lie) { module(place).set_lie(lie); }

  const Options& options() const noexcept { return options_; }
  Module& module(Place place) { return modules_[static_cast<std::size_t>(place)]; }
  const Module& module(Place place) const { return modules_[static_cast<std::size_t>(place)]; }
  const BodyCommand& command() const noexcept { return command_; }
  /// When a motor last got a speed.
  std::optional<hal::TimeNs> wheels_commanded_at() const noexcept { return wheels_commanded_at_; }
  /// When a motor first got a speed that is not 0.
  std::optional<hal::TimeNs> first_driven_at() const noexcept { return first_driven_at_; }

 private:
  struct Conduct {
    bool missing = false;
    bool deaf = false;
    bool silent = false;
    bool told = true;  // its start
    hal::TimeNs ready_at = 0;
  };
  /// A wheel's encoder, in integer time: no drift however long it turns.
  struct Encoder {
    std::int64_t pulse_ns = 0;  // pulses times nanoseconds of a period
    void turn(std::int16_t speed_raw, hal::TimeNs duration_ns);
    std::uint32_t count() const;
  };

  Conduct& conduct(Place place) { return conducts_[static_cast<std::size_t>(place)]; }
  bool works(std::size_t i, hal::TimeNs at) const { return !conducts_[i].missing && at >= conducts_[i].ready_at; }
  void lose_power(Place place, hal::TimeNs at, std::string_view why);
  void loop(hal::TimeNs at);
  void run_timers(hal::TimeNs at);
  void hear(const Message& message, hal::TimeNs at);
  void pass_frames(hal::TimeNs now);
  void note_heard(hal::TimeNs at);
  void note_wheels(hal::TimeNs at, std::string_view by);
  void turn_encoders(hal::TimeNs at);
  void count_pulses(hal::TimeNs until);
  void turn_motors(hal::TimeNs now);
  void put_speeds(hal::TimeNs at);
  void actuate(hal::TimeNs at);
  void sensors_to_variables(hal::TimeNs at);
  void variables_to_actuators(hal::TimeNs at);
  BodyCommand commanded(bool gripper_busy) const;
  void tell_changes(hal::TimeNs at, const BodyCommand& before) const;
  std::int16_t word(Place place, std::string_view variable) const { return module(place).words(variable)[0]; }

  Options options_;
  EmulatedBody& body_;
  EventSink sink_;
  std::vector<Module> modules_;
  std::array<Conduct, kModules> conducts_;
  Bus bus_;
  Assembler assembler_;
  std::vector<TimedFrame> sent_;
  /// Raw, of the left motor and the right one.
  using Speeds = std::array<std::int16_t, 2>;
  Speeds told_speeds_{}, motors_{}, counted_{};  // as the modules have them, as they turn, as the encoders turn
  DelayLine<Speeds> to_motors_, to_counters_;
  std::array<Encoder, 2> encoders_;
  hal::TimeNs now_ = 0;
  hal::TimeNs next_loop_ = 0;
  std::int64_t loops_ = 0;
  hal::TimeNs encoders_at_ = 0;
  BodyCommand command_;
  int told_left_ = 0, told_right_ = 0;
  std::optional<hal::TimeNs> wheels_commanded_at_, first_driven_at_;
};

}  // namespace tandem::bridges::footbot_emulator
