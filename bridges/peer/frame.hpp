// Frames of the lock-step protocol: how messages lie in a stream of bytes that may lose or garble some.
//
//   offset  0  2 bytes  'T' 'L'
//           2  u8       type of the message
//           3  u8       check: 255 minus the sum of the bytes 2 and 4 to 7, modulo 256
//           4  u32      n, length of the payload, at most 1 MiB
//           8  n bytes  payload
//       8 + n  u32      CRC-32 of the bytes 2 to 7 + n (ISO 3309, as in zlib and PNG)
//
// All numbers are little-endian.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tandem::bridges::peer {

inline constexpr std::size_t kHeaderBytes = 8;
inline constexpr std::size_t kMostPayloadBytes = std::size_t{1} << 20;

enum class MessageType : std::uint8_t {
  Hello = 1,     ///< peer to hub: which robot's controller it has (JSON)
  Robot = 2,     ///< hub to peer: the robot, its ports, the run (JSON)
  Ready = 3,     ///< peer to hub: the ports that its controller took (JSON)
  Tick = 4,      ///< hub to peer: readings of one tick
  Commands = 5,  ///< peer to hub: the answer
  End = 6,       ///< hub to peer: nothing more will be asked (JSON)
  Bye = 7        ///< peer to hub: it ends by itself (JSON)
};

/// CRC-32 of ISO 3309 [RFC 1952, section 8].
std::uint32_t crc32(std::span<const std::uint8_t> bytes) noexcept;

/// A message as it goes over the wire.
std::vector<std::uint8_t> frame_of(MessageType type, std::span<const std::uint8_t> payload);

/// Finds frames in a stream. What is none is skipped, and counted.
class FrameReader {
 public:
  struct Frame {
    MessageType type;
    std::span<const std::uint8_t> payload;  ///< valid until the next call of anything here
  };

  void push(std::span<const std::uint8_t> bytes);
  /// The next whole frame; nothing: more bytes are needed.
  std::optional<Frame> next();
  /// Forgets what has come.
  void clear() noexcept;

  std::uint64_t garbled() const noexcept { return garbled_; }  ///< frames whose checksum was wrong
  std::uint64_t skipped_bytes() const noexcept { return skipped_; }

 private:
  std::vector<std::uint8_t> bytes_;
  std::size_t taken_ = 0;  // of them
  std::uint64_t garbled_ = 0, skipped_ = 0;
};

}  // namespace tandem::bridges::peer
