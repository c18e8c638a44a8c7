// Bytes as people write them: "E9 14 93".
#pragma once
#include <cstddef>
#include <string_view>
#include <vector>

namespace tandem::bridges::eyebot_messages {

/// Two digits a byte; everything else is skipped.
inline std::vector<std::byte> hex(std::string_view text) {
  std::vector<std::byte> bytes;
  int digits = 0;
  unsigned value = 0;
  for (const char c : text) {
    const bool digit = c >= '0' && c <= '9';
    if (!digit && !(c >= 'A' && c <= 'F')) continue;
    value = value * 16 + static_cast<unsigned>(digit ? c - '0' : c - 'A' + 10);
    if (++digits % 2 == 0) {
      bytes.push_back(static_cast<std::byte>(value));
      value = 0;
    }
  }
  return bytes;
}

}  // namespace tandem::bridges::eyebot_messages
