#include "tests/bridges/can/frame_bits.hpp"

#include <cstdint>

namespace tandem::bridges {
namespace {

constexpr std::size_t kUnstuffed = 1 + 2 + 7 + 3;  // checksum's delimiter, acknowledge, end of frame, pause

/// Counts bits, stuffs them and sums them up as a controller does.
class Wire {
 public:
  void put(std::uint32_t bits, unsigned count) noexcept {
    for (unsigned i = count; i > 0; --i) sum_and_put((bits >> (i - 1) & 1U) != 0);
  }
  std::size_t end() noexcept {
    const std::uint32_t sum = sum_;
    for (unsigned i = 15; i > 0; --i) put_bit((sum >> (i - 1) & 1U) != 0);
    return bits_ + kUnstuffed;
  }

 private:
  void sum_and_put(bool bit) noexcept {
    const bool over = bit != ((sum_ >> 14U & 1U) != 0);
    sum_ = sum_ << 1U & 0x7FFFU;
    if (over) sum_ ^= 0x4599U;
    put_bit(bit);
  }
  void put_bit(bool bit) noexcept {
    run_ = bits_ > 0 && bit == last_ ? run_ + 1 : 1;
    last_ = bit;
    ++bits_;
    if (run_ < 5) return;
    ++bits_;  // five alike are followed by one that differs, which begins a run itself
    last_ = !bit;
    run_ = 1;
  }

  std::uint32_t sum_ = 0;
  std::size_t bits_ = 0;
  unsigned run_ = 0;
  bool last_ = false;
};

}  // namespace

std::size_t frame_bits(const CanFrame& frame) noexcept {
  Wire wire;
  wire.put(0, 1);  // start of frame
  const std::uint32_t remote = frame.remote ? 1 : 0;
  if (frame.extended) {
    wire.put(frame.id >> 18U, 11);
    wire.put(3, 2);  // substitute remote request, extension
    wire.put(frame.id & 0x3FFFFU, 18);
    wire.put(remote << 2U, 3);
  } else {
    wire.put(frame.id, 11);
    wire.put(remote << 2U, 3);  // remote request, no extension, reserved
  }
  wire.put(frame.size, 4);
  for (const std::uint8_t byte : frame.bytes()) wire.put(byte, 8);
  return wire.end();
}

}  // namespace tandem::bridges
