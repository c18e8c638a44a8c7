#include "bridges/peer/frame.hpp"

#include <array>

namespace tandem::bridges::peer {
namespace {

constexpr std::uint8_t kMagic0 = 'T', kMagic1 = 'L';

constexpr std::array<std::uint32_t, 256> make_crc_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t n = 0; n < 256; ++n) {
    std::uint32_t c = n;
    for (int bit = 0; bit < 8; ++bit) c = (c & 1U) != 0 ? 0xEDB88320U ^ (c >> 1) : c >> 1;
    table[n] = c;
  }
  return table;
}

constexpr std::array<std::uint32_t, 256> kCrc = make_crc_table();

std::uint32_t read_u32(const std::uint8_t* at) noexcept {
  return std::uint32_t{at[0]} | std::uint32_t{at[1]} << 8 | std::uint32_t{at[2]} << 16 | std::uint32_t{at[3]} << 24;
}

void append_u32(std::vector<std::uint8_t>& out, std::uint32_t value) {
  for (unsigned shift = 0; shift < 32; shift += 8) out.push_back(static_cast<std::uint8_t>(value >> shift));
}

/// Of a header: so that a length that was garbled does not swallow what follows.
std::uint8_t check_of(const std::uint8_t* header) noexcept {
  const unsigned sum = 0U + header[2] + header[4] + header[5] + header[6] + header[7];
  return static_cast<std::uint8_t>(255U - (sum & 0xFFU));
}

bool known(std::uint8_t type) noexcept {
  return type >= static_cast<std::uint8_t>(MessageType::Hello) && type <= static_cast<std::uint8_t>(MessageType::Bye);
}

}  // namespace

std::uint32_t crc32(std::span<const std::uint8_t> bytes) noexcept {
  std::uint32_t c = 0xFFFFFFFFU;
  for (const std::uint8_t byte : bytes) c = kCrc[(c ^ byte) & 0xFFU] ^ (c >> 8);
  return c ^ 0xFFFFFFFFU;
}

std::vector<std::uint8_t> frame_of(MessageType type, std::span<const std::uint8_t> payload) {
  std::vector<std::uint8_t> frame;
  frame.reserve(kHeaderBytes + payload.size() + 4);
  frame = {kMagic0, kMagic1, static_cast<std::uint8_t>(type), 0};
  append_u32(frame, static_cast<std::uint32_t>(payload.size()));
  frame[3] = check_of(frame.data());
  frame.insert(frame.end(), payload.begin(), payload.end());
  append_u32(frame, crc32(std::span(frame).subspan(2)));
  return frame;
}

void FrameReader::push(std::span<const std::uint8_t> bytes) {
  bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(taken_));
  taken_ = 0;
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
}

std::optional<FrameReader::Frame> FrameReader::next() {
  for (;; ++taken_, ++skipped_) {
    const std::size_t left = bytes_.size() - taken_;
    const std::uint8_t* const at = bytes_.data() + taken_;
    if (left == 0 || (left == 1 && at[0] == kMagic0)) return std::nullopt;
    if (at[0] != kMagic0 || at[1] != kMagic1) continue;
    if (left < kHeaderBytes) return std::nullopt;
    const std::size_t size = read_u32(at + 4);
    if (at[3] != check_of(at) || !known(at[2]) || size > kMostPayloadBytes) continue;
    if (left < kHeaderBytes + size + 4) return std::nullopt;
    const std::span<const std::uint8_t> checked(at + 2, kHeaderBytes - 2 + size);
    if (crc32(checked) != read_u32(at + kHeaderBytes + size)) {
      ++garbled_;
      continue;
    }
    taken_ += kHeaderBytes + size + 4;
    return Frame{static_cast<MessageType>(at[2]), checked.subspan(kHeaderBytes - 2)};
  }
}

void FrameReader::clear() noexcept {
  bytes_.clear();
  taken_ = 0;
}

}  // namespace tandem::bridges::peer
