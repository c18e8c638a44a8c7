// The e-puck2's radio module: a TCP host on one side, the stock firmware's serial line on the other.
//
//   host     80 what flags left right leds rgb sound      21 bytes, taken as they come, without a look at the first
//   robot    F7 … F8 00                                    the same 19 as all actuators, then all sensors
//   host     02 and 104 bytes; 01 and an image; 03 alone   as `what` says: 1 the camera, 2 the sensors
//
// From the first command on it goes on asking the robot and telling the host, whether new commands come or not, and
// when the host has gone the robot keeps its speeds. Source: e-puck2/e-puck2_esp32, main/socket_e-puck2.c.
#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "bridges/epuck_emulator/firmware.hpp"

namespace tandem::bridges::epuck_emulator {

/// In explicit time, without clock, thread or socket. Times of all calls must not decrease.
class Radio {
 public:
  /// `firmware` must outlive this, and be fed by this alone.
  explicit Radio(Firmware& firmware) : firmware_(firmware) {}

  /// Another host has connected: what the last one had sent in part is forgotten.
  void new_host() noexcept;
  void receive(std::uint8_t byte, hal::TimeNs at);
  /// Does everything that radio and robot do until `now`.
  void run_until(hal::TimeNs now);
  /// Moves what has left for the host by `now` to the end of `out`.
  void take_sent(hal::TimeNs now, std::vector<SentByte>& out);
  std::optional<hal::TimeNs> next_event(hal::TimeNs patience_ns) const;
  /// The next packet for the host loses its second half.
  void cut_next_answer() noexcept { cut_ = true; }

 private:
  static constexpr std::size_t kCommand = 21;
  static constexpr std::size_t kSensors = 103;                   // that the firmware answers
  static constexpr hal::TimeNs kPause = 10 * hal::kNsPerMs;      // of its task, between two turns
  static constexpr hal::TimeNs kPatience = 100 * hal::kNsPerMs;  // with a robot that does not answer

  void begin_turn(hal::TimeNs now);
  void end_turn(hal::TimeNs now);
  void tell(std::vector<std::uint8_t> packet, hal::TimeNs at);

  Firmware& firmware_;
  std::array<std::uint8_t, kCommand> arriving_{}, command_{};
  std::size_t arrived_ = 0;
  bool commanded_ = false;   // some command has come
  bool asking_ = false;      // the firmware is being asked
  hal::TimeNs turn_ns_ = 0;  // when the next turn begins, or when the robot is given up in this one
  std::deque<SentByte> to_robot_;
  std::vector<SentByte> from_robot_;
  std::vector<std::uint8_t> answer_;
  std::deque<SentByte> to_host_;
  bool cut_ = false;
};

}  // namespace tandem::bridges::epuck_emulator
