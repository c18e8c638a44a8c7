// A CAN 2.0 frame.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "hal/time.hpp"

namespace tandem::bridges {

inline constexpr std::uint32_t kLargestStandardId = 0x7FF;
inline constexpr std::uint32_t kLargestExtendedId = 0x1FFFFFFF;

/// One frame as users see it; valid when the identifier fits its kind and `size` is at most 8.
struct CanFrame {
  std::uint32_t id = 0;
  bool extended = false;  ///< 29-bit identifier
  bool remote = false;    ///< asks for data, carries none; `size` is how many are asked for
  std::uint8_t size = 0;
  std::array<std::uint8_t, 8> data{};
  hal::TimeNs at_ns = 0;  ///< arrival, CLOCK_MONOTONIC or the link's clock; not sent

  std::span<const std::uint8_t> bytes() const noexcept {
    return {data.data(), remote ? std::size_t{0} : std::min<std::size_t>(size, data.size())};
  }
  bool valid() const noexcept { return size <= 8 && id <= (extended ? kLargestExtendedId : kLargestStandardId); }
};

}  // namespace tandem::bridges
