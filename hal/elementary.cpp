#include "hal/elementary.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>

namespace tandem::hal {
namespace {

/// The unevaluated sum of two doubles, the second far smaller.
struct Double2 {
  double high;
  double low;
};

/// The exact sum of two doubles [Knuth, The Art of Computer Programming 2, 4.2.2].
Double2 exact_sum(double a, double b) noexcept {
  const double sum = a + b;
  const double part_of_b = sum - a;
  return {sum, (a - (sum - part_of_b)) + (b - part_of_b)};
}

// pi, and pi / 2 in three parts: a quarter turn's multiple of up to 20 bits times one of the first two is exact.
constexpr Double2 kPi{0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};
constexpr Double2 kHalfPi{0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
constexpr double kHalfPi33Bits = 0x1.921fb544p+0;
constexpr double kHalfPiNext33Bits = 0x1.0b4611a6p-34;
constexpr double kHalfPiRest = 0x1.3198a2e037073p-69;
constexpr double kFarthest_rad = 1.6e6;  // about 2^20 quarter turns

/// An angle as quarter turns and what is left, within [-pi/4, pi/4].
struct Reduced {
  std::uint32_t quarters = 0;  // modulo 4
  Double2 rest_rad{};
};

/// Cody and Waite's reduction [Muller, Elementary Functions, 11.2]. `x_rad` is finite.
Reduced reduced(double x_rad) noexcept {
  if (std::fabs(x_rad) > kFarthest_rad) x_rad = std::remainder(x_rad, 2.0 * kHalfPi.high * 2.0);
  const auto quarters =
      static_cast<std::int32_t>(x_rad * (1.0 / kHalfPi.high) + (x_rad < 0.0 ? -0.5 : 0.5));  // towards zero
  const auto n = static_cast<double>(quarters);
  const Double2 rest = exact_sum(x_rad - n * kHalfPi33Bits, -(n * kHalfPiNext33Bits));
  const Double2 all = exact_sum(rest.high, rest.low - n * kHalfPiRest);
  return {static_cast<std::uint32_t>(quarters), all};
}

/// c[0] + c[1] z + c[2] z^2 + …
template <std::size_t N>
double polynomial(const std::array<double, N>& c, double z) noexcept {
  double sum = c[N - 1];
  for (std::size_t i = N - 1; i-- > 0;) sum = sum * z + c[i];
  return sum;
}

/// Taylor's series from the cube on; the first term left out is below 1e-19.
double sine_near_zero(Double2 x) noexcept {
  static constexpr std::array kSeries = {
      -1.0 / 6.0,        1.0 / 120.0,        -1.0 / 5040.0,          1.0 / 362880.0,
      -1.0 / 39916800.0, 1.0 / 6227020800.0, -1.0 / 1307674368000.0, 1.0 / 355687428096000.0};
  const double z = x.high * x.high;
  return x.high + (x.high * z * polynomial(kSeries, z) + x.low * (1.0 - 0.5 * z));
}

double cosine_near_zero(Double2 x) noexcept {
  static constexpr std::array kSeries = {
      1.0 / 24.0,        -1.0 / 720.0,         1.0 / 40320.0,          -1.0 / 3628800.0,
      1.0 / 479001600.0, -1.0 / 87178291200.0, 1.0 / 20922789888000.0, -1.0 / 6402373705728000.0};
  const double z = x.high * x.high;
  const double half = 0.5 * z;
  const double one_less_half = 1.0 - half;
  const double lost = (1.0 - one_less_half) - half;  // what that subtraction rounded away
  return one_less_half + (lost + (z * z * polynomial(kSeries, z) - x.high * x.low));
}

/// The sine of an angle that is `quarters` quarter turns further.
double sine_of(const Reduced& angle, std::uint32_t quarters) noexcept {
  const std::uint32_t quarter = (angle.quarters + quarters) % 4U;
  const double value = quarter % 2U == 0 ? sine_near_zero(angle.rest_rad) : cosine_near_zero(angle.rest_rad);
  return quarter < 2U ? value : -value;
}

/// The arc tangents of 0, 1/8 … 1.
constexpr std::array<Double2, 9> kArcTangents = {{{0.0, 0.0},
                                                  {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
                                                  {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
                                                  {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
                                                  {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
                                                  {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
                                                  {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
                                                  {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
                                                  {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55}}};

/// The arc tangent of a / b, for 0 <= a <= b and b > 0: from the nearest entry of the table,
/// atan(a / b) = atan(c) + atan((a - c b) / (b + c a)), and Taylor's series.
Double2 arc_tangent(double a, double b) noexcept {
  static constexpr std::array kSeries = {-1.0 / 3.0,  1.0 / 5.0,  -1.0 / 7.0, 1.0 / 9.0,
                                         -1.0 / 11.0, 1.0 / 13.0, -1.0 / 15.0};
  const auto entry = static_cast<std::size_t>(8.0 * (a / b) + 0.5);
  const double c = 0.125 * static_cast<double>(entry);
  const double r = (a - c * b) / (b + c * a);
  const double z = r * r;
  return {kArcTangents[entry].high, (r * z * polynomial(kSeries, z) + kArcTangents[entry].low) + r};
}

Double2 difference(Double2 a, Double2 b) noexcept {
  const Double2 sum = exact_sum(a.high, -b.high);
  return {sum.high, sum.low + (a.low - b.low)};
}

constexpr double kHuge = 0x1p+500;  // its square, and four times it, are still finite
constexpr double kTiny = 0x1p-400;  // its square has all its bits

/// A power of two that brings the larger of two magnitudes to where squares and quotients are harmless; 1 mostly.
double scale_of(double largest) noexcept {
  if (largest > kHuge) return 0x1p-600;
  return largest < kTiny ? 0x1p+700 : 1.0;
}

// ln 2 in two parts: the first times a number of 20 bits is exact.
constexpr double kLn2High = 0x1.62e42fefp-1;
constexpr double kLn2Low = 0x1.473de6af278edp-34;
constexpr double kMostExponent = 709.8;    // e to this is infinite
constexpr double kLeastExponent = -745.2;  // e to this is 0

}  // namespace

double sin(double x_rad) noexcept {
  if (!std::isfinite(x_rad)) return std::numeric_limits<double>::quiet_NaN();
  if (std::fabs(x_rad) < 0x1p-27) return x_rad;  // also -0 as it is
  return sine_of(reduced(x_rad), 0);
}

double cos(double x_rad) noexcept {
  if (!std::isfinite(x_rad)) return std::numeric_limits<double>::quiet_NaN();
  return sine_of(reduced(x_rad), 1);
}

double tan(double x_rad) noexcept {
  if (!std::isfinite(x_rad)) return std::numeric_limits<double>::quiet_NaN();
  if (std::fabs(x_rad) < 0x1p-27) return x_rad;
  const Reduced angle = reduced(x_rad);
  return sine_of(angle, 0) / sine_of(angle, 1);
}

double atan2(double y, double x) noexcept {
  if (std::isnan(x) || std::isnan(y)) return std::numeric_limits<double>::quiet_NaN();
  double a = std::fabs(y);
  double b = std::fabs(x);
  if (std::isinf(a) || std::isinf(b)) {  // only which of them is infinite counts
    a = std::isinf(a) ? 1.0 : 0.0;
    b = std::isinf(b) ? 1.0 : 0.0;
  }
  const bool steep = a > b;
  if (steep) std::swap(a, b);
  Double2 angle{0.0, 0.0};
  if (b > 0.0) {
    const double scale = scale_of(b);
    angle = arc_tangent(a * scale, b * scale);
  }
  if (steep) angle = difference(kHalfPi, angle);
  if (std::signbit(x)) angle = difference(kPi, angle);
  return std::copysign(angle.high + angle.low, y);
}

double hypot(double x, double y) noexcept {
  if (std::isnan(x) || std::isnan(y)) return std::numeric_limits<double>::quiet_NaN();
  const double largest = std::max(std::fabs(x), std::fabs(y));
  if (largest == 0.0 || std::isinf(largest)) return largest;
  const double scale = scale_of(largest);
  x *= scale;
  y *= scale;
  return std::sqrt(x * x + y * y) / scale;
}

double exp(double x) noexcept {
  if (std::isnan(x)) return x;
  if (x > kMostExponent) return std::numeric_limits<double>::infinity();
  if (x < kLeastExponent) return 0.0;
  // x = n ln 2 + r, and Taylor's series in r; the first term left out is below 1e-18.
  const auto n = static_cast<int>(x * 0x1.71547652b82fep+0 + (x < 0.0 ? -0.5 : 0.5));
  const double high = x - n * kLn2High;
  const double low = n * kLn2Low;
  const double r = high - low;
  double sum = 1.0 / 14.0;
  for (double k = 13.0; k > 2.0; k -= 1.0) sum = (1.0 + r * sum) / k;
  // sum is now 1/3 + r/12 + …: e^r = 1 + r + r^2 (1 + r sum) / 2.
  const double more = 0.5 * r * r * (1.0 + r * sum) + (((high - r) - low) + r);
  return std::ldexp(1.0 + more, n);
}

double log(double x) noexcept {
  if (std::isnan(x) || x < 0.0) return std::numeric_limits<double>::quiet_NaN();
  if (x == 0.0) return -std::numeric_limits<double>::infinity();
  if (std::isinf(x)) return x;
  int n = 0;
  double m = std::frexp(x, &n);  // in [1/2, 1)
  if (m < std::numbers::sqrt2 / 2.0) {
    m *= 2.0;
    --n;
  }
  // log m = 2 artanh s = 2 s (1 + z/3 + z^2/5 …) with s = (m - 1) / (m + 1), |s| < 0.172, and z = s^2.
  static constexpr std::array kSeries = {1.0 / 3.0,  1.0 / 5.0,  1.0 / 7.0,  1.0 / 9.0,  1.0 / 11.0, 1.0 / 13.0,
                                         1.0 / 15.0, 1.0 / 17.0, 1.0 / 19.0, 1.0 / 21.0, 1.0 / 23.0};
  const double f = m - 1.0;
  const double s = f / (2.0 + f);
  const double z = s * s;
  const double tail = 2.0 * s * z * polynomial(kSeries, z);
  // 2 s = f - s f, and f is exact.
  return n * kLn2High + (f - (s * f - (tail + n * kLn2Low)));
}

double pow(double base, double exponent) noexcept {
  if (exponent == 0.0) return 1.0;
  return exp(exponent * log(base));
}

}  // namespace tandem::hal
