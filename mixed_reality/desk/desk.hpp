// Rules for several people who command the same real robots: precedence and notices.
//
//   an emergency stop        at once, whoever says it; nobody else arms a robot within a second of it, and nobody by
//                            what was said before it
//   everything else          in the order in which it comes: the last word counts. One that turns back what somebody
//                            else said within two seconds is carried out, and both are named
#pragma once
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "hal/result.hpp"
#include "hal/time.hpp"

namespace tandem::mixed_reality {

/// One command of a person: its name as in the window's protocol, whom it is for ("*": all), who says it.
struct DeskWord {
  std::string command, robot = "*", who;
  hal::TimeNs at_ns = 0;  ///< CLOCK_MONOTONIC
};

struct DeskStatus {
  std::optional<DeskWord> last;               ///< that was carried out
  std::optional<DeskWord> stop;               ///< the last emergency stop
  std::map<std::string, std::uint64_t> said;  ///< commands, by author; of the first few
  std::uint64_t turned_back = 0;              ///< words that took back another one's
  std::uint64_t refused = 0;                  ///< arming that came too close to an emergency stop
};

/// Thread-safe.
class Desk {
 public:
  static constexpr hal::TimeNs kStopRules_ns = hal::kNsPerSecond;
  static constexpr hal::TimeNs kTurnsBack_ns = 2 * hal::kNsPerSecond;
  static constexpr std::size_t kMostNames = 32;

  /// Asked when a word is to be carried out. @returns a notice for its author; mostly empty.
  /// Error: it is not carried out.
  hal::Result<std::string> admit(const DeskWord& word, hal::TimeNs now_ns);
  /// An emergency stop, which needs no leave.
  void note_stop(const DeskWord& word);
  DeskStatus status() const;

 private:
  void count(const std::string& who);

  mutable std::mutex mutex_;
  DeskStatus status_;
};

}  // namespace tandem::mixed_reality
