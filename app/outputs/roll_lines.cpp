#include "app/outputs/roll_lines.hpp"

#include "app/process/screen.hpp"

namespace tandem::app {

using core::RollGroup;
using core::RollRow;

std::vector<std::string> roll_lines(const std::vector<RollRow>& rows, std::size_t columns) {
  std::vector<std::string> lines;
  for (const RollGroup& group : core::grouped(rows)) {
    std::string rest = text_of(group);
    while (columns > 4 && width_of(rest) > columns) {
      std::size_t at = rest.rfind(' ', columns);
      if (at == std::string::npos || at < columns / 2) at = cut_to(rest, columns - 1).size() - std::string("…").size();
      lines.push_back(rest.substr(0, at));
      rest = "  " + rest.substr(rest[at] == ' ' ? at + 1 : at);
    }
    lines.push_back(rest);
  }
  return lines;
}

std::vector<std::string> RollTeller::look(const std::vector<RollRow>& rows, double now_s) {
  if (now_s - told_s_ < (times_ < kOften ? kEvery_s : kLater_s)) return {};
  std::vector<RollRow> urgent;
  for (const RollRow& row : rows) {
    if (is_urgent(row.presence)) urgent.push_back(row);
  }
  std::vector<std::string> lines = roll_lines(urgent, 0);
  if (lines == told_) return {};
  told_ = lines;
  told_s_ = now_s;
  ++times_;
  if (lines.empty()) return {"all real robots are reached, and none waits for a person"};
  for (std::string& line : lines) line.insert(0, "real robots: ");
  return lines;
}

}  // namespace tandem::app
