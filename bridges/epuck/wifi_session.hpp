// The conversation with an e-puck2 over its own radio (WiFi, TCP port 1000), without I/O and without a clock.
//
//   absent --link up--> handshake --stop confirmed--> ready --sensors--> active
//   active --silent twice, odd values, moves untold--> suspect --stop confirmed--> ready
//   suspect, handshake --silent--> lost: the link is to be reopened --stop confirmed--> ready
//
// Every command has 21 bytes, sets everything and asks for all sensors, which come as 105. The radio goes on telling
// them as long as the link stands; so an answer belongs to no question, and readings are dated by their arrival. After
// a silence the sensors that come at once one after the other have waited on the way, for an unknown time: the
// first that come at the robot's own pace again are believed. It checks nothing: a command of which a byte is missing
// makes it read all that follow at the wrong place, and obey. TCP loses none; where a command could be sent in part
// only, the link is given up, and a new one begins in step.
//
// The robot does not tell its commanded speeds. It rests when its wheel counters were the same for 200 ms after it was
// told so: from 5 steps a second (0.6 mm/s) on every wheel counts meanwhile. The firmware has no watchdog: it drives on
// when the link is gone.
//
// One host at a time: a second one is let in, and hears nothing until the first has hung up. When nothing comes for
// 1.5 s the link is reopened. That a robot was switched off shows in the same way.
//
// Source: e-puck2/e-puck2_esp32, socket_e-puck2.c; Webots' e-puck2_server.c.
#pragma once
#include "bridges/epuck/conversation.hpp"

namespace tandem::bridges::epuck {

class WifiSession final : public Conversation {
 public:
  explicit WifiSession(const SessionTiming& timing = {}) noexcept : Conversation(timing) {}

  void link_up(hal::TimeNs now) noexcept override;
  void link_down(hal::TimeNs now) noexcept override;
  void on_bytes(std::span<const std::uint8_t> bytes, hal::TimeNs at) noexcept override;
  /// Takes in the newest sensors that came: of several that waited, the older ones tell nothing more.
  void poll(hal::TimeNs now) noexcept override;
  hal::TimeNs next_deadline() const noexcept override;
  void stalled(hal::TimeNs duration) noexcept override;
  void command(const Actuation& actuation, hal::TimeNs now) noexcept override;
  void ask(QuantitySet quantities, hal::TimeNs now) noexcept override;
  hal::TimeNs expected_round_trip(QuantitySet quantities) const noexcept override;
  bool idle() const noexcept override {
    return phase_ == Phase::Down || phase_ == Phase::Rest || (phase_ == Phase::Talk && waiting_ns_ == 0);
  }
  bool wants_new_link() const noexcept override { return wants_new_link_; }
  void sent_in_part() noexcept override { give_up_link("a command could not be sent whole"); }

 private:
  enum class Phase : std::uint8_t { Down, Stop, Talk, Rest };
  struct Arrived {
    AllSensors sensors;
    hal::TimeNs at_ns = 0;
    bool any = false;
  };

  bool is_down() const noexcept override { return phase_ == Phase::Down; }
  bool is_stopping() const noexcept override { return phase_ != Phase::Talk; }
  void say_stop(hal::TimeNs now) noexcept override;
  bool is_backlog(hal::TimeNs at) noexcept;
  void begin_handshake(hal::TimeNs now) noexcept;
  void begin_stop(hal::TimeNs now) noexcept;
  void on_rest(hal::TimeNs now) noexcept;
  void lose_step(const char* why, hal::TimeNs now) noexcept;
  void give_up_link(const char* why) noexcept;
  void take_sensors(const AllSensors& sensors, hal::TimeNs at, hal::TimeNs now) noexcept;
  void judge_rest(const std::array<std::int16_t, 2>& counters, hal::TimeNs at) noexcept;
  void judge_silence(hal::TimeNs now) noexcept;
  void say(hal::TimeNs now) noexcept;
  hal::TimeNs answer_by() const noexcept;

  Phase phase_ = Phase::Down;
  WifiReader reader_;
  Arrived newest_;
  hal::TimeNs said_ns_ = 0;     // the last command
  hal::TimeNs waiting_ns_ = 0;  // since the first command after the last sensors; 0: nothing is awaited
  hal::TimeNs silent_ns_ = 0;   // since when nothing came although it was asked for; 0: it comes
  hal::TimeNs stop_ns_ = 0;     // the stop was begun
  hal::TimeNs say_due_ns_ = 0;  // it is said again
  hal::TimeNs same_ns_ = 0;     // since when the wheel counters are the same; 0: not yet read
  std::array<std::int16_t, 2> same_{};
  bool wants_new_link_ = false;
  bool backlog_ = false;        // what comes has waited
  hal::TimeNs arrived_ns_ = 0;  // the last sensors, old or new
};

}  // namespace tandem::bridges::epuck
