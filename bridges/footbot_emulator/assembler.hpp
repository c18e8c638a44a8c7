// Messages from frames, with the manners of the modules' own firmware.
#pragma once
#include <map>
#include <optional>

#include "bridges/footbot_emulator/message.hpp"

namespace tandem::bridges::footbot_emulator {

/// As ASEBA's can-net does it: what a sender has sent up to the last part of a message is the message, whether its
/// first part is there or not. So after a lost frame a wrong message may come out; nothing is checked, nothing times
/// out.
class Assembler {
 public:
  /// @returns a message when `frame` ends one
  std::optional<Message> push(const Frame& frame);

 private:
  std::map<std::uint8_t, std::vector<std::uint8_t>> open_;  // by sender
};

}  // namespace tandem::bridges::footbot_emulator
