// Modules that are linked into a program. The command `tandem` has none: it loads them (app/module). What links all of
// them, or a board's, says so by the source that it is linked with.
#pragma once
#include <span>
#include <string_view>

#include "hal/catalog.hpp"

namespace tandem::app {

struct LinkedModule {
  std::string_view name;
  void (*register_all)(hal::Registrar& registrar) = nullptr;
};
std::span<const LinkedModule> linked_modules() noexcept;

}  // namespace tandem::app
