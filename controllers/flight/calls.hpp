// Range-and-bearing messages of flying robots: the first byte says which.
#pragma once
#include <cstdint>

namespace tandem::controllers {

inline constexpr std::uint8_t kFollowMe = 0x46;   ///< nothing else in the message
inline constexpr std::uint8_t kFlockMate = 0x4D;  ///< then the sender's velocity in W: x, y, z in 2 cm/s, signed

}  // namespace tandem::controllers
