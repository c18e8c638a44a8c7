// Elementary functions of ARGoS.
#ifndef TANDEM_ARGOS3_GENERAL_H
#define TANDEM_ARGOS3_GENERAL_H
#include <cmath>
#include <utility>
#include <vector>

#include <argos3/core/utility/datatypes/datatypes.h>

namespace argos {

template <typename T>
T Abs(const T& v) {
  return v < T(0) ? T(-v) : v > T(0) ? v : T(0);
}
inline SInt32 Abs(SInt32 v) {
  return v < 0 ? -v : v;
}
inline Real Abs(Real v) {
  return std::fabs(v);
}

inline Real Sqrt(Real v) {
  return std::sqrt(v);
}
inline Real Exp(Real v) {
  return std::exp(v);
}
inline Real Log(Real v) {
  return std::log(v);
}
/// With the sign of `v`, as std::fmod.
inline Real Mod(Real v, Real modulus) {
  return std::fmod(v, modulus);
}

template <typename T>
T Min(const T& a, const T& b) {
  return a < b ? a : b;
}
template <typename T>
T& Min(T& a, T& b) {
  return a < b ? a : b;
}
template <typename T>
T Max(const T& a, const T& b) {
  return a > b ? a : b;
}
template <typename T>
T& Max(T& a, T& b) {
  return a > b ? a : b;
}
/// -1, 0 or 1.
template <typename T>
SInt32 Sign(const T& v) {
  return v > T(0) ? 1 : v < T(0) ? -1 : 0;
}
template <typename T>
T Square(const T& v) {
  return v * v;
}

/// The part before the point; one less for every negative number, as in ARGoS (Floor(-2.0) is -3).
inline SInt32 Floor(Real v) {
  const SInt32 whole = static_cast<SInt32>(v);
  return v < 0.0 ? whole - 1 : whole;
}
inline SInt32 Ceil(Real v) {
  const SInt32 whole = static_cast<SInt32>(v);
  return static_cast<Real>(whole) < v ? whole + 1 : whole;
}
/// Halves go away from zero.
inline SInt32 Round(Real v) {
  return v > 0.0 ? Floor(v + 0.5) : Ceil(v - 0.5);
}
inline SInt32 RoundClosestToZero(Real v) {
  return v > 0.0 ? Floor(v) : Ceil(v);
}

/// Equal within `epsilon`, relative to the larger where that is above 1.
inline bool DoubleEqAbsolute(Real a, Real b, Real epsilon) {
  return std::fabs(a - b) <= epsilon * std::fmax(1.0, std::fmax(std::fabs(a), std::fabs(b)));
}
inline bool DoubleEq(Real a, Real b) {
  return DoubleEqAbsolute(a, b, 1e-4);
}

/// On the straight line through the two points around `x`, or the nearest two beyond the ends.
inline Real Interpolate(Real x, const std::vector<std::pair<Real, Real> >& points) {
  std::size_t right = 1;
  while (right + 1 < points.size() && points[right].first < x) ++right;
  const std::pair<Real, Real>& a = points.at(right - 1);
  const std::pair<Real, Real>& b = points.at(right);
  return a.second + (x - a.first) * (b.second - a.second) / (b.first - a.first);
}

}  // namespace argos

#endif
