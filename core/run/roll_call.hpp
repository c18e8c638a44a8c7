// Roll call of real robots: those that may move, wait for a person, are not reached; in groups, for people.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tandem::core {

/// In the order in which people are informed.
enum class Presence : std::uint8_t {
  MayMove,         ///< it cannot be reached, and is not known to rest
  WaitsForPerson,  ///< it stands until it is armed
  Unreachable,     ///< it cannot be reached, and was at rest before
  Stops,           ///< it was ordered to stand, and does not yet
  Drives,
  Stands
};
/// "may_move", as in messages.
std::string_view name_of(Presence presence) noexcept;

struct RollRow {
  std::string id;
  Presence presence = Presence::Stands;
  std::string why;  ///< it does not drive, for people: "link lost (no answer)"; empty where it does
};

/// Robots of which the same is to be said.
struct RollGroup {
  Presence presence = Presence::Stands;
  std::string why;
  std::vector<std::string> ids;  ///< in the order of the rows
};
/// By presence, then by first appearance.
std::vector<RollGroup> grouped(const std::vector<RollRow>& rows);

/// "ep0 to ep11, ep14": all of them, runs of three numbers and more drawn together; never cut.
std::string names_text(const std::vector<std::string>& ids);
/// "NOT REACHED, MAY STILL MOVE: ep3, ep7 (link lost)"
std::string text_of(const RollGroup& group);
/// Whether people are to do something about it.
constexpr bool is_urgent(Presence presence) noexcept {
  return presence <= Presence::Unreachable;
}

}  // namespace tandem::core
