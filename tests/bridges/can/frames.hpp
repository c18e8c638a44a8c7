// Frames made and compared.
#pragma once
#include <algorithm>

#include "bridges/can/frame.hpp"

namespace tandem::bridges {

/// Whether both say the same on the wire, whenever they arrived.
inline bool same_on_wire(const CanFrame& a, const CanFrame& b) noexcept {
  return a.id == b.id && a.extended == b.extended && a.remote == b.remote && a.size == b.size &&
         std::ranges::equal(a.bytes(), b.bytes());
}

/// A frame with these bytes, at most 8 of them.
inline CanFrame make_frame(std::uint32_t id, std::span<const std::uint8_t> bytes) noexcept {
  CanFrame frame;
  frame.id = id;
  frame.size = static_cast<std::uint8_t>(std::min<std::size_t>(bytes.size(), 8));
  std::copy_n(bytes.begin(), frame.size, frame.data.begin());
  return frame;
}

}  // namespace tandem::bridges
