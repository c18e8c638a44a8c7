#include "core/space/stores.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace tandem::core {

double Object::reach_m() const noexcept {
  return kind == Kind::Cylinder ? radius_m : std::hypot(half_x_m, half_y_m);
}

bool Object::lit() const noexcept {
  return alive && std::any_of(leds.begin(), leds.end(), [](const ObjectLed& led) { return led.color != hal::kBlack; });
}

void Bodies::resize(std::size_t rows) {
  for (auto* array : {&x_m, &y_m, &sin_h, &left_m_s, &right_m_s, &left_m, &right_m}) array->resize(rows, 0.0);
  cos_h.resize(rows, 1.0);
  radius_m.resize(rows, 0.0F);
  flags.resize(rows, 0);
  entity.resize(rows, 0xFFFFFFFFU);
  region.resize(rows, 0);
  if (has_motion) motion.resize(rows);
}

void Bodies::reserve(std::size_t rows) {
  for (auto* array : {&x_m, &y_m, &cos_h, &sin_h, &left_m_s, &right_m_s, &left_m, &right_m}) array->reserve(rows);
  radius_m.reserve(rows);
  flags.reserve(rows);
  entity.reserve(rows);
  region.reserve(rows);
  if (has_motion) motion.reserve(rows);
}

std::optional<std::uint32_t> SpaceStores::find_entity(std::string_view id) const noexcept {
  const std::size_t of_file = names.size() - added_robots.size();
  for (std::size_t i = 0; i < of_file; ++i) {
    const NameRange& range = names[i];
    if (range.count == 0 || !id.starts_with(range.prefix)) continue;
    const std::string_view digits = id.substr(range.prefix.size());
    if (range.base < 0) {
      if (digits.empty()) return range.first_entity;
      continue;
    }
    std::int64_t number = 0;
    const auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    const bool plain =
        status == std::errc{} && end == digits.data() + digits.size() && (digits.size() == 1 || digits[0] != '0');
    if (!plain || number < range.base || number >= range.base + range.count) continue;
    return range.first_entity + static_cast<std::uint32_t>(number - range.base);
  }
  if (added_robots.empty()) return std::nullopt;
  const auto added = added_robots.find(std::string(id));
  if (added == added_robots.end()) return std::nullopt;
  return added->second;
}

}  // namespace tandem::core
