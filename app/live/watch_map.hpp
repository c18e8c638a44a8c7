// A small map of the arena in characters, for `--watch`.
#pragma once
#include <string>
#include <vector>

#include "app/process/screen.hpp"
#include "core/space/space.hpp"

namespace tandem::app {

/// The arena from above in a frame, x to the right, y up, as large as `room` lets it be, with its size and the
/// meaning of the signs. Robots show their headings (> ^ < v), several in one place their number. Empty: there is too
/// little room.
std::vector<std::string> arena_map(const core::Space& space, Screen::Size room);

}  // namespace tandem::app
