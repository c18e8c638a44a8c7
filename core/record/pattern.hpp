// Patterns of ids.
#pragma once
#include <string_view>

namespace tandem::core {

/// Whether `text` fits `pattern`, in which each '*' stands for any number of characters.
bool fits_pattern(std::string_view text, std::string_view pattern) noexcept;

}  // namespace tandem::core
