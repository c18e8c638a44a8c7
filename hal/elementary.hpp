// Elementary functions with the same bits on every machine.
//
// C libraries differ in the last bit of these functions: between architectures, and on one architecture between
// processors with and without fused multiply-add. A controller that is to decide alike everywhere takes them from here.
// They are made of +, -, *, / and square roots alone, which IEEE 754 rounds in one way.
#pragma once

namespace tandem::hal {

/// Within 1 unit in the last place for |x_rad| <= 1e6. Larger angles are first reduced by the double nearest to 2 pi,
/// so they are off by 4e-17 of themselves. NaN for infinities and NaN.
double sin(double x_rad) noexcept;
double cos(double x_rad) noexcept;
/// Within 3 units in the last place; otherwise as `sin`.
double tan(double x_rad) noexcept;

/// The bearing of (x, y), in [-pi, pi], within 1 unit in the last place. Signs of zeros and infinities count as in the
/// C library; NaN when either is.
double atan2(double y, double x) noexcept;

/// The length of (x, y), within 1 unit in the last place, without overflow on the way. NaN when either is, else
/// infinity when either is.
double hypot(double x, double y) noexcept;

/// Within 1 unit in the last place; 0 and infinity beyond what a double holds, NaN for NaN.
double exp(double x) noexcept;
/// The natural logarithm, within 2 units in the last place. -infinity for 0; NaN for NaN and for what is negative.
double log(double x) noexcept;

/// `base` to the power of `exponent`, for `base` >= 0: exp(exponent log(base)), so off by about 1e-16 times that
/// product. NaN for a negative base; 1 for the exponent 0.
double pow(double base, double exponent) noexcept;

}  // namespace tandem::hal
