// Block file: an append-only file of checksummed blocks, readable up to the last whole one however its writer ended.
//
// Byte for byte, all numbers little-endian: 16 bytes "TANDEM RECORD 1\n", then blocks. A block is a header of 32 bytes
//
//   offset  0  4 bytes  "TdmB"
//           4  u16      type
//           6  u16      0
//           8  i64      tick
//          16  u32      bytes of payload, at most 2^30
//          20  u32      CRC-32 of the payload (ISO 3309, as in zlib and PNG)
//          24  u32      0
//          28  u32      CRC-32 of the bytes 0 to 27
//
// and its payload.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hal/result.hpp"
#include "hal/time.hpp"

namespace tandem::core {

inline constexpr std::string_view kBlockFileStart = "TANDEM RECORD 1\n";
inline constexpr std::size_t kBlockHeaderBytes = 32;
inline constexpr std::size_t kMostPayloadBytes = std::size_t{1} << 30;

/// Appends a block to `out`. At most kMostPayloadBytes of payload.
void append_block(std::string& out, std::uint16_t type, hal::Tick tick, std::string_view payload);

/// The same for a payload that is appended between the two calls. @returns `begin` of the second
std::size_t begin_block(std::string& out);
void end_block(std::string& out, std::size_t begin, std::uint16_t type, hal::Tick tick);

/// One block. The payload is the reader's, and valid as long as that is.
struct Block {
  std::uint16_t type = 0;
  hal::Tick tick = 0;
  std::string_view payload;
  std::size_t at = 0;  ///< where it begins in the file
};

/// Reads a block file. No input is undefined: what is damaged is left out and reported.
class BlockFileReader {
 public:
  /// Maps the file into memory; it must not shrink meanwhile. Errors: cannot be read; no block file; another version.
  static hal::Result<BlockFileReader> open(const std::string& path);
  /// Blocks in memory, without the file's beginning; they must stay there.
  static BlockFileReader of(std::string_view blocks);
  BlockFileReader(BlockFileReader&&) noexcept = default;
  BlockFileReader& operator=(BlockFileReader&&) noexcept = default;

  /// The next whole block; nothing at the end.
  std::optional<Block> next();
  /// The next, whose payload may be damaged: looks at its header alone.
  std::optional<Block> next_unchecked();
  /// Goes on with the block that begins there, as `Block::at` says.
  void go_to(std::size_t at) noexcept { at_ = at; }
  std::size_t at() const noexcept { return at_; }
  std::size_t size() const noexcept { return size_; }

  /// What has been met so far, in the file's order: one line each, "at byte 4711: …".
  std::vector<std::string> damage() const;
  /// Whether the file ended in the middle of a block: its writer was killed, or the disk was full.
  bool cut() const noexcept { return cut_; }

 private:
  BlockFileReader() = default;
  void note(std::size_t at, std::string_view what);

  std::shared_ptr<const char> data_;  // mapped
  std::size_t size_ = 0, at_ = 0;
  std::map<std::size_t, std::string> damage_;  // by where it is
  bool cut_ = false;
};

}  // namespace tandem::core
