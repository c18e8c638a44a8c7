// Colours as files and scripts write them: a name, or "r,g,b" of 0 to 255. The names are those of ARGoS' files.
#pragma once
#include <array>
#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

#include "hal/rgb.hpp"

namespace tandem::hal {

struct NamedColor {
  std::string_view name;
  Rgb color;
};

constexpr Rgb gray(unsigned percent) noexcept {
  const auto level = static_cast<std::uint8_t>((percent * 255 + 50) / 100);
  return {level, level, level};
}

inline constexpr std::array kNamedColors = std::to_array<NamedColor>({{"black", kBlack},
                                                                      {"white", kWhite},
                                                                      {"red", kRed},
                                                                      {"green", kGreen},
                                                                      {"blue", kBlue},
                                                                      {"magenta", {255, 0, 255}},
                                                                      {"cyan", {0, 255, 255}},
                                                                      {"yellow", {255, 255, 0}},
                                                                      {"orange", {255, 140, 0}},
                                                                      {"brown", {165, 42, 42}},
                                                                      {"purple", {160, 32, 240}},
                                                                      {"gray10", gray(10)},
                                                                      {"gray20", gray(20)},
                                                                      {"gray30", gray(30)},
                                                                      {"gray40", gray(40)},
                                                                      {"gray50", gray(50)},
                                                                      {"gray60", gray(60)},
                                                                      {"gray70", gray(70)},
                                                                      {"gray80", gray(80)},
                                                                      {"gray90", gray(90)}});

/// Nothing where there is no such name.
constexpr std::optional<Rgb> color_named(std::string_view name) noexcept {
  for (const NamedColor& known : kNamedColors) {
    if (known.name == name) return known.color;
  }
  return std::nullopt;
}

/// Nothing where it is neither.
inline std::optional<Rgb> parse_color(std::string_view text) noexcept {
  if (const auto named = color_named(text)) return named;
  std::array<std::uint8_t, 3> rgb{};
  const char* at = text.data();
  const char* const end = at + text.size();
  for (std::size_t i = 0; i < rgb.size(); ++i) {
    const auto [next, status] = std::from_chars(at, end, rgb[i]);
    if (status != std::errc{} || (i < 2 ? next == end || *next != ',' : next != end)) return std::nullopt;
    at = next + 1;
  }
  return Rgb{rgb[0], rgb[1], rgb[2]};
}

}  // namespace tandem::hal
