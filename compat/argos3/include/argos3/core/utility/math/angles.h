// Angles with their unit in the type.
#ifndef TANDEM_ARGOS3_ANGLES_H
#define TANDEM_ARGOS3_ANGLES_H
#include <cmath>
#include <iostream>

#include <argos3/core/utility/datatypes/datatypes.h>
#include <argos3/core/utility/math/general.h>
#include <argos3/core/utility/math/range.h>

#define ARGOS_PI 3.14159265358979323846264338327950288

namespace argos {

class CRadians;
class CDegrees;

namespace tandem_detail {

/// Arithmetic of an angle that is held as `Angle::m_fValue`.
template <typename Angle>
class TAngle {
 public:
  constexpr TAngle() : m_fValue(0.0) {}
  constexpr explicit TAngle(Real value) : m_fValue(value) {}

  constexpr Real GetValue() const { return m_fValue; }
  Real GetAbsoluteValue() const { return std::fabs(m_fValue); }
  void SetValue(Real value) { m_fValue = value; }

  /// Into [-turn/2, turn/2].
  Angle& SignedNormalize() {
    CRange<Real>(-0.5 * Angle::kTurn, 0.5 * Angle::kTurn).WrapValue(m_fValue);
    return Self();
  }
  /// Into [0, turn].
  Angle& UnsignedNormalize() {
    CRange<Real>(0.0, Angle::kTurn).WrapValue(m_fValue);
    return Self();
  }
  Angle& Negate() {
    m_fValue = -m_fValue;
    return Self();
  }

  Angle operator+() const { return Angle(m_fValue); }
  Angle operator-() const { return Angle(-m_fValue); }
  Angle& operator+=(const Angle& other) {
    m_fValue += other.GetValue();
    return Self();
  }
  Angle& operator-=(const Angle& other) {
    m_fValue -= other.GetValue();
    return Self();
  }
  Angle& operator*=(Real factor) {
    m_fValue *= factor;
    return Self();
  }
  Angle& operator/=(Real divisor) {
    m_fValue /= divisor;
    return Self();
  }
  friend Angle operator+(const Angle& a, const Angle& b) { return Angle(a.GetValue() + b.GetValue()); }
  friend Angle operator-(const Angle& a, const Angle& b) { return Angle(a.GetValue() - b.GetValue()); }
  friend Angle operator*(const Angle& a, Real factor) { return Angle(a.GetValue() * factor); }
  friend Angle operator*(Real factor, const Angle& a) { return Angle(a.GetValue() * factor); }
  friend Angle operator/(const Angle& a, Real divisor) { return Angle(a.GetValue() / divisor); }
  friend Real operator/(const Angle& a, const Angle& b) { return a.GetValue() / b.GetValue(); }
  friend bool operator<(const Angle& a, const Angle& b) { return a.GetValue() < b.GetValue(); }
  friend bool operator<=(const Angle& a, const Angle& b) { return a.GetValue() <= b.GetValue(); }
  friend bool operator>(const Angle& a, const Angle& b) { return a.GetValue() > b.GetValue(); }
  friend bool operator>=(const Angle& a, const Angle& b) { return a.GetValue() >= b.GetValue(); }
  friend bool operator==(const Angle& a, const Angle& b) { return a.GetValue() == b.GetValue(); }
  friend bool operator!=(const Angle& a, const Angle& b) { return a.GetValue() != b.GetValue(); }
  /// The bare number.
  friend std::istream& operator>>(std::istream& in, Angle& a) {
    Real value = 0.0;
    if (in >> value) a.SetValue(value);
    return in;
  }

 protected:
  Angle& Self() { return static_cast<Angle&>(*this); }
  Real m_fValue;
};

}  // namespace tandem_detail

class CRadians : public tandem_detail::TAngle<CRadians> {
 public:
  static constexpr Real kTurn = 2.0 * ARGOS_PI;
  static const CRadians PI;
  static const CRadians TWO_PI;
  static const CRadians PI_OVER_TWO;
  static const CRadians PI_OVER_THREE;
  static const CRadians PI_OVER_FOUR;
  static const CRadians PI_OVER_SIX;
  static const CRadians ZERO;
  static const CRange<CRadians> SIGNED_RANGE;    ///< -PI to PI
  static const CRange<CRadians> UNSIGNED_RANGE;  ///< 0 to TWO_PI
  static const Real RADIANS_TO_DEGREES;

  constexpr CRadians() {}
  constexpr explicit CRadians(Real radians) : TAngle(radians) {}
  void FromValueInDegrees(Real degrees) { m_fValue = degrees * (ARGOS_PI / 180.0); }
};

class CDegrees : public tandem_detail::TAngle<CDegrees> {
 public:
  static constexpr Real kTurn = 360.0;

  constexpr CDegrees() {}
  constexpr explicit CDegrees(Real degrees) : TAngle(degrees) {}
  void FromValueInRadians(Real radians) { m_fValue = radians * (180.0 / ARGOS_PI); }
};

inline CDegrees ToDegrees(const CRadians& a) {
  return CDegrees(a.GetValue() * (180.0 / ARGOS_PI));
}
inline CRadians ToRadians(const CDegrees& a) {
  return CRadians(a.GetValue() * (ARGOS_PI / 180.0));
}

/// "CRadians(1.5708 -> 90 degrees)"
inline std::ostream& operator<<(std::ostream& out, const CRadians& a) {
  return out << "CRadians(" << a.GetValue() << " -> " << ToDegrees(a).GetValue() << " degrees)";
}
inline std::ostream& operator<<(std::ostream& out, const CDegrees& a) {
  return out << "CDegrees(" << a.GetValue() << ")";
}

namespace tandem_detail {
/// The difference within [-turn/2, turn/2).
template <typename Angle>
Angle Difference(const Angle& a, const Angle& b) {
  Real rest = std::fmod(a.GetValue() - b.GetValue() + 0.5 * Angle::kTurn, Angle::kTurn);
  if (rest < 0.0) rest += Angle::kTurn;
  return Angle(rest - 0.5 * Angle::kTurn);
}
}  // namespace tandem_detail

inline CRadians NormalizedDifference(const CRadians& a, const CRadians& b) {
  return tandem_detail::Difference(a, b);
}
inline CDegrees NormalizedDifference(const CDegrees& a, const CDegrees& b) {
  return tandem_detail::Difference(a, b);
}

inline Real Sin(const CRadians& a) {
  return std::sin(a.GetValue());
}
inline Real Cos(const CRadians& a) {
  return std::cos(a.GetValue());
}
inline Real Tan(const CRadians& a) {
  return std::tan(a.GetValue());
}
inline void SinCos(const CRadians& a, Real& sine, Real& cosine) {
  sine = std::sin(a.GetValue());
  cosine = std::cos(a.GetValue());
}
// Rounding may lead out of [-1, 1]: the nearest that is inside counts.
inline CRadians ASin(Real v) {
  CRange<Real>(-1.0, 1.0).TruncValue(v);
  return CRadians(std::asin(v));
}
inline CRadians ACos(Real v) {
  CRange<Real>(-1.0, 1.0).TruncValue(v);
  return CRadians(std::acos(v));
}
inline CRadians ATan2(const Real y, const Real x) {
  return CRadians(std::atan2(y, x));
}

}  // namespace argos

#endif
