// Judges whether a bridge can drive robots of a kind that a file gives.
#pragma once
#include "hal/result.hpp"
#include "hal/robot_kind.hpp"

namespace tandem::mixed_reality {

/// Whether a bridge that was written for robots of the kind `real` can drive one that is built as `kind` says; null: as
/// `real`. It must move in the same way. Parts may be missing, and their figures may differ, but those of `real` have
/// as many sensors or lamps as there: messages have a place for each.
hal::Status check_built_as(const hal::RobotKind* kind, const hal::RobotKind& real);

}  // namespace tandem::mixed_reality
