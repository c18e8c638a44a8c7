// Tokens: random words that prove a right, and their comparison.
#pragma once
#include <string>
#include <string_view>

#include "hal/result.hpp"

namespace tandem::hal {

/// 128 random bits of the system, as 32 hexadecimal digits. Error: it has none.
Result<std::string> make_token();

/// Whether two tokens are the same, in a time that does not depend on where they differ.
bool same_token(std::string_view a, std::string_view b) noexcept;

}  // namespace tandem::hal
