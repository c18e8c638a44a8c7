#include <array>

#include "app/dynamics/register.hpp"
#include "app/live/register.hpp"
#include "app/module/linked_modules.hpp"
#include "app/pictures/register.hpp"
#include "app/real/register.hpp"
#include "app/study/register.hpp"
#include "app/window/register.hpp"
#include "compat/argos3/register.hpp"
#include "lab/register.hpp"

namespace tandem::app {

std::span<const LinkedModule> linked_modules() noexcept {
  static constexpr std::array<LinkedModule, 8> kAll = {{{"dynamics", &register_dynamics},
                                                        {"live", &register_live},
                                                        {"pictures", &register_pictures},
                                                        {"real", &register_real},
                                                        {"window", &register_window},
                                                        {"study", &register_study},
                                                        {"lab", &register_lab},
                                                        {"argos3", &register_argos3}}};
  return kAll;
}

}  // namespace tandem::app
