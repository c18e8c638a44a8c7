#include "bridges/footbot_emulator/assembler.hpp"

#include <utility>

namespace tandem::bridges::footbot_emulator {
namespace {

std::optional<Message> message_of(std::uint8_t source, const std::vector<std::uint8_t>& bytes) {
  if (bytes.size() < 2) return std::nullopt;
  Message message;
  message.source = source;
  message.type = static_cast<std::uint16_t>(bytes[0] | bytes[1] << 8U);
  message.payload.assign(bytes.begin() + 2, bytes.end());
  return message;
}

}  // namespace

std::optional<Message> Assembler::push(const Frame& frame) {
  const auto source = static_cast<std::uint8_t>(frame.id);
  const auto part = static_cast<Part>(frame.id & 0x700U);
  const std::vector<std::uint8_t> bytes(frame.data.begin(), frame.data.begin() + frame.size);
  if (part == Part::Whole) return message_of(source, bytes);
  if (part != Part::First && part != Part::Middle && part != Part::Last) return std::nullopt;
  std::vector<std::uint8_t>& open = open_[source];
  open.insert(open.end(), bytes.begin(), bytes.end());
  const bool too_long = open.size() > kMostPayload + 2;
  if (part == Part::Last && !too_long) return message_of(source, std::exchange(open, {}));
  if (part == Part::Last || too_long) open.clear();  // the firmware's queue of frames overflows
  return std::nullopt;
}

}  // namespace tandem::bridges::footbot_emulator
