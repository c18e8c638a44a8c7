#include "app/outputs/robot_lines.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "core/run/roll_call.hpp"

namespace tandem::app {

/// "WORD 'ID' at TIME s: REST" and "WORD 'ID': REST"; whatever else is one line about no robot.
RobotLines::Held RobotLines::parted(hal::Severity severity, std::string_view text) {
  Held whole{severity, "", std::string(text), "", "", {}, 1, 0.0};
  const std::size_t quote = text.find(" '");
  if (quote == std::string_view::npos || quote == 0 || text.substr(0, quote).find_first_of(" :") != text.npos)
    return whole;
  const std::size_t end = text.find('\'', quote + 2);
  if (end == std::string_view::npos) return whole;
  std::string_view rest = text.substr(end + 1);
  std::string time;
  if (rest.starts_with(" at ")) {
    const std::size_t colon = rest.find(" s: ");
    if (colon == std::string_view::npos || rest.substr(4, colon - 4).find_first_not_of("0123456789.e+-") != rest.npos)
      return whole;
    time = rest.substr(4, colon - 4);
    rest = rest.substr(colon + 2);
  }
  if (!rest.starts_with(": ")) return whole;
  return {severity,
          std::string(text.substr(0, quote)),
          std::string(rest.substr(2)),
          time,
          time,
          {std::string(text.substr(quote + 2, end - quote - 2))},
          1,
          0.0};
}

void RobotLines::take(hal::Severity severity, std::string_view text, double now_s) {
  Held line = parted(severity, text);
  const auto same = std::ranges::find_if(held_, [&](const Held& held) {
    return held.severity == severity && held.kind == line.kind && held.rest == line.rest;
  });
  if (same == held_.end()) {
    line.since_s = now_s;
    held_.push_back(std::move(line));
    return;
  }
  ++same->times;
  same->last_s = line.last_s;
  for (std::string& id : line.ids) {
    if (std::ranges::find(same->ids, id) == same->ids.end()) same->ids.push_back(std::move(id));
  }
}

std::string RobotLines::text_of(const Held& held) {
  const std::size_t once = std::max<std::size_t>(1, held.ids.size());
  const std::string times = held.times > once ? fmt::format(" ({} times)", held.times) : "";
  if (held.kind.empty()) return held.rest + times;
  const std::string when = held.first_s.empty()          ? ""
                           : held.first_s == held.last_s ? " at " + held.first_s + " s"
                                                         : " at " + held.first_s + " to " + held.last_s + " s";
  const bool one = held.ids.size() == 1;
  const std::string who = one ? held.kind + " '" + held.ids[0] + "'" : held.kind + "s " + core::names_text(held.ids);
  return who + when + ": " + held.rest + times;
}

std::vector<std::string> RobotLines::due(double now_s, bool all) {
  warnings_ = std::min(static_cast<double>(kWarnings), warnings_ + (now_s - filled_s_) / kRefill_s);
  filled_s_ = now_s;
  std::vector<std::string> lines;
  std::erase_if(held_, [&](const Held& held) {
    if (!all && now_s - held.since_s < kHeld_s) return false;
    const bool informs = held.severity == hal::Severity::Info;
    if (!informs && !all && warnings_ < 1.0) return false;
    if (informs && infos_ >= kInfos) {
      left_out_ += held.times;
      return true;
    }
    if (informs)
      ++infos_;
    else
      warnings_ = std::max(0.0, warnings_ - 1.0);
    lines.push_back(text_of(held));
    return true;
  });
  return lines;
}

}  // namespace tandem::app
