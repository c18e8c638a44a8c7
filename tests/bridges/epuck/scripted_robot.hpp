// A little e-puck for tests: hears bytes, answers bytes, remembers what was done to it. No clock, no physics.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tandem::bridges::epuck {

using Bytes = std::vector<std::uint8_t>;

/// Takes requests the way the stock firmware does: zeros are skipped between packets, a byte from 0x80 begins a binary
/// packet, any other an ASCII line, whose leading CR and LF are skipped and which ends with the next of them.
class ScriptedRobot {
 public:
  std::string version = "Version 1.2.2 August 2008 GCtronic";
  bool hardware_line = true;
  std::size_t ground_bytes = 6;
  std::size_t battery_bytes = 2;
  bool silent = false;  ///< hears and obeys, but is not heard

  int left = 0, right = 0;
  std::array<int, 2> encoders{};
  std::array<int, 8> proximity{};
  std::array<int, 8> ambient{4095, 4095, 4095, 4095, 4095, 4095, 4095, 4095};
  std::array<int, 5> ground{1023, 0, 1023, 4, 5};
  int battery = 2315;
  std::array<int, 3> acceleration{2048, 2048, 2848};
  std::array<int, 10> leds{};
  std::array<int, 12> rgb{};
  std::vector<std::pair<int, int>> speeds;  ///< every setting, in order
  int stops = 0;                            ///< S
  int packets = 0;                          ///< binary
  int lines_not_found = 0;
  int led_settings = 0;

  Bytes hear(std::span<const std::uint8_t> bytes) {
    reply_.clear();
    for (const std::uint8_t byte : bytes) hear_byte(byte);
    return silent ? Bytes{} : reply_;
  }

  /// As after a reset: what it sends, everything at its start value.
  Bytes restart() {
    state_ = State::Idle;
    left = right = 0;
    encoders = {};
    leds = {};
    answer_.clear();
    const std::string text =
        "\x0C\x07WELCOME to the SerCom protocol on e-Puck\r\nthe EPFL education robot type \"H\" for help\r\n";
    return {text.begin(), text.end()};
  }

 private:
  enum class State { Idle, Skip, Line, Command, Payload };

  void hear_byte(std::uint8_t byte) {
    switch (state_) {
      case State::Idle:
        if (byte == 0) return;
        if (byte >= 0x80) {
          answer_.clear();
          begin_command(byte);
          return;
        }
        line_.clear();
        state_ = State::Skip;
        [[fallthrough]];
      case State::Skip:
        if (byte == '\r' || byte == '\n') return;
        state_ = State::Line;
        [[fallthrough]];
      case State::Line:
        if (byte != '\r' && byte != '\n') {
          line_ += static_cast<char>(byte);
          return;
        }
        state_ = State::Idle;
        do_line();
        return;
      case State::Command:
        if (byte != 0) {
          begin_command(byte);
          return;
        }
        ++packets;
        reply_.insert(reply_.end(), answer_.begin(), answer_.end());
        state_ = State::Idle;
        return;
      case State::Payload:
        payload_.push_back(byte);
        if (payload_.size() == needed_) do_command();
        return;
    }
  }

  void begin_command(std::uint8_t byte) {
    command_ = byte;
    payload_.clear();
    needed_ = byte == 0xBC || byte == 0xB0 ? 4 : byte == 0xB4 ? 2 : byte == 0xF6 ? 12 : byte == 0x89 ? 35 : 0;
    state_ = State::Payload;
    if (needed_ == 0) do_command();
  }

  int word(std::size_t at) const { return static_cast<std::int16_t>(payload_[at] | payload_[at + 1] << 8); }
  void put(int value) {
    answer_.push_back(static_cast<std::uint8_t>(value & 0xFF));
    answer_.push_back(static_cast<std::uint8_t>(value >> 8 & 0xFF));
  }
  void set_speeds(int l, int r) {
    left = commanded_[0] = l;
    right = commanded_[1] = r;
    speeds.emplace_back(l, r);
  }

  void do_command() {
    state_ = State::Command;
    switch (command_) {
      case 0xBC:
        set_speeds(word(0), word(2));
        break;
      case 0xB4:
        if (payload_[0] < 10) leds[payload_[0]] = payload_[1];
        ++led_settings;
        break;
      case 0xB0:
        encoders = {word(0), word(2)};
        break;
      case 0xF6:
        for (std::size_t i = 0; i < 12; ++i) rgb[i] = payload_[i];
        break;
      case 0xAF:
        for (const int v : encoders) put(v);
        break;
      case 0xB2:
        for (const int v : proximity) put(v);
        break;
      case 0xB1:
        for (const int v : ambient) put(v);
        break;
      case 0x9F:
        for (const int v : acceleration) put(v);
        break;
      case 0x8B:
        for (const int v : {1, 2, 3}) put(v);
        break;
      case 0xBB:
        for (const int v : commanded_) put(v);
        break;
      case 0x9E:
        if (battery_bytes > 0) put(battery);
        break;
      case 0xB3:
        for (std::size_t i = 0; i < ground_bytes / 2; ++i) put(ground[i]);
        break;
      default:
        break;
    }
  }

  void say(const std::string& text) {
    reply_.insert(reply_.end(), text.begin(), text.end());
    reply_.push_back('\r');
    reply_.push_back('\n');
  }
  void do_line() {
    if (line_ == "V") {
      say("v," + version);
      if (hardware_line) say("HW version: 1");
    } else if (line_ == "S") {
      left = right = 0;
      for (std::size_t i = 0; i < 8; ++i) leds[i] = 0;
      ++stops;
      say("s");
    } else if (line_.starts_with("D,")) {
      set_speeds(std::stoi(line_.substr(2)), right);
      say("d");
    } else {
      ++lines_not_found;
      say("z,Command not found");
    }
  }

  State state_ = State::Idle;
  std::uint8_t command_ = 0;
  std::size_t needed_ = 0;
  Bytes payload_, answer_, reply_;
  std::string line_;
  std::array<int, 2> commanded_{};
};

}  // namespace tandem::bridges::epuck
