// Messages of trackers as bytes, written from docs/trackers.md.
#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tandem::bridges::trackers {

using Bytes = std::vector<std::byte>;

inline Bytes text_bytes(std::string_view text) {
  Bytes bytes(text.size());
  std::memcpy(bytes.data(), text.data(), text.size());
  return bytes;
}

inline void put(Bytes& bytes, std::uint64_t value, std::size_t size, bool little) {
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t shift = 8 * (little ? i : size - 1 - i);
    bytes.push_back(static_cast<std::byte>(value >> shift & 0xFFU));
  }
}

struct Row {
  std::string id;
  double x = 0.0, y = 0.0, z = 0.0, heading = 0.0, sd = 0.0, sd_heading = 0.0;
};

inline Bytes compact(std::int64_t stamp_ns, const std::vector<Row>& rows) {
  Bytes bytes = text_bytes("TDP1");
  put(bytes, rows.size(), 2, true);
  put(bytes, 0, 2, true);
  put(bytes, static_cast<std::uint64_t>(stamp_ns), 8, true);
  for (const Row& row : rows) {
    Bytes name = text_bytes(row.id);
    name.resize(16);
    bytes.insert(bytes.end(), name.begin(), name.end());
    for (const double value : {row.x, row.y, row.z, row.heading, row.sd, row.sd_heading})
      put(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(value)), 4, true);
  }
  return bytes;
}

inline constexpr std::uint64_t kPosesFingerprint = 0x3B0C721C5A9738D7;

inline Bytes lcm_poses(std::int64_t stamp_ns, const std::vector<Row>& rows) {
  Bytes bytes;
  put(bytes, kPosesFingerprint, 8, false);
  put(bytes, static_cast<std::uint64_t>(stamp_ns), 8, false);
  put(bytes, rows.size(), 4, false);
  for (const Row& row : rows) {
    put(bytes, row.id.size() + 1, 4, false);
    const Bytes name = text_bytes(row.id);
    bytes.insert(bytes.end(), name.begin(), name.end());
    bytes.push_back(std::byte{0});
    for (const double value : {row.x, row.y, row.z, row.heading, row.sd, row.sd_heading})
      put(bytes, std::bit_cast<std::uint64_t>(value), 8, false);
  }
  return bytes;
}

}  // namespace tandem::bridges::trackers
