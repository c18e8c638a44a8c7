// Owners of halts: holders that keep a robot from obeying its controller.
#pragma once
#include <cstdint>

namespace tandem::core {

/// A robot is halted as long as anyone holds it, and each lets go only of what it holds itself. Bits of
/// `RobotBlock::halted`.
enum class HaltOwner : std::uint8_t {
  Hook = 1,        ///< a hook
  Controller = 2,  ///< its controller threw
  Safety = 4,      ///< the safety table of a real robot
  Operator = 8,    ///< a person, through a view or a console
  Removed = 16     ///< none: the robot is gone, and its slot is empty
};

/// Beside the owners' bits: the controller threw in this tick, which is not reported yet.
inline constexpr std::uint8_t kThrewInThisTick = 128;

constexpr std::uint8_t bit(HaltOwner owner) noexcept {
  return static_cast<std::uint8_t>(owner);
}

}  // namespace tandem::core
