// Names of the controllers and hooks that a checkout can build: written by CMake.
#pragma once
#include <span>
#include <string_view>

namespace tandem::app {

/// As files name them, without "lib" and ".so".
std::span<const std::string_view> own_plugins() noexcept;

}  // namespace tandem::app
