// Division of an arena among the solvers of one engine: columns x lines, as experiment files spell it.
#pragma once
#include <cstddef>
#include <optional>
#include <string_view>

namespace tandem::core {

struct Split {
  std::size_t columns = 1;  ///< along x
  std::size_t lines = 1;    ///< along y
};

/// "4x2": whole numbers from 1 to 999. Anything else, "auto" among it, is none.
std::optional<Split> parse_split(std::string_view text) noexcept;

}  // namespace tandem::core
