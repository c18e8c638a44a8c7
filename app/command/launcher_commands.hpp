// Commands of the launcher at the top of a checkout, which this program lists, completes and documents.
#pragma once
#include <span>

#include "hal/command.hpp"

namespace tandem::app {

/// In the order of their names. Run here, each says where it is to be found.
std::span<const hal::CommandType> launcher_commands();

}  // namespace tandem::app
