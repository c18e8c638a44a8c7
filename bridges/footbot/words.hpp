// Conversions between a variable's words and SI values, as a map says. Pure.
#pragma once
#include <span>

#include "bridges/footbot/map.hpp"

namespace tandem::bridges::footbot {

/// Number of words that a number takes; 1 also for bytes, of which a word holds two.
constexpr std::size_t words_of(WordForm form) noexcept {
  return form == WordForm::Int32LowFirst || form == WordForm::Int32HighFirst ? 2 : 1;
}
/// The largest and smallest number of a form.
std::int32_t largest(WordForm form) noexcept;
std::int32_t smallest(WordForm form) noexcept;

/// Words of a variable that a row of numbers lies in: [first, behind). `first` is negative when it begins before the
/// variable does.
struct WordRange {
  std::ptrdiff_t first = 0;
  std::ptrdiff_t behind = 0;
};
WordRange words_of(const FieldMap& map) noexcept;

/// Number `i` of the row. The variable has the words that `words_of` says.
std::int32_t raw_number(const FieldMap& map, std::span<const std::int16_t> variable, std::size_t i) noexcept;
void set_raw_number(const FieldMap& map, std::span<std::int16_t> variable, std::size_t i, std::int32_t raw) noexcept;

/// SI value of a raw number.
double to_value(const FieldMap& map, std::int32_t raw) noexcept;
/// The raw number nearest to a value, within `least` and `most` and what the form holds. Not finite: `rest`.
std::int32_t to_raw(const FieldMap& map, double value) noexcept;

/// From one reading of a counter to the next, the short way round.
std::int64_t counter_difference(WordForm form, std::int32_t newer, std::int32_t older) noexcept;

}  // namespace tandem::bridges::footbot
