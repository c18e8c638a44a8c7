// Writes records as core/record/README.md describes them, and from that page alone: blocks, streams, rows.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace tandem::hidden {

/// A record that grows in memory. Blocks follow one another as they are added.
class RecordWriter {
 public:
  RecordWriter();

  /// A block whose payload is JSON: Start (1), Stream (2), Members (3), Event (6), End (8).
  void json(std::uint16_t type, std::int64_t tick, std::string_view text) { block(type, tick, text); }
  /// One row of a stream. `values` are its fields one after the other, little-endian.
  void row(std::int64_t tick, std::uint32_t stream, std::uint32_t members, std::string_view values);

  const std::string& bytes() const noexcept { return bytes_; }

 private:
  void block(std::uint16_t type, std::int64_t tick, std::string_view payload);

  std::string bytes_;
};

/// Appends a number as its bytes, the lowest first.
template <class T>
void append(std::string& bytes, T value) {
  const char* const first = reinterpret_cast<const char*>(&value);
  bytes.append(first, sizeof value);  // this machine is little-endian, as the record is
}

}  // namespace tandem::hidden
