// Whether numbers are numbers: neither infinite nor NaN.
#pragma once
#include <cmath>
#include <initializer_list>

namespace tandem::hal {

template <class Values>
bool all_finite(const Values& values) noexcept {
  for (const auto value : values) {
    if (!std::isfinite(value)) return false;
  }
  return true;
}
inline bool all_finite(std::initializer_list<double> values) noexcept {
  return all_finite<std::initializer_list<double>>(values);
}

inline double finite_or(double value, double otherwise) noexcept {
  return std::isfinite(value) ? value : otherwise;
}

}  // namespace tandem::hal
