// Roles of people at a run, with their permissions.
#pragma once
#include <cstdint>

namespace tandem::hal {

/// Both see everything, and both may stop all real robots; operators alone command anything else.
enum class UserRole : std::uint8_t { Viewer, Operator };

constexpr const char* name_of(UserRole role) noexcept {
  return role == UserRole::Operator ? "operator" : "viewer";
}

}  // namespace tandem::hal
