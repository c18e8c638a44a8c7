#include "bridges/aseba_emulation/message.hpp"

namespace tandem::bridges::aseba_emulation {

std::uint16_t Message::word(std::size_t i) const noexcept {
  if (2 * i + 1 >= payload.size()) return 0;
  return static_cast<std::uint16_t>(payload[2 * i] | payload[2 * i + 1] << 8U);
}

Message& Message::add(std::uint16_t word) {
  payload.push_back(static_cast<std::uint8_t>(word));
  payload.push_back(static_cast<std::uint8_t>(word >> 8U));
  return *this;
}

Message& Message::add_text(std::string_view text) {
  text = text.substr(0, 255);
  payload.push_back(static_cast<std::uint8_t>(text.size()));
  payload.insert(payload.end(), text.begin(), text.end());
  return *this;
}

}  // namespace tandem::bridges::aseba_emulation
