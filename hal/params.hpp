// Parameters: described once, read, checked, printed and documented by visitors of that one description.
#pragma once
#include <array>
#include <concepts>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>

#include "hal/unit.hpp"

namespace tandem::hal {

/// Closed interval in SI (for numbers) or of the integer itself.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
};

inline constexpr Range kAny{};
inline constexpr Range kNotNegative{0.0, std::numeric_limits<double>::infinity()};

/// One visitor, many uses: the reader of experiment files fills the values in, the manual prints them, the report saves
/// them. A value that is absent keeps what it has: the in-class initialiser is the default.
class ParamVisitor {
 public:
  virtual ~ParamVisitor() = default;

  /// A real number. `value_si` in SI; `bare` is the unit of a number written without suffix.
  virtual void number(std::string_view name, double& value_si, const Unit& bare, Range range_si,
                      std::string_view doc) = 0;
  virtual void integer(std::string_view name, std::int64_t& value, Range range, std::string_view doc) = 0;
  virtual void flag(std::string_view name, bool& value, std::string_view doc) = 0;
  virtual void text(std::string_view name, std::string& value, std::string_view doc) = 0;
  /// `value` is one of `options`.
  virtual void choice(std::string_view name, std::string& value, std::span<const std::string_view> options,
                      std::string_view doc) = 0;
  /// "x,y,z", each in `bare`.
  virtual void vector(std::string_view name, std::array<double, 3>& value_si, const Unit& bare,
                      std::string_view doc) = 0;
};

/// A struct whose `describe(ParamVisitor&)` spells its parameters.
template <class T>
concept Described = requires(T t, ParamVisitor& v) {
  t.describe(v);
};

}  // namespace tandem::hal
