// Messages that have a robot's variables rest, and their text in `StopMessages`.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tandem::bridges::aseba {

/// A message that has variables of one node rest.
struct RestMessage {
  std::uint16_t type = 0;
  std::vector<std::uint8_t> payload;
  /// The robot rests only when these values are read back. Not where a module does not hold what was written, and not
  /// of modules that the robot drives without.
  bool confirm = false;
  friend bool operator==(const RestMessage&, const RestMessage&) = default;
};

/// One message a line: its type, a blank, its payload in hexadecimal digits, "read back" where it is to be confirmed.
std::string to_stop_body(const std::vector<RestMessage>& messages);

/// The same back; nothing where the text is not of that form.
std::optional<std::vector<RestMessage>> from_stop_body(std::string_view body);

}  // namespace tandem::bridges::aseba
