// Key of a body that engines move: a robot or a movable object.
#pragma once
#include <compare>
#include <cstddef>
#include <cstdint>

namespace tandem::core {

/// A robot by its row in Bodies, or an object by its number in SpaceStores::objects. Robots sort before objects.
struct BodyKey {
  std::uint32_t value = 0xFFFF'FFFFU;

  static constexpr std::uint32_t kObjectFlag = 0x8000'0000U;
  static BodyKey robot(std::size_t row) noexcept { return {static_cast<std::uint32_t>(row)}; }
  static BodyKey object(std::size_t number) noexcept { return {static_cast<std::uint32_t>(number) | kObjectFlag}; }

  bool is_object() const noexcept { return (value & kObjectFlag) != 0; }
  std::size_t index() const noexcept { return value & ~kObjectFlag; }
  friend auto operator<=>(const BodyKey&, const BodyKey&) = default;
};

}  // namespace tandem::core
