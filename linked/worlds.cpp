#include <array>

#include "app/dynamics/register.hpp"
#include "app/module/linked_modules.hpp"
#include "compat/argos3/register.hpp"

namespace tandem::app {

std::span<const LinkedModule> linked_modules() noexcept {
  static constexpr std::array<LinkedModule, 2> kAll = {
      {{"dynamics", &register_dynamics}, {"argos3", &register_argos3}}};
  return kAll;
}

}  // namespace tandem::app
