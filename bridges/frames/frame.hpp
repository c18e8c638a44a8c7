// One grey picture, as a camera took it.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "hal/time.hpp"

namespace tandem::bridges::frames {

struct Frame {
  std::size_t width = 0, height = 0;
  std::vector<std::uint8_t> grey{};        ///< 0 black; lines from the top, each from the left, without gaps
  std::optional<std::int64_t> stamp_ns{};  ///< of the exposure; nothing: the source has no clock
  hal::TimeNs received_ns = 0;             ///< CLOCK_MONOTONIC: when its last byte had come
};

inline constexpr std::size_t kMostPixels = std::size_t{64} << 20U;  ///< of a frame

}  // namespace tandem::bridges::frames
