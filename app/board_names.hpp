// The names in experiment files, for a program that simulates nothing.
#pragma once
#include "core/config/reader.hpp"

namespace tandem::app {

/// Every name that the whole program knows, told from the control interface alone: a file that was tried in simulation
/// is read on a robot's board as it is.
core::KnownNames board_names();

}  // namespace tandem::app
