#include "tests/hidden_robots/record_writer.hpp"

#include <bit>

namespace tandem::hidden {
namespace {

static_assert(std::endian::native == std::endian::little);

/// ISO 3309, bit by bit.
std::uint32_t crc32(std::string_view bytes) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const char c : bytes) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1U) != 0 ? (crc >> 1U) ^ 0xEDB88320U : crc >> 1U;
  }
  return ~crc;
}

}  // namespace

RecordWriter::RecordWriter() : bytes_("TANDEM RECORD 1\n") {}

void RecordWriter::row(std::int64_t tick, std::uint32_t stream, std::uint32_t members, std::string_view values) {
  std::string payload;
  append(payload, stream);
  append(payload, members);
  append(payload, std::uint32_t{1});
  append(payload, std::uint32_t{0});
  payload += values;
  block(4, tick, payload);
}

void RecordWriter::block(std::uint16_t type, std::int64_t tick, std::string_view payload) {
  std::string header = "TdmB";
  append(header, type);
  append(header, std::uint16_t{0});
  append(header, tick);
  append(header, static_cast<std::uint32_t>(payload.size()));
  append(header, crc32(payload));
  append(header, std::uint32_t{0});
  append(header, crc32(header));
  bytes_ += header;
  bytes_ += payload;
}

}  // namespace tandem::hidden
