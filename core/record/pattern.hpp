// Patterns of ids, and their choice from a space.
#pragma once
#include <string_view>

#include "core/scenario/scenario.hpp"
#include "core/space/space.hpp"
#include "hal/result.hpp"

namespace tandem::core {

/// Whether `text` fits `pattern`, in which each '*' stands for any number of characters.
bool fits_pattern(std::string_view text, std::string_view pattern) noexcept;

/// Error: a pattern that fits none of the space's robots; a port that no robot's controller took. `what` is written,
/// e.g. "record 'x'".
hal::Status check_chosen(const RecordConfig& config, const Space& space, std::string_view what);

}  // namespace tandem::core
