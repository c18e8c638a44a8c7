#include "app/module/linked_modules.hpp"

namespace tandem::app {

std::span<const LinkedModule> linked_modules() noexcept {
  return {};
}

}  // namespace tandem::app
