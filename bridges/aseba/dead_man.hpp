// A program for a node that drives motors: puts them to rest when the hub that drives them has fallen silent, whatever
// has become of hub, guardian and link.
//
//   at each of the node's own timer events     -> beat + 1, the signature is written
//   alive > 0                                  -> alive - 1
//   alive has just become 0                    -> the motors' words are set to rest, lapses + 1
//
// While alive is 0 it does nothing: other writers to the motors, people or programs, are left alone.
#pragma once
#include <string>
#include <vector>

#include "bridges/aseba/resident_program.hpp"
#include "hal/result.hpp"

namespace tandem::bridges::aseba {

/// Words of its mailbox.
namespace dead_man_mail {
inline constexpr std::uint16_t kAlive = 3;  ///< by the hub: timer events until the motors rest
inline constexpr std::uint16_t kWords = 4;
}  // namespace dead_man_mail

/// A word that is written, and the number that means rest.
struct RestWord {
  std::uint16_t address = 0;
  std::int16_t rest = 0;
};

/// The program for a node as it describes itself. Errors: it has no such event, or no room.
hal::Result<NodeProgram> make_dead_man(const NodeDescription& node, const std::string& timer_event,
                                       const std::vector<RestWord>& motors);

}  // namespace tandem::bridges::aseba
