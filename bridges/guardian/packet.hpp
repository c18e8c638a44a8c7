// Packets between hub and guardian, one a datagram.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "bridges/stop_messages.hpp"

namespace tandem::bridges::guardian {

enum class Word : char {
  // hub -> guardian
  Claim = 'C',     ///< lock this robot for us; answered by Claimed
  Watch = 'W',     ///< from now on stop it in this way when we are gone
  Release = 'R',   ///< it rests: nothing to do when we are gone
  Suspend = 'S',   ///< stop all robots: we are about to sleep
  Back = 'B',      ///< we were frozen and run again: stop all once more, then hand back
  TakeBack = 'T',  ///< hand back now, confirmed or not
  End = 'E',       ///< we end in order; what was not released is yours
  // guardian -> hub
  Claimed = 'c',     ///< `text`: why it was refused; "" when it was not
  Rests = 'r',       ///< the robot has confirmed its stop
  Moves = 'm',       ///< it has not; `text`: what is known
  HandedBack = 'h',  ///< it is the hub's turn again
  Warning = 'w'      ///< `text` is for people
};

/// Fields that a word does not need are empty.
struct Packet {
  Word word = Word::Warning;
  StopMessages robot = {};
  std::string text = {};
};

/// No packet is longer. `encode` of a longer one gives "".
inline constexpr std::size_t kLongestPacket = 128 * 1024;

std::string encode(const Packet& packet);
/// Nothing where `bytes` are no packet.
std::optional<Packet> decode(std::string_view bytes);

}  // namespace tandem::bridges::guardian
