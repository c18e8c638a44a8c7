#include "bridges/footbot/words.hpp"

#include <algorithm>
#include <cmath>

namespace tandem::bridges::footbot {
namespace {

/// In numbers from the variable's begin; bytes count halves of words.
std::ptrdiff_t place(const FieldMap& map, std::size_t i) noexcept {
  const auto step = static_cast<std::ptrdiff_t>(i) * map.word_step;
  if (map.form == WordForm::Bytes) return 2 * static_cast<std::ptrdiff_t>(map.word) + step;
  return static_cast<std::ptrdiff_t>(map.word) + step * static_cast<std::ptrdiff_t>(words_of(map.form));
}

std::uint32_t low_and_high(std::int16_t low, std::int16_t high) noexcept {
  return static_cast<std::uint16_t>(low) | static_cast<std::uint32_t>(static_cast<std::uint16_t>(high)) << 16U;
}

std::int16_t word(std::uint32_t bits) noexcept {
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(bits & 0xFFFFU));
}

double on_curve(const std::vector<Knot>& curve, double raw) noexcept {
  if (raw <= curve.front().raw) return curve.front().value;
  for (std::size_t i = 1; i < curve.size(); ++i) {
    const Knot& a = curve[i - 1];
    const Knot& b = curve[i];
    if (raw <= b.raw) return a.value + (raw - a.raw) / (b.raw - a.raw) * (b.value - a.value);
  }
  return curve.back().value;
}

}  // namespace

std::int32_t largest(WordForm form) noexcept {
  switch (form) {
    case WordForm::Int16:
      return 32767;
    case WordForm::Uint16:
      return 65535;
    case WordForm::Bytes:
      return 255;
    case WordForm::Int32LowFirst:
    case WordForm::Int32HighFirst:
      break;
  }
  return std::numeric_limits<std::int32_t>::max();
}

std::int32_t smallest(WordForm form) noexcept {
  if (form == WordForm::Int16) return -32768;
  return words_of(form) == 2 ? std::numeric_limits<std::int32_t>::min() : 0;
}

WordRange words_of(const FieldMap& map) noexcept {
  if (map.count == 0) return {};
  const std::ptrdiff_t a = place(map, 0);
  const std::ptrdiff_t b = place(map, map.count - 1);
  const std::ptrdiff_t first = std::min(a, b);
  const std::ptrdiff_t last = std::max(a, b);
  if (map.form != WordForm::Bytes) return {first, last + static_cast<std::ptrdiff_t>(words_of(map.form))};
  return {first < 0 ? -1 : first / 2, last / 2 + 1};
}

std::int32_t raw_number(const FieldMap& map, std::span<const std::int16_t> variable, std::size_t i) noexcept {
  const auto at = static_cast<std::size_t>(place(map, i));
  switch (map.form) {
    case WordForm::Int16:
      return variable[at];
    case WordForm::Uint16:
      return static_cast<std::uint16_t>(variable[at]);
    case WordForm::Int32LowFirst:
      return static_cast<std::int32_t>(low_and_high(variable[at], variable[at + 1]));
    case WordForm::Int32HighFirst:
      return static_cast<std::int32_t>(low_and_high(variable[at + 1], variable[at]));
    case WordForm::Bytes:
      return static_cast<std::uint16_t>(variable[at / 2]) >> (at % 2 * 8) & 0xFF;
  }
  return 0;
}

void set_raw_number(const FieldMap& map, std::span<std::int16_t> variable, std::size_t i, std::int32_t raw) noexcept {
  const auto at = static_cast<std::size_t>(place(map, i));
  const auto bits = static_cast<std::uint32_t>(raw);
  switch (map.form) {
    case WordForm::Int16:
    case WordForm::Uint16:
      variable[at] = word(bits);
      break;
    case WordForm::Int32LowFirst:
      variable[at] = word(bits);
      variable[at + 1] = word(bits >> 16U);
      break;
    case WordForm::Int32HighFirst:
      variable[at] = word(bits >> 16U);
      variable[at + 1] = word(bits);
      break;
    case WordForm::Bytes: {
      const std::uint32_t old = static_cast<std::uint16_t>(variable[at / 2]);
      const unsigned shift = at % 2 * 8;
      variable[at / 2] = word((old & ~(0xFFU << shift)) | (bits & 0xFFU) << shift);
      break;
    }
  }
}

double to_value(const FieldMap& map, std::int32_t raw) noexcept {
  const auto x = static_cast<double>(raw);
  for (const Knot& special : map.specials) {
    if (special.raw == x) return special.value;
  }
  const double value = map.curve.empty() ? map.offset + map.scale * x : on_curve(map.curve, x);
  return std::clamp(value, map.min, map.max);
}

std::int32_t to_raw(const FieldMap& map, double value) noexcept {
  const double raw = std::round((value - map.offset) / map.scale);
  if (!std::isfinite(raw)) return map.rest;
  const double low = std::max(map.least, smallest(map.form));
  const double high = std::min(map.most, largest(map.form));
  return static_cast<std::int32_t>(std::clamp(raw, low, high));
}

std::int64_t counter_difference(WordForm form, std::int32_t newer, std::int32_t older) noexcept {
  const std::uint32_t bits = static_cast<std::uint32_t>(newer) - static_cast<std::uint32_t>(older);
  if (words_of(form) == 2) return static_cast<std::int32_t>(bits);
  if (form == WordForm::Bytes) return static_cast<std::int8_t>(static_cast<std::uint8_t>(bits & 0xFFU));
  return word(bits);
}

}  // namespace tandem::bridges::footbot
