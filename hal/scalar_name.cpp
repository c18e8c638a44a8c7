#include "hal/scalar_name.hpp"

#include <array>
#include <cstddef>

namespace tandem::hal {
namespace {

constexpr std::array<std::string_view, 8> kNames = {"f32", "f64", "u8", "u16", "u32", "i32", "i64", "bool"};
static_assert(static_cast<std::size_t>(Scalar::Bool) + 1 == kNames.size(), "in the order of the enumerators");

}  // namespace

std::string_view name_of(Scalar scalar) noexcept {
  const auto index = static_cast<std::size_t>(scalar);
  return index < kNames.size() ? kNames[index] : std::string_view();
}

std::optional<Scalar> scalar_from(std::string_view name) noexcept {
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (kNames[i] == name) return static_cast<Scalar>(i);
  }
  return {};
}

}  // namespace tandem::hal
