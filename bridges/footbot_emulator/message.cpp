#include "bridges/footbot_emulator/message.hpp"

#include <algorithm>

#include "hal/check.hpp"

namespace tandem::bridges::footbot_emulator {
namespace {

constexpr std::string_view kHex = "0123456789ABCDEF";

}  // namespace

// 47 bits around the data; a stuff bit after 5 equal ones at first, then after every 4, in what comes before the check
// sum's delimiter [Bosch, CAN 2.0, section 5].
hal::TimeNs duration_ns(const Frame& frame) noexcept {
  const int bits = 8 * frame.size;
  return (47 + bits + (33 + bits) / 4) * hal::kNsPerSecond / 1'000'000;
}

std::string to_text(const Frame& frame) {
  std::string text = {kHex[frame.id >> 8U & 15U], kHex[frame.id >> 4U & 15U], kHex[frame.id & 15U], '#'};
  for (std::size_t i = 0; i < frame.size; ++i) {
    text += kHex[frame.data[i] >> 4U];
    text += kHex[frame.data[i] & 15U];
  }
  return text;
}

std::vector<Frame> to_frames(const Message& message) {
  TANDEM_CHECK(message.payload.size() <= kMostPayload, "nobody makes longer messages");
  std::vector<std::uint8_t> bytes = {static_cast<std::uint8_t>(message.type),
                                     static_cast<std::uint8_t>(message.type >> 8U)};
  bytes.insert(bytes.end(), message.payload.begin(), message.payload.end());
  std::vector<Frame> frames;
  for (std::size_t at = 0; at < bytes.size(); at += 8) {
    const bool first = at == 0;
    const bool last = at + 8 >= bytes.size();
    const Part part = first && last ? Part::Whole : first ? Part::First : last ? Part::Last : Part::Middle;
    Frame frame;
    frame.id = static_cast<std::uint16_t>(static_cast<unsigned>(part) | (message.source & 0xFFU));
    frame.size = static_cast<std::uint8_t>(std::min<std::size_t>(8, bytes.size() - at));
    std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), frame.size, frame.data.begin());
    frames.push_back(frame);
  }
  return frames;
}

}  // namespace tandem::bridges::footbot_emulator
