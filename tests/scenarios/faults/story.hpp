// What goes wrong in one run: drawn from a seed, and written as people write faults.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/emulation/fault_spec.hpp"
#include "tests/scenarios/faults/tested_robot.hpp"

namespace tandem::faults {

/// A fault that a kind's emulator knows. "%P" in its text stands for a probability, "%T" for a time.
struct FaultChoice {
  std::string_view text;
  double most = 0.0;        ///< the largest probability, or the longest time in seconds
  bool lasts = true;        ///< else it happens at an instant
  bool damages = false;     ///< values that are read meanwhile may be nonsense: the protocol has no check sums
  double recovery_s = 0.0;  ///< what the robot itself takes to be well again
  double repeat_s = 0.0;    ///< a conversation that it damaged last takes so much more to be had again
};

/// One fault as drawn; times count from the begin of the faults.
struct DrawnFault {
  std::string text;
  TimeNs from = 0, until = 0;  ///< with the robot's own recovery
  TimeNs repeat_ns = 0;        ///< as in its choice
  TimeNs delay_ns = 0;         ///< that it adds to readings
  bool damages = false;
};

enum class HubFault : std::uint8_t {
  None,
  Stall,   ///< the loop is late; the I/O threads go on
  Freeze,  ///< the whole process sleeps, and comes back
  Clock,   ///< its clock that shows the date jumps
  Kill,
  End  ///< it ends in order, whatever goes wrong at the moment
};

struct Story {
  std::uint64_t seed = 0;
  std::vector<std::vector<DrawnFault>> robots;
  HubFault hub = HubFault::None;
  TimeNs hub_from = 0, hub_until = 0;
  TimeNs jump_ns = 0;       ///< Clock
  bool supervised = false;  ///< the safety table decides when it drives, as in `tandem run`; else the driver alone

  TimeNs end(std::size_t robot) const {
    TimeNs end = 0;
    for (const DrawnFault& f : robots[robot]) end = std::max(end, f.until);
    return end;
  }
  bool hub_goes() const { return hub == HubFault::Kill || hub == HubFault::End; }
};

inline std::string seconds(TimeNs t) {
  std::string text = std::to_string(t / kMs);
  text.insert(0, text.size() < 4 ? 4 - text.size() : 0, '0');
  return text.insert(text.size() - 3, ".") + "s";
}

inline std::string to_text(const Story& story) {
  static constexpr std::string_view kHub[] = {"none", "stall", "freeze", "clock", "kill", "end"};
  std::string text = "TANDEM_FAULT_SEED=" + std::to_string(story.seed) + "\n";
  for (std::size_t i = 0; i < story.robots.size(); ++i) {
    text += "  robot " + std::to_string(i) + ":";
    for (const DrawnFault& f : story.robots[i]) text += " " + f.text;
    text += "\n";
  }
  text += "  hub:";
  if (story.hub != HubFault::None) {
    text += " " + std::string(kHub[static_cast<std::size_t>(story.hub)]);
    if (story.hub == HubFault::Clock) text += "=" + std::to_string(story.jump_ns / kMs) + "ms";
    text += "@" + seconds(story.hub_from);
    if (story.hub_until > story.hub_from) text += "+" + seconds(story.hub_until - story.hub_from);
  }
  return text + (story.supervised ? "  (safety table)" : "  (driver alone)");
}

/// Chance of a story, apart from that in its faults.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : chance_(seed * 0x2545F4914F6CDD1DULL + 1) { chance_.draw(); }
  double unit() { return static_cast<double>(chance_.draw() >> 11U) * 0x1p-53; }
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(unit() * static_cast<double>(n)); }
  /// Whole milliseconds, so that a fault can be written.
  TimeNs between(double from_s, double to_s) {
    return static_cast<TimeNs>((from_s + (to_s - from_s) * unit()) * 1000.0) * kMs;
  }

 private:
  bridges::Chance chance_;
};

inline DrawnFault draw_fault(Draw& draw, const FaultChoice& choice) {
  DrawnFault fault;
  fault.damages = choice.damages;
  fault.repeat_ns = static_cast<TimeNs>(choice.repeat_s * 1e9);
  fault.text = choice.text;
  if (const auto at = fault.text.find("%P"); at != std::string::npos) {
    fault.text.replace(
        at, 2, "0." + std::to_string(1000 + draw.below(static_cast<std::size_t>(choice.most * 1000.0))).substr(1));
  }
  if (const auto at = fault.text.find("%T"); at != std::string::npos) {
    fault.delay_ns = draw.between(0.005, choice.most);
    fault.text.replace(at, 2, std::to_string(fault.delay_ns / kMs) + "ms");
  }
  fault.from = draw.between(0.0, 1.5);
  const TimeNs lasts = draw.unit() < 0.3 ? draw.between(0.02, 0.3) : draw.between(0.1, 2.5);
  fault.text += "@" + seconds(fault.from) + (choice.lasts ? "+" + seconds(lasts) : "");
  fault.until = fault.from + (choice.lasts ? lasts : 0) + static_cast<TimeNs>(choice.recovery_s * 1e9);
  return fault;
}

/// One to three robots with up to two faults each; a hub that may stall, freeze, be killed, or end meanwhile.
inline Story draw_story(std::uint64_t seed, std::span<const FaultChoice> choices) {
  Draw draw(seed);
  Story story;
  story.seed = seed;
  story.supervised = draw.unit() < 0.5;
  const std::size_t robots = draw.unit() < 0.7 ? 1 : 2 + draw.below(2);
  story.hub = static_cast<HubFault>(draw.unit() < 0.3 ? 0 : 1 + draw.below(5));
  for (std::size_t i = 0; i < robots; ++i) {
    auto& faults = story.robots.emplace_back();
    const double many = draw.unit();
    const bool needed = story.hub == HubFault::None && i == 0;
    const std::size_t count = many < 0.15 && !needed ? 0 : many < 0.6 ? 1 : 2;
    for (std::size_t k = 0; k < count; ++k) faults.push_back(draw_fault(draw, choices[draw.below(choices.size())]));
  }
  story.hub_from = draw.between(0.0, 2.0);
  story.hub_until = story.hub_from + (draw.unit() < 0.4 ? draw.between(0.02, 0.4) : draw.between(0.3, 2.5));
  story.jump_ns = draw.between(0.02, draw.unit() < 0.5 ? 1.0 : 3600.0) * (draw.unit() < 0.5 ? -1 : 1);
  if (story.hub_goes() || story.hub == HubFault::Clock) story.hub_until = story.hub_from;
  return story;
}

}  // namespace tandem::faults
