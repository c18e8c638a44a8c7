// Vectors in a plane.
#ifndef TANDEM_ARGOS3_VECTOR2_H
#define TANDEM_ARGOS3_VECTOR2_H
#include <array>
#include <cmath>
#include <iostream>

#include <argos3/core/utility/math/angles.h>
#include <argos3/core/utility/math/general.h>
#include <argos3/core/utility/math/matrix/matrix.h>
#include <argos3/core/utility/string_utilities.h>

namespace argos {

/// In text "x,y".
class CVector2 {
 public:
  static const CVector2 X;
  static const CVector2 Y;
  static const CVector2 ZERO;

  constexpr CVector2() : m_fX(0.0), m_fY(0.0) {}
  constexpr CVector2(Real x, Real y) : m_fX(x), m_fY(y) {}
  CVector2(const std::array<Real, 2>& xy) : m_fX(xy[0]), m_fY(xy[1]) {}
  CVector2(Real length, const CRadians& angle) { FromPolarCoordinates(length, angle); }

  constexpr Real GetX() const { return m_fX; }
  constexpr Real GetY() const { return m_fY; }
  void SetX(Real x) { m_fX = x; }
  void SetY(Real y) { m_fY = y; }
  void Set(Real x, Real y) {
    m_fX = x;
    m_fY = y;
  }
  void Set(const std::array<Real, 2>& xy) { Set(xy[0], xy[1]); }
  void FromPolarCoordinates(Real length, const CRadians& angle) {
    if (length == 0.0)  // as most readings of sensors are
      Set(0.0, 0.0);
    else
      Set(length * Cos(angle), length * Sin(angle));
  }

  Real SquareLength() const { return m_fX * m_fX + m_fY * m_fY; }
  Real Length() const { return std::sqrt(SquareLength()); }
  CRadians Angle() const { return ATan2(m_fY, m_fX); }
  CVector2& Normalize() { return *this /= Length(); }
  CVector2& Rotate(const CRadians& angle) {
    const Real c = Cos(angle), s = Sin(angle);
    Set(c * m_fX - s * m_fY, s * m_fX + c * m_fY);
    return *this;
  }
  Real DotProduct(const CVector2& v) const { return m_fX * v.m_fX + m_fY * v.m_fY; }
  Real CrossProduct(const CVector2& v) const { return m_fX * v.m_fY - m_fY * v.m_fX; }
  CVector2& Scale(Real x, Real y) {
    Set(x * m_fX, y * m_fY);
    return *this;
  }
  /// Turns it by a quarter, counter-clockwise.
  CVector2& Perpendicularize() {
    Set(-m_fY, m_fX);
    return *this;
  }
  CVector2& Absolute() {
    Set(std::fabs(m_fX), std::fabs(m_fY));
    return *this;
  }

  CVector2& operator+=(const CVector2& v) {
    Set(m_fX + v.m_fX, m_fY + v.m_fY);
    return *this;
  }
  CVector2& operator-=(const CVector2& v) {
    Set(m_fX - v.m_fX, m_fY - v.m_fY);
    return *this;
  }
  CVector2& operator*=(Real factor) {
    Set(m_fX * factor, m_fY * factor);
    return *this;
  }
  CVector2& operator/=(Real divisor) {
    Set(m_fX / divisor, m_fY / divisor);
    return *this;
  }
  CVector2 operator+(const CVector2& v) const { return CVector2(m_fX + v.m_fX, m_fY + v.m_fY); }
  CVector2 operator-(const CVector2& v) const { return CVector2(m_fX - v.m_fX, m_fY - v.m_fY); }
  CVector2 operator*(Real factor) const { return CVector2(m_fX * factor, m_fY * factor); }
  CVector2 operator/(Real divisor) const { return CVector2(m_fX / divisor, m_fY / divisor); }
  CVector2 operator-() const { return CVector2(-m_fX, -m_fY); }
  friend CVector2 operator*(Real factor, const CVector2& v) { return v * factor; }
  bool operator==(const CVector2& v) const { return m_fX == v.m_fX && m_fY == v.m_fY; }
  bool operator!=(const CVector2& v) const { return !(*this == v); }

  operator CMatrix<1, 2>() const {
    const Real all[] = {m_fX, m_fY};
    return CMatrix<1, 2>(all);
  }
  operator CMatrix<2, 1>() const {
    const Real all[] = {m_fX, m_fY};
    return CMatrix<2, 1>(all);
  }

  friend std::ostream& operator<<(std::ostream& out, const CVector2& v) { return out << v.m_fX << "," << v.m_fY; }
  friend std::istream& operator>>(std::istream& in, CVector2& v) {
    Real xy[2];
    ParseValues<Real>(in, 2, xy, ',');
    v.Set(xy[0], xy[1]);
    return in;
  }

 private:
  Real m_fX, m_fY;
};

inline Real SquareDistance(const CVector2& a, const CVector2& b) {
  return (a - b).SquareLength();
}
inline Real Distance(const CVector2& a, const CVector2& b) {
  return (a - b).Length();
}

}  // namespace argos

#endif
