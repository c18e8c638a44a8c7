// A firmware on the bench: bytes in at line speed, answers out, time by hand.
#pragma once
#include <gtest/gtest.h>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/epuck_emulator/firmware.hpp"
#include "tests/bridges/epuck_emulator/held_body.hpp"

namespace tandem::bridges::epuck_emulator {

using hal::TimeNs;

/// That a wheel of 41 mm rolls in one of the 1000 steps of a turn.
inline constexpr double kStep_m = 0.041 * std::numbers::pi / 1000;
inline constexpr TimeNs kSecond = hal::kNsPerSecond;
inline constexpr std::string_view kGreeting =
    "\x0C\x07WELCOME to the SerCom protocol on e-Puck\r\nthe EPFL education robot type \"H\" for help\r\n";

/// "BC F4 01" as bytes.
inline std::string bytes(std::string_view hex) {
  std::string out;
  for (std::size_t i = 0; i + 1 < hex.size();) {
    if (hex[i] == ' ') {
      ++i;
      continue;
    }
    out += static_cast<char>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16));
    i += 2;
  }
  return out;
}

/// The 16-bit number at `at`, with sign.
inline int int16_at(std::string_view data, std::size_t at) {
  return static_cast<std::int16_t>(static_cast<unsigned char>(data[at]) | static_cast<unsigned char>(data[at + 1])
                                                                              << 8);
}

class Bench {
 public:
  explicit Bench(const Firmware::Options& options = {})
      : firmware(options, body, [this](TimeNs at, std::string_view name, const EventFields& fields) {
          events.push_back(to_json(at, name, fields));
        }) {
    firmware.power_on(0);
    greeting = listen();
    events.clear();
  }
  explicit Bench(Variant variant) : Bench(Firmware::Options{.variant = variant}) {}

  /// Sends at line speed and returns all that comes back until the robot is idle.
  std::string say(std::string_view text) {
    send(text);
    return listen();
  }
  void send(std::string_view text) {
    for (const char c : text) {
      now += kByteNs;
      firmware.receive(static_cast<std::uint8_t>(c), now);
    }
  }
  std::string listen() {
    collect();
    while (const auto next = firmware.next_event()) {
      now = std::max(now, *next);
      firmware.run_until(now);
      collect();
    }
    std::string text;
    for (const SentByte& s : heard) text += static_cast<char>(s.byte);
    heard.clear();
    return text;
  }
  void wait(TimeNs duration) {
    now += duration;
    firmware.run_until(now);
  }
  int count(std::string_view what) const {
    int n = 0;
    for (const std::string& e : events) n += e.find(what) != std::string::npos ? 1 : 0;
    return n;
  }

  HeldBody body;
  std::vector<std::string> events;
  std::vector<SentByte> heard;
  TimeNs now = 0;
  std::string greeting;
  Firmware firmware;

 private:
  void collect() { firmware.take_sent(now, heard); }
};

}  // namespace tandem::bridges::epuck_emulator
