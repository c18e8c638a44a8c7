#include "mixed_reality/desk/desk.hpp"

#include <array>
#include <utility>

#include "hal/unit.hpp"

namespace tandem::mixed_reality {
namespace {

using Pair = std::pair<std::string_view, std::string_view>;
constexpr std::array<Pair, 2> kOpposites = {{{"pause", "play"}, {"halt", "release"}}};

bool turns_back(const DeskWord& word, const DeskWord& before) {
  const bool same_robot = word.robot == before.robot || word.robot == "*" || before.robot == "*";
  if (!same_robot) return false;
  for (const auto& [one, other] : kOpposites) {
    if ((word.command == one && before.command == other) || (word.command == other && before.command == one))
      return true;
  }
  return false;
}

bool arms(const DeskWord& word) {
  return word.command == "arm" || word.command == "rearm" || word.command == "first_motion";
}

std::string ago(hal::TimeNs span_ns) {
  return hal::format_number(static_cast<double>(span_ns / (100 * hal::kNsPerMs)) / 10.0) + " s ago";
}

}  // namespace

hal::Result<std::string> Desk::admit(const DeskWord& word, hal::TimeNs now_ns) {
  const std::lock_guard hold(mutex_);
  count(word.who);
  if (status_.stop && arms(word)) {
    const DeskWord& stop = *status_.stop;
    const bool before = word.at_ns < stop.at_ns;
    if (before || (word.who != stop.who && now_ns - stop.at_ns < kStopRules_ns)) {
      ++status_.refused;
      return hal::Error{"'" + stop.who + "' has stopped all real robots " + ago(now_ns - stop.at_ns) +
                        (before ? ", after this was said" : "") + "; say it again if they are to drive"};
    }
  }
  std::string note;
  if (status_.last && status_.last->who != word.who && word.at_ns - status_.last->at_ns < kTurnsBack_ns &&
      turns_back(word, *status_.last)) {
    ++status_.turned_back;
    note = "this takes back '" + status_.last->command + "' of '" + status_.last->who + "', " +
           ago(word.at_ns - status_.last->at_ns);
  }
  status_.last = word;
  return note;
}

void Desk::note_stop(const DeskWord& word) {
  const std::lock_guard hold(mutex_);
  count(word.who);
  status_.stop = status_.last = word;
}

void Desk::count(const std::string& who) {
  auto& said = status_.said;
  if (said.contains(who) || said.size() < kMostNames) ++said[who];
}

DeskStatus Desk::status() const {
  const std::lock_guard hold(mutex_);
  return status_;
}

}  // namespace tandem::mixed_reality
