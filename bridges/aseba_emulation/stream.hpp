// Messages as bytes, as switches serve them over TCP and robots on serial lines: length of the payload, source, type,
// each 16 bits little-endian, then the payload [ASEBA, transport/dashel].
#pragma once
#include <optional>
#include <span>

#include "bridges/aseba_emulation/message.hpp"

namespace tandem::bridges::aseba_emulation {

std::vector<std::uint8_t> to_bytes(const Message& message);

/// Cuts a stream into messages.
class StreamReader {
 public:
  void push(std::span<const std::uint8_t> bytes) { bytes_.insert(bytes_.end(), bytes.begin(), bytes.end()); }
  /// The next message that is whole.
  std::optional<Message> next();
  /// A length was announced that no message has: nothing that follows can be understood.
  bool broken() const noexcept { return broken_; }

 private:
  std::vector<std::uint8_t> bytes_;
  bool broken_ = false;
};

}  // namespace tandem::bridges::aseba_emulation
