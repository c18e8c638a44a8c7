// Loop functions and user functions of ARGoS as hooks.
#pragma once
#include <vector>

#include "compat/argos3/facade/library.hpp"
#include "core/hook/hook.hpp"
#include "hal/catalog.hpp"

namespace tandem::compat::argos3 {

/// Registers those of kind "loop functions" and "user functions". User functions are hooks under "qt-opengl LABEL".
/// @throws std::runtime_error when the process has no room for so many
void register_hooks(const std::vector<const ::argos::tandem_detail::SRegistration*>& all, hal::Registrar& registrar);

/// A hook of the program itself, "argos3": lets CSimulator see the world; does nothing else.
const core::HookType& look_hook();

}  // namespace tandem::compat::argos3
