// Errors that a space answers with.
#pragma once
#include <string>

#include "hal/result.hpp"

namespace tandem::core {

/// Of what there is not, or no more: "robot".
hal::Error gone(const char* what);
/// Of an id that cannot be given.
hal::Error taken(const std::string& id);
/// Of what needs an editor.
hal::Error no_world();

}  // namespace tandem::core
