// Units of numbers that people write: "4 cm", "30 deg", "0.5 m/s". Inside the program everything is SI and radians.
#pragma once
#include <span>
#include <string>
#include <string_view>

#include "hal/result.hpp"

namespace tandem::hal {

enum class Dim { None, Length, Speed, Angle, AngularSpeed, Time, Frequency, Mass, Voltage, Acceleration };

/// A unit of one dimension: value in SI = number * to_si.
struct Unit {
  Dim dim = Dim::None;
  std::string_view symbol;
  double to_si = 1.0;
};

namespace unit {
inline constexpr Unit none{Dim::None, "", 1.0};
inline constexpr Unit percent{Dim::None, "%", 0.01};
inline constexpr Unit m{Dim::Length, "m", 1.0};
inline constexpr Unit cm{Dim::Length, "cm", 0.01};
inline constexpr Unit mm{Dim::Length, "mm", 0.001};
inline constexpr Unit m_s{Dim::Speed, "m/s", 1.0};
inline constexpr Unit cm_s{Dim::Speed, "cm/s", 0.01};
inline constexpr Unit mm_s{Dim::Speed, "mm/s", 0.001};
inline constexpr Unit rad{Dim::Angle, "rad", 1.0};
inline constexpr Unit deg{Dim::Angle, "deg", 3.14159265358979323846 / 180.0};
inline constexpr Unit rad_s{Dim::AngularSpeed, "rad/s", 1.0};
inline constexpr Unit deg_s{Dim::AngularSpeed, "deg/s", 3.14159265358979323846 / 180.0};
inline constexpr Unit s{Dim::Time, "s", 1.0};
inline constexpr Unit ms{Dim::Time, "ms", 1e-3};
inline constexpr Unit us{Dim::Time, "us", 1e-6};
inline constexpr Unit min{Dim::Time, "min", 60.0};
inline constexpr Unit hz{Dim::Frequency, "Hz", 1.0};
inline constexpr Unit kg{Dim::Mass, "kg", 1.0};
inline constexpr Unit g{Dim::Mass, "g", 1e-3};
inline constexpr Unit V{Dim::Voltage, "V", 1.0};
inline constexpr Unit m_s2{Dim::Acceleration, "m/s2", 1.0};
}  // namespace unit

/// `text` without the spaces, tabs and line ends around it.
std::string_view trimmed(std::string_view text) noexcept;

/// All units that a suffix may name.
std::span<const Unit> all_units() noexcept;

/// Reads "<number>[<space>][<suffix>]". A bare number is in `bare`; a suffix must be of the same dimension.
/// @returns the value in SI; an error names what was written and which suffixes would do. NaN and infinity are refused.
Result<double> parse_quantity(std::string_view text, const Unit& bare);

/// The shortest decimal text that reads back as the same double.
std::string format_number(double value);

/// `value_si` written in `unit` for people, e.g. "5 cm/s": rounded to 12 digits.
std::string format_quantity(double value_si, const Unit& unit);

/// The same for files: `parse_quantity` with this unit gives the same bits back. In `unit` where a short number does
/// that, else in the SI unit of its dimension.
std::string format_exactly(double value_si, const Unit& unit);

}  // namespace tandem::hal
