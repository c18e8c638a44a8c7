#include <array>

#include "app/dynamics/register.hpp"
#include "app/module/linked_modules.hpp"

namespace tandem::app {

std::span<const LinkedModule> linked_modules() noexcept {
  static constexpr std::array<LinkedModule, 1> kAll = {{{"dynamics", &register_dynamics}}};
  return kAll;
}

}  // namespace tandem::app
