// The command loop of the stock firmwares as an automaton over abstract states: what the wheels do after any bytes.
//
// Written from the protocol's description alone; it shares nothing with the bridge or the emulator. It knows the
// commands of all firmwares at once, e-puck2 included, and takes the worst case where they differ.
#pragma once
#include <array>
#include <compare>
#include <cstdint>
#include <vector>

namespace tandem::bridges::epuck {

/// What a wheel speed comes from. Host: any speed that the host sent, or part of it with zeros in place of the rest.
/// Strange: a byte that was never meant to be a speed has become one.
enum class Motion : std::uint8_t { Zero, Host, Strange };

/// Where the firmware stands between two bytes.
struct ParserState {
  enum class Mode : std::uint8_t {
    Idle,     ///< waits for a first byte: 0 is ignored, 1 to 127 begins a line, 128 to 255 a binary packet
    Skip,     ///< after a first byte CR or LF: more of them are skipped, any other byte begins the line
    Line,     ///< collects to the next CR or LF
    Command,  ///< within a binary packet: 0 ends it, a known command takes its payload, others are ignored
    Payload
  };
  Mode mode = Mode::Idle;
  std::uint8_t first = 0;           ///< Line: its first byte
  std::uint8_t command = 0;         ///< Payload: of which command byte
  std::uint8_t taken = 0;           ///< Payload: bytes that came already
  Motion pending = Motion::Zero;    ///< Payload of a command that sets speeds: what came already
  Motion wheels = Motion::Zero;     ///< what turns them now
  Motion variables = Motion::Zero;  ///< the firmware's speed variables: "D" without arguments sets them again
  auto operator<=>(const ParserState&) const = default;
};

inline std::uint8_t payload_of(std::uint8_t command) {
  switch (command) {
    case 0xBC:  // D, speeds
    case 0xB0:  // P, wheel counters
      return 4;
    case 0xB4:  // L
    case 0xA7:  // Y, I2C read
      return 2;
    case 0xA9:  // W, I2C write
      return 3;
    case 0x89:  // w, RGB panel
      return 35;
    case 0xF7:  // e-puck2: all actuators
      return 19;
    case 0xF6:  // e-puck2: RGB LEDs
      return 12;
    case 0xF1:
    case 0xF0:
    case 0xEF:
      return 1;
    default:
      return 0;
  }
}

/// Bytes of the payload that decide over the wheels. F7: flags, and both speeds.
inline bool moves_wheels(std::uint8_t command, std::uint8_t at) {
  return command == 0xBC || (command == 0xF7 && at <= 4);
}

inline Motion worse(Motion a, Motion b) {
  return a < b ? b : a;
}

inline bool ends_line(std::uint8_t byte) {
  return byte == '\r' || byte == '\n';
}

/// `byte` comes, of the host's stop.
inline ParserState after(ParserState s, std::uint8_t byte) {
  using Mode = ParserState::Mode;
  const auto begin_line = [&] {
    s.mode = Mode::Line;
    s.first = byte;
  };
  const auto take_command = [&] {
    s.mode = Mode::Command;
    if (byte == 0) {
      s.mode = Mode::Idle;
    } else if (payload_of(byte) > 0) {
      s.mode = Mode::Payload;
      s.command = byte;
      s.taken = 0;
      s.pending = Motion::Zero;
    }
  };
  switch (s.mode) {
    case Mode::Idle:
      if (byte >= 0x80)
        take_command();
      else if (ends_line(byte))
        s.mode = Mode::Skip;
      else if (byte != 0)
        begin_line();
      break;
    case Mode::Skip:
      if (!ends_line(byte)) begin_line();
      break;
    case Mode::Line:
      if (!ends_line(byte)) break;
      s.mode = Mode::Idle;
      switch (s.first) {
        case 'S':
        case 's':  // stops; most firmwares keep the variables
          s.wheels = Motion::Zero;
          break;
        case 'R':
        case 'r':  // a restart
          s.wheels = s.variables = Motion::Zero;
          break;
        case 'D':
        case 'd':  // arguments that are missing are those of the last command
          s.variables = worse(s.variables, Motion::Zero);
          s.wheels = s.variables;
          break;
        default:
          break;
      }
      s.first = 0;
      break;
    case Mode::Command:
      take_command();
      break;
    case Mode::Payload:
      if (moves_wheels(s.command, s.taken) && byte != 0) s.pending = Motion::Strange;
      if (++s.taken < payload_of(s.command)) break;
      s.mode = Mode::Command;
      if (moves_wheels(s.command, 0)) s.wheels = s.variables = s.pending;
      s.pending = Motion::Zero;
      s.command = s.taken = 0;
      break;
  }
  return s;
}

/// Every state in which a host that drives the robot, and then falls silent or loses bytes, may leave it. The wheels
/// turn, and so does whatever is half-received.
inline std::vector<ParserState> all_states() {
  using Mode = ParserState::Mode;
  std::vector<ParserState> states;
  for (const Motion variables : {Motion::Zero, Motion::Host}) {
    const auto add = [&](ParserState s) {
      s.wheels = Motion::Host;
      s.variables = variables;
      states.push_back(s);
    };
    for (const Mode mode : {Mode::Idle, Mode::Skip, Mode::Command}) add({.mode = mode});
    for (int first = 0; first < 256; ++first) {
      if (!ends_line(static_cast<std::uint8_t>(first)))
        add({.mode = Mode::Line, .first = static_cast<std::uint8_t>(first)});
    }
    for (int command = 0x80; command < 256; ++command) {
      const auto c = static_cast<std::uint8_t>(command);
      for (std::uint8_t taken = 0; taken < payload_of(c); ++taken) {
        add({.mode = Mode::Payload,
             .command = c,
             .taken = taken,
             .pending = moves_wheels(c, 0) ? Motion::Host : Motion::Zero});
      }
    }
  }
  return states;
}

}  // namespace tandem::bridges::epuck
