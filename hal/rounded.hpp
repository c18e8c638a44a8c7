// Numbers in messages, with as many digits as people can use.
#pragma once
#include <cmath>
#include <string>

#include "hal/unit.hpp"

namespace tandem::hal {

/// At most so many decimals.
inline std::string rounded(double value, int decimals = 3) {
  const double scale = std::pow(10.0, decimals);
  const double shown = std::round(value * scale) / scale;
  return format_number(std::isfinite(shown) ? shown + 0.0 : value);  // + 0.0: no -0
}

/// A place to the millimetre: "(1.25, -0.318)".
inline std::string place_text(double x_m, double y_m) {
  return "(" + rounded(x_m) + ", " + rounded(y_m) + ")";
}

}  // namespace tandem::hal
