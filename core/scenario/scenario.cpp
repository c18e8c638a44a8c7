#include "core/scenario/scenario.hpp"

namespace tandem::core {

std::uint16_t led_medium_number(const std::vector<MediumConfig>& media, const std::string& id) noexcept {
  std::uint16_t number = 0;
  for (const MediumConfig& medium : media) {
    ++number;
    if (medium.kind == "led" && !id.empty() && medium.id == id) return number;
  }
  return 0;
}

}  // namespace tandem::core
