#include "core/record/block_file.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <libdeflate.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "hal/check.hpp"
#include "hal/input_file.hpp"

namespace tandem::core {
namespace {

static_assert(std::endian::native == std::endian::little, "the file's numbers are written as they lie in memory");

constexpr std::array<char, 4> kMagic = {'T', 'd', 'm', 'B'};
constexpr std::size_t kFamily = 14;  // "TANDEM RECORD ", without the version

struct Header {
  std::array<char, 4> magic = kMagic;
  std::uint16_t type = 0, zero = 0;
  std::int64_t tick = 0;
  std::uint32_t bytes = 0, payload_crc = 0, zero_too = 0, crc = 0;
};
static_assert(sizeof(Header) == kBlockHeaderBytes);

std::uint32_t crc_of(const void* data, std::size_t bytes) noexcept {
  return libdeflate_crc32(0, data, bytes);
}

std::uint32_t crc_of(const Header& header) noexcept {
  return crc_of(&header, offsetof(Header, crc));
}

bool sound(const Header& header) noexcept {
  return header.magic == kMagic && header.crc == crc_of(header) && header.bytes <= kMostPayloadBytes;
}

}  // namespace

std::size_t begin_block(std::string& out) {
  const std::size_t begin = out.size();
  out.append(kBlockHeaderBytes, '\0');
  return begin;
}

void end_block(std::string& out, std::size_t begin, std::uint16_t type, hal::Tick tick) {
  const std::string_view payload = std::string_view(out).substr(begin + kBlockHeaderBytes);
  TANDEM_CHECK(payload.size() <= kMostPayloadBytes, "a block is larger than its format allows");
  Header header;
  header.type = type;
  header.tick = tick;
  header.bytes = static_cast<std::uint32_t>(payload.size());
  header.payload_crc = crc_of(payload.data(), payload.size());
  header.crc = crc_of(header);
  std::memcpy(out.data() + begin, &header, sizeof header);
}

void append_block(std::string& out, std::uint16_t type, hal::Tick tick, std::string_view payload) {
  const std::size_t begin = begin_block(out);
  out += payload;
  end_block(out, begin, type, tick);
}

hal::Result<BlockFileReader> BlockFileReader::open(const std::string& path) {
  const auto failed = [&path](const std::string& why) { return hal::Error{"record '" + path + "': " + why}; };
  const auto opened = hal::open_input_file(path, "record");
  if (!opened.ok()) return opened.error();
  const int fd = opened.value();
  struct stat info {};
  if (::fstat(fd, &info) != 0) {
    const int error = errno;
    ::close(fd);
    return failed(std::strerror(error));
  }
  BlockFileReader reader;
  reader.size_ = static_cast<std::size_t>(info.st_size);
  if (reader.size_ < kBlockFileStart.size()) {
    ::close(fd);
    return failed("is no record: it has " + std::to_string(reader.size_) + " bytes");
  }
  void* const data = ::mmap(nullptr, reader.size_, PROT_READ, MAP_PRIVATE, fd, 0);
  const int error = errno;
  ::close(fd);
  if (data == MAP_FAILED) return failed(std::strerror(error));
  reader.data_ = {static_cast<const char*>(data),
                  [size = reader.size_](const char* mapped) { ::munmap(const_cast<char*>(mapped), size); }};
  const std::string_view start(reader.data_.get(), kBlockFileStart.size());
  if (start.substr(0, kFamily) != kBlockFileStart.substr(0, kFamily))
    return failed("is no record: those are made by `tandem run --record`");
  if (start != kBlockFileStart)
    return failed(
        "is of a version of the format that this program does not know; read it with the release that wrote it");
  reader.at_ = kBlockFileStart.size();
  return reader;
}

BlockFileReader BlockFileReader::of(std::string_view blocks) {
  BlockFileReader reader;
  reader.data_ = {blocks.data(), [](const char*) {}};
  reader.size_ = blocks.size();
  return reader;
}

void BlockFileReader::note(std::size_t at, std::string_view what) {
  damage_.emplace(at, "at byte " + std::to_string(at) + ": " + std::string(what));
}

std::vector<std::string> BlockFileReader::damage() const {
  std::vector<std::string> lines;
  for (const auto& [at, line] : damage_) lines.push_back(line);
  return lines;
}

std::optional<Block> BlockFileReader::next() {
  while (const std::optional<Block> block = next_unchecked()) {
    Header header;
    std::memcpy(&header, data_.get() + block->at, sizeof header);
    if (crc_of(block->payload.data(), block->payload.size()) == header.payload_crc) return block;
    note(block->at, "a block of tick " + std::to_string(block->tick) + " is damaged and left out");
  }
  return {};
}

std::optional<Block> BlockFileReader::next_unchecked() {
  const char* const data = data_.get();
  while (at_ < size_) {
    const std::size_t begin = at_;
    Header header;
    if (size_ - at_ >= sizeof header) std::memcpy(&header, data + at_, sizeof header);
    if (size_ - at_ < sizeof header || !sound(header)) {
      // Look for the next header that is whole.
      const char* found = data + at_ + 1;
      for (;; ++found) {
        found = std::search(found, data + size_, kMagic.begin(), kMagic.end());
        if (static_cast<std::size_t>(data + size_ - found) < sizeof header) {
          found = nullptr;
          break;
        }
        std::memcpy(&header, found, sizeof header);
        if (sound(header)) break;
      }
      if (found == nullptr) {
        cut_ = true;
        at_ = size_;
        return {};
      }
      note(begin, "a block's header is damaged; " + std::to_string(found - data - static_cast<long>(begin)) +
                      " bytes are left out");
      at_ = static_cast<std::size_t>(found - data);
      continue;
    }
    at_ += sizeof header;
    if (header.bytes > size_ - at_) {
      cut_ = true;
      at_ = size_;
      return {};
    }
    const std::string_view payload(data + at_, header.bytes);
    at_ += header.bytes;
    return Block{header.type, header.tick, payload, begin};
  }
  return {};
}

}  // namespace tandem::core
