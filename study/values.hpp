// Values of varied parameters: lists, ranges, Latin hypercubes.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "hal/result.hpp"

namespace tandem::study {

struct Quantity {
  double number = 0.0;
  std::string unit;  ///< with a space before it
};
/// "5 cm/s" as a number and what stands behind it. Error: it does not begin with a finite number.
hal::Result<Quantity> quantity_of(const std::string& text);

/// "1 m, 2 m": the values between commas, or between semicolons where there is one. Errors: an empty one; the same one
/// twice.
hal::Result<std::vector<std::string>> list_of(const std::string& text);

/// A range of numbers that share what stands behind them: "10 cm" to "50 cm".
struct Span {
  double from = 0.0, to = 0.0;
  std::string unit;  ///< "", " cm"
  bool log = false;
  bool whole = false;

  /// The value at `part` of the way, 0 to 1.
  std::string at(double part) const;
};

/// Errors: no numbers, different units, a logarithmic range that is not above 0.
hal::Result<Span> span_of(const std::string& from, const std::string& to, bool log, bool whole);

/// From one end to the other; `count` at least 1: 1 is the first end alone. Values that rounding makes equal stand
/// once.
std::vector<std::string> spread(const Span& span, std::int64_t count);

/// From the first end in steps, the last value at most the other end. Errors: a step of another unit, of the wrong
/// sign, on a logarithmic range; more than ten million values.
hal::Result<std::vector<std::string>> steps(const Span& span, const std::string& step);

/// `points` values of each span: of each of `points` equal parts of a span one value, at a random place in it; parts of
/// different spans are combined at random. A function of its arguments alone.
std::vector<std::vector<std::string>> latin_hypercube(const std::vector<Span>& spans, std::int64_t points,
                                                      std::uint64_t seed);

}  // namespace tandem::study
