// Bits of frames on the wire.
#include "tests/bridges/can/frame_bits.hpp"

#include <gtest/gtest.h>
#include <vector>

#include "tests/bridges/can/frames.hpp"

namespace tandem::bridges {
namespace {

CanFrame frame(std::uint32_t id, std::vector<std::uint8_t> data) {
  return make_frame(id, data);
}

// An independent count: the frame as text, its checksum by long division, its stuff bits by replacing.
std::size_t by_text(const CanFrame& f) {
  std::string bits = "0";
  const auto put = [&](std::uint32_t value, int count) {
    for (int i = count - 1; i >= 0; --i) bits += (value >> i & 1) != 0 ? '1' : '0';
  };
  put(f.id, 11);
  put(0, 3);
  put(f.size, 4);
  for (const std::uint8_t byte : f.bytes()) put(byte, 8);
  std::string rest = bits + std::string(15, '0');
  const std::string divisor = "1100010110011001";  // x15 + x14 + x10 + x8 + x7 + x4 + x3 + 1
  for (std::size_t i = 0; i + 15 < rest.size(); ++i) {
    if (rest[i] == '0') continue;
    for (std::size_t k = 0; k < divisor.size(); ++k) rest[i + k] = rest[i + k] == divisor[k] ? '0' : '1';
  }
  bits += rest.substr(rest.size() - 15);
  std::string stuffed;
  for (const char bit : bits) {
    stuffed += bit;
    if (stuffed.size() >= 5 && stuffed.substr(stuffed.size() - 5) == std::string(5, bit))
      stuffed += bit == '0' ? '1' : '0';
  }
  return stuffed.size() + 13;
}

TEST(FrameBits, AreThoseOfTheFrameAndItsStuffing) {
  std::uint32_t chance = 1;
  for (int i = 0; i < 2000; ++i) {
    std::vector<std::uint8_t> data(static_cast<std::size_t>(i % 9));
    for (auto& byte : data) {
      chance = chance * 1664525U + 1013904223U;
      byte = (chance >> 30U) == 0 ? 0 : (chance >> 30U) == 1 ? 0xFF : static_cast<std::uint8_t>(chance >> 20U);
    }
    const CanFrame f = frame(chance >> 7U & 0x7FFU, data);
    ASSERT_EQ(frame_bits(f), by_text(f)) << i;
  }
}

TEST(FrameBits, StayWithinTheirBounds) {
  EXPECT_GE(frame_bits(frame(0x555, {0x55, 0x55, 0x55, 0x55, 0x55, 0x55, 0x55, 0x55})), 111U);
  EXPECT_LE(frame_bits(frame(0, {0, 0, 0, 0, 0, 0, 0, 0})), 135U);
  EXPECT_GE(frame_bits(frame(0, {0, 0, 0, 0, 0, 0, 0, 0})), 125U);
  CanFrame extended = frame(0x15555555, {1, 2, 3, 4, 5, 6, 7, 8});
  extended.extended = true;
  EXPECT_GE(frame_bits(extended), 131U);
  EXPECT_LE(frame_bits(extended), 160U);
  CanFrame remote = frame(0x123, {});
  remote.remote = true;
  remote.size = 8;
  EXPECT_LE(frame_bits(remote), 55U);  // it asks for 8 bytes and carries none
}

}  // namespace
}  // namespace tandem::bridges
