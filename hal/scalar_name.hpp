// The names of scalars, as records and the lock-step protocol spell them: "f32", "u8", "bool", …
#pragma once
#include <optional>
#include <string_view>

#include "hal/port.hpp"

namespace tandem::hal {

std::string_view name_of(Scalar scalar) noexcept;
/// None: there is no scalar of this name.
std::optional<Scalar> scalar_from(std::string_view name) noexcept;

}  // namespace tandem::hal
