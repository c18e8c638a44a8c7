// A Thymio II as its line shows it: messages and times in, messages and times out.
//
// Sources: the Thymio's programming interface, thymio.org (variables, events, functions, rates); the node that ASEBA's
// playground shows (their order, sizes of memory); aseba-community/aseba-target-thymio2, main.c (a reset clears the
// variables and puts the LEDs out).
#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <string_view>
#include <vector>

#include "bridges/aseba_emulation/node.hpp"
#include "bridges/emulation/delays.hpp"
#include "bridges/thymio_emulator/body.hpp"

namespace tandem::bridges::thymio_emulator {

using aseba_emulation::Lie;
using aseba_emulation::Message;

struct TimedMessage {
  Message message;
  hal::TimeNs at = 0;
};

/// A state machine in explicit time, without a clock, thread or file: what it does depends on its inputs alone. It has
/// the robot's manners: no answer to what was not understood, no checks of addresses, no watchdog but a program's.
///
/// Events for the sink, beside those of its node:
///   wheels    left, right (targets), changed by host or program
///   leds      rgb
///   tone      hz, length (60ths of a second)
///   boot      it is there from now on
class Thymio {
 public:
  struct Options {
    std::uint8_t node = 1;
    std::int16_t firmware = 14;
    hal::TimeNs boot_ns = 400 * hal::kNsPerMs;  ///< from power to the first answer; deaf meanwhile
    hal::TimeNs answer_ns = 2 * hal::kNsPerMs;  ///< from a question to the answer
    Delays delays{};                            ///< those of the link are its server's
  };

  /// `body` must outlive the robot. Nothing happens before `power_on`.
  Thymio(const Options& options, EmulatedBody& body, EventSink sink);
  Thymio(const Thymio&) = delete;
  Thymio& operator=(const Thymio&) = delete;

  /// It has started, at `at`.
  void power_on(hal::TimeNs at);
  /// A message of a host has come in at `at`. Times of all calls must not decrease.
  void receive(const Message& message, hal::TimeNs at);
  /// Does everything that the robot does until `now`.
  void run_until(hal::TimeNs now);
  /// Moves the messages that have left to the end of `out`.
  void take_sent(std::vector<TimedMessage>& out);
  /// When `run_until` will have something to do.
  hal::TimeNs next_event() const;

  /// It is switched off and on: deaf for `boot_ns`, then every variable is 0, and there is no program.
  void restart(hal::TimeNs at, std::string_view why);
  /// A foreign program is loaded, which does nothing.
  void load_other_program(hal::TimeNs at);
  /// It hears nothing, or cannot be heard.
  void set_deaf(bool deaf) { deaf_ = deaf; }
  void set_silent(bool silent) { silent_ = silent; }
  void set_lie(Lie lie) { node_.set_lie(lie); }

  aseba_emulation::Node& node() noexcept { return node_; }
  const BodyCommand& command() const noexcept { return command_; }
  std::int16_t left_target() const { return node_.words("motor.left.target")[0]; }
  std::int16_t right_target() const { return node_.words("motor.right.target")[0]; }
  /// When the motors' targets last changed.
  std::optional<hal::TimeNs> wheels_commanded_at() const noexcept { return wheels_commanded_at_; }
  /// When a motor first got a speed that is not 0.
  std::optional<hal::TimeNs> first_driven_at() const noexcept { return first_driven_at_; }

 private:
  struct Timer {
    std::int16_t period_ms = 0;
    hal::TimeNs next = 0;
  };

  aseba_emulation::NodeSpec spec();
  bool works(hal::TimeNs at) const { return at >= ready_at_; }
  void loop(hal::TimeNs at);
  void happen(std::string_view event, hal::TimeNs at);
  void run_timer(std::size_t i, hal::TimeNs at);
  void say(std::vector<Message> answers, hal::TimeNs at);
  void identify();
  void sensors_to_variables(hal::TimeNs at, bool all);
  void variables_to_actuators(hal::TimeNs at);
  void turn_motors(hal::TimeNs now);
  void actuate(hal::TimeNs at);
  void note_reset();

  Options options_;
  EmulatedBody& body_;
  EventSink sink_;
  std::array<std::uint8_t, 3 * kLeds> rgb_{};  // as native functions have set it
  double tone_Hz_ = 0.0;
  std::optional<hal::TimeNs> tone_ends_;  // none: it goes on
  hal::TimeNs now_ = 0;
  aseba_emulation::Node node_;
  std::deque<TimedMessage> waiting_;
  std::vector<TimedMessage> sent_;
  hal::TimeNs next_loop_ = 0;
  std::int64_t loops_ = 0;
  hal::TimeNs ready_at_ = 0;
  bool told_ = true;  // its start
  bool deaf_ = false, silent_ = false;
  std::array<Timer, 2> timers_;
  BodyCommand command_;
  std::int16_t told_left_ = 0, told_right_ = 0;
  /// Targets of the left motor and the right one.
  using Targets = std::array<std::int16_t, 2>;
  Targets motors_{}, shown_{};  // as they turn, as their measured speeds tell
  DelayLine<Targets> to_motors_, to_counters_;
  std::optional<hal::TimeNs> wheels_commanded_at_, first_driven_at_;
};

}  // namespace tandem::bridges::thymio_emulator
