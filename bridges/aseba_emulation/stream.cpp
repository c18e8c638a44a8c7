#include "bridges/aseba_emulation/stream.hpp"

namespace tandem::bridges::aseba_emulation {
namespace {

constexpr std::size_t kHeader = 6;

}  // namespace

std::vector<std::uint8_t> to_bytes(const Message& message) {
  Message head;
  head.add(static_cast<std::uint16_t>(message.payload.size())).add(message.source).add(message.type);
  head.payload.insert(head.payload.end(), message.payload.begin(), message.payload.end());
  return head.payload;
}

std::optional<Message> StreamReader::next() {
  const auto word = [this](std::size_t at) { return static_cast<std::uint16_t>(bytes_[at] | bytes_[at + 1] << 8U); };
  if (broken_ || bytes_.size() < kHeader) return std::nullopt;
  const std::size_t length = word(0);
  broken_ = length > kMostPayload;
  if (broken_ || bytes_.size() < kHeader + length) return std::nullopt;
  const auto begin = bytes_.begin() + kHeader;
  const auto end = begin + static_cast<std::ptrdiff_t>(length);
  Message message{word(2), word(4), {begin, end}};
  bytes_.erase(bytes_.begin(), end);
  return message;
}

}  // namespace tandem::bridges::aseba_emulation
