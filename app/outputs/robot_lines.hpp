// Messages about real robots on their way to a terminal: merged where they say the same of many, and never silent.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "hal/log.hpp"

namespace tandem::app {

/// Lines that begin with whom they are about ("robot 'ep0' at 0.3 s: driving", "KIND 'ep0': active") are held for
/// kHeld_s and then told as one where they differ in robot and time alone. Information has a budget of its own, and
/// what exceeds it is only counted. Warnings and errors have another one, which fills up again by kRefill_s a line:
/// while it is empty they wait, and those that say the same are drawn together. Nothing of them is dropped.
class RobotLines {
 public:
  static constexpr double kHeld_s = 0.3, kRefill_s = 2.0;
  static constexpr std::size_t kInfos = 20, kWarnings = 40;

  void take(hal::Severity severity, std::string_view text, double now_s);
  /// Lines that are due, in the order in which the first of each came. `all`: whatever is held.
  std::vector<std::string> due(double now_s, bool all = false);
  /// Unreported information.
  std::size_t left_out() const noexcept { return left_out_; }

 private:
  struct Held {
    hal::Severity severity;
    std::string kind, rest;        // "robot", "driving"; kind empty: a line about no robot
    std::string first_s, last_s;   // " at 0.3 s"; empty: it tells no time
    std::vector<std::string> ids;  // each once
    std::size_t times = 0;
    double since_s = 0.0;
  };
  static Held parted(hal::Severity severity, std::string_view text);
  static std::string text_of(const Held& held);

  std::vector<Held> held_;
  std::size_t infos_ = 0, left_out_ = 0;
  double warnings_ = kWarnings;  // that may be told now
  double filled_s_ = 0.0;
};

}  // namespace tandem::app
