// How often this program has allocated: for tests that promise that something does not.
#pragma once
#include <cstddef>

namespace tandem::mixed_reality {

std::size_t allocation_count() noexcept;

}  // namespace tandem::mixed_reality
