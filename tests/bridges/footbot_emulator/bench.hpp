// A foot-bot in time that the test turns by hand, and bytes written as they stand on the wire.
#pragma once
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sstream>

#include "bridges/footbot_emulator/footbot.hpp"
#include "bridges/footbot_emulator/kinematic_body.hpp"

namespace tandem::bridges::footbot_emulator {

inline constexpr hal::TimeNs kMs = hal::kNsPerMs;

/// "300#0BA0010000000400"
inline Frame frame(const std::string& text) {
  Frame f;
  f.id = static_cast<std::uint16_t>(std::stoul(text.substr(0, 3), nullptr, 16));
  for (std::size_t at = 4; at + 1 < text.size(); at += 2) {
    f.data.at(f.size++) = static_cast<std::uint8_t>(std::stoul(text.substr(at, 2), nullptr, 16));
  }
  return f;
}

inline std::vector<std::string> texts(const std::vector<Frame>& frames) {
  std::vector<std::string> all;
  for (const Frame& f : frames) all.push_back(to_text(f));
  return all;
}

class Bench {
 public:
  explicit Bench(const Footbot::Options& options = {}, const std::optional<Arena>& arena = {})
      : body({}, arena), robot(options, body, [this](hal::TimeNs at, std::string_view name, const EventFields& fields) {
          log.push_back(to_json(at, name, fields));
        }) {
    robot.power_on(now);
  }

  void pass(hal::TimeNs time) {
    now += time;
    robot.run_until(now);
  }
  void say(const std::string& text) { robot.receive(frame(text), now); }
  /// What the modules have said by now.
  std::vector<std::string> heard() {
    std::vector<TimedFrame> sent;
    robot.take_sent(sent);
    std::vector<std::string> all;
    for (const TimedFrame& f : sent) all.push_back(to_text(f.frame));
    return all;
  }
  /// The frames that come after a question, given time enough.
  std::vector<std::string> ask(const std::string& text) {
    heard();
    say(text);
    pass(200 * kMs);
    return heard();
  }
  /// The same, as messages.
  std::vector<Message> ask_messages(const std::string& text) {
    Assembler assembler;
    std::vector<Message> all;
    for (const std::string& f : ask(text)) {
      if (const auto message = assembler.push(frame(f))) all.push_back(*message);
    }
    return all;
  }
  /// Words of a module, read over the bus.
  std::vector<int> read(int module, int start, int count) {
    std::ostringstream text;
    text << "300#0BA0" << std::hex << std::uppercase;
    for (const int word : {module, start, count}) {
      for (const int byte : {word & 255, word >> 8 & 255}) text << (byte < 16 ? "0" : "") << byte;
    }
    std::vector<int> words;
    for (const Message& m : ask_messages(text.str())) {
      for (std::size_t i = 1; i < m.words(); ++i) words.push_back(static_cast<std::int16_t>(m.word(i)));
    }
    return words;
  }
  int logged(const std::string& part) const {
    int count = 0;
    for (const std::string& line : log) count += line.find(part) != std::string::npos ? 1 : 0;
    return count;
  }

  hal::TimeNs now = 1000 * kMs;
  std::vector<std::string> log;
  KinematicBody body;
  Footbot robot;
};

}  // namespace tandem::bridges::footbot_emulator
