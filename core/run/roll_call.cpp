#include "core/run/roll_call.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace tandem::core {
namespace {

struct Numbered {
  std::string stem;
  std::uint64_t number = 0;
  bool has_number = false;
};

/// "ep12" is "ep" and 12. Numbers with leading zeros are no numbers.
Numbered numbered(const std::string& id) {
  std::size_t at = id.size();
  while (at > 0 && id[at - 1] >= '0' && id[at - 1] <= '9') --at;
  const std::size_t digits = id.size() - at;
  if (digits == 0 || digits > 9 || (digits > 1 && id[at] == '0')) return {id, 0, false};
  return {id.substr(0, at), std::stoull(id.substr(at)), true};
}

}  // namespace

std::string_view name_of(Presence presence) noexcept {
  constexpr std::array<std::string_view, 6> kNames = {"may_move", "waits", "unreachable", "stops", "drives", "stands"};
  return kNames[static_cast<std::size_t>(presence)];
}

std::vector<RollGroup> grouped(const std::vector<RollRow>& rows) {
  std::vector<RollGroup> groups;
  for (const RollRow& row : rows) {
    auto found = std::ranges::find_if(
        groups, [&](const RollGroup& g) { return g.presence == row.presence && g.why == row.why; });
    if (found == groups.end()) found = groups.insert(groups.end(), {row.presence, row.why, {}});
    found->ids.push_back(row.id);
  }
  std::ranges::stable_sort(groups, {}, &RollGroup::presence);
  return groups;
}

std::string names_text(const std::vector<std::string>& ids) {
  std::string text;
  for (std::size_t i = 0; i < ids.size();) {
    const Numbered first = numbered(ids[i]);
    std::size_t end = i + 1;
    for (; first.has_number && end < ids.size(); ++end) {
      const Numbered next = numbered(ids[end]);
      if (!next.has_number || next.stem != first.stem || next.number != first.number + (end - i)) break;
    }
    if (end - i < 3) end = i + 1;
    text += (text.empty() ? "" : ", ") + ids[i];
    if (end - i >= 3) text += " to " + ids[end - 1];
    i = end;
  }
  return text;
}

std::string text_of(const RollGroup& group) {
  const bool one = group.ids.size() == 1;
  const std::string names = names_text(group.ids), why = group.why.empty() ? "" : " (" + group.why + ")";
  const std::string count = group.ids.size() > 2 ? std::to_string(group.ids.size()) + " " : "";
  switch (group.presence) {
    case Presence::MayMove:
      return count + "NOT REACHED, AND NOT KNOWN TO REST: " + names + why;
    case Presence::WaitsForPerson:
      return count + (one ? "waits for a person: " : "wait for a person: ") + names + why;
    case Presence::Unreachable:
      return count + "not reached, at rest before: " + names + why;
    case Presence::Stops:
      return count + (one ? "is told to stop: " : "are told to stop: ") + names + why;
    case Presence::Drives:
      return count + (one ? "drives: " : "drive: ") + names;
    case Presence::Stands:
      return count + (one ? "stands: " : "stand: ") + names + why;
  }
  return names;
}

}  // namespace tandem::core
