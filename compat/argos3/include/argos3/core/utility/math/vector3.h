// Vectors in space.
#ifndef TANDEM_ARGOS3_VECTOR3_H
#define TANDEM_ARGOS3_VECTOR3_H
#include <array>
#include <cmath>
#include <iostream>

#include <argos3/core/utility/math/angles.h>
#include <argos3/core/utility/math/general.h>
#include <argos3/core/utility/math/matrix/matrix.h>
#include <argos3/core/utility/math/vector2.h>
#include <argos3/core/utility/string_utilities.h>

namespace argos {

class CQuaternion;

/// In text "x,y,z".
class CVector3 {
 public:
  static const CVector3 X;
  static const CVector3 Y;
  static const CVector3 Z;
  static const CVector3 ZERO;

  constexpr CVector3() : m_fX(0.0), m_fY(0.0), m_fZ(0.0) {}
  constexpr CVector3(Real x, Real y, Real z) : m_fX(x), m_fY(y), m_fZ(z) {}
  CVector3(const std::array<Real, 3>& xyz) : m_fX(xyz[0]), m_fY(xyz[1]), m_fZ(xyz[2]) {}
  CVector3(Real length, const CRadians& inclination, const CRadians& azimuth) {
    FromSphericalCoords(length, inclination, azimuth);
  }

  constexpr Real GetX() const { return m_fX; }
  constexpr Real GetY() const { return m_fY; }
  constexpr Real GetZ() const { return m_fZ; }
  void SetX(Real x) { m_fX = x; }
  void SetY(Real y) { m_fY = y; }
  void SetZ(Real z) { m_fZ = z; }
  void Set(Real x, Real y, Real z) {
    m_fX = x;
    m_fY = y;
    m_fZ = z;
  }
  void Set(const std::array<Real, 3>& xyz) { Set(xyz[0], xyz[1], xyz[2]); }

  /// The inclination is from Z, the azimuth from X about Z.
  CVector3& FromSphericalCoords(Real length, const CRadians& inclination, const CRadians& azimuth) {
    const Real flat = length * Sin(inclination);
    Set(flat * Cos(azimuth), flat * Sin(azimuth), length * Cos(inclination));
    return *this;
  }
  void ToSphericalCoords(Real& length, CRadians& inclination, CRadians& azimuth) const {
    length = Length();
    inclination = ACos(m_fZ / length);
    azimuth = ATan2(m_fY, m_fX);
  }

  Real SquareLength() const { return m_fX * m_fX + m_fY * m_fY + m_fZ * m_fZ; }
  Real Length() const { return std::sqrt(SquareLength()); }
  CVector3& Normalize() { return *this /= Length(); }
  CVector3& RotateX(const CRadians& angle) {
    const Real c = Cos(angle), s = Sin(angle);
    Set(m_fX, c * m_fY - s * m_fZ, s * m_fY + c * m_fZ);
    return *this;
  }
  CVector3& RotateY(const CRadians& angle) {
    const Real c = Cos(angle), s = Sin(angle);
    Set(c * m_fX + s * m_fZ, m_fY, c * m_fZ - s * m_fX);
    return *this;
  }
  CVector3& RotateZ(const CRadians& angle) { return RotateZ(CVector2(Cos(angle), Sin(angle))); }
  /// By the angle of a vector of length 1.
  CVector3& RotateZ(const CVector2& direction) {
    Set(m_fX * direction.GetX() - m_fY * direction.GetY(), m_fX * direction.GetY() + m_fY * direction.GetX(), m_fZ);
    return *this;
  }
  CVector3& Rotate(const CQuaternion& rotation);
  CRadians GetAngleWith(const CVector3& v) const { return ACos(DotProduct(v) / (Length() * v.Length())); }
  CRadians GetXAngle() const { return ATan2(m_fZ, m_fY); }
  CRadians GetYAngle() const { return ATan2(m_fX, m_fZ); }
  CRadians GetZAngle() const { return ATan2(m_fY, m_fX); }

  Real DotProduct(const CVector3& v) const { return m_fX * v.m_fX + m_fY * v.m_fY + m_fZ * v.m_fZ; }
  /// Replaces it by its product with `v`.
  CVector3& CrossProduct(const CVector3& v) {
    Set(m_fY * v.m_fZ - m_fZ * v.m_fY, m_fZ * v.m_fX - m_fX * v.m_fZ, m_fX * v.m_fY - m_fY * v.m_fX);
    return *this;
  }
  CVector2& ProjectOntoXY(CVector2& flat) const {
    flat.Set(m_fX, m_fY);
    return flat;
  }
  CVector2& ProjectOntoYZ(CVector2& flat) const {
    flat.Set(m_fY, m_fZ);
    return flat;
  }
  CVector2& ProjectOntoXZ(CVector2& flat) const {
    flat.Set(m_fX, m_fZ);
    return flat;
  }
  CVector3& Negate() {
    Set(-m_fX, -m_fY, -m_fZ);
    return *this;
  }

  Real operator[](UInt32 i) const { return const_cast<CVector3&>(*this)[i]; }
  Real& operator[](UInt32 i) {
    if (i > 2) THROW_ARGOSEXCEPTION("a CVector3 has the indices 0 to 2, not " << i)
    return i == 0 ? m_fX : i == 1 ? m_fY : m_fZ;
  }

  CVector3& operator+=(const CVector3& v) {
    Set(m_fX + v.m_fX, m_fY + v.m_fY, m_fZ + v.m_fZ);
    return *this;
  }
  CVector3& operator-=(const CVector3& v) {
    Set(m_fX - v.m_fX, m_fY - v.m_fY, m_fZ - v.m_fZ);
    return *this;
  }
  CVector3& operator*=(Real factor) {
    Set(m_fX * factor, m_fY * factor, m_fZ * factor);
    return *this;
  }
  CVector3& operator/=(Real divisor) {
    Set(m_fX / divisor, m_fY / divisor, m_fZ / divisor);
    return *this;
  }
  CVector3 operator+(const CVector3& v) const { return CVector3(*this) += v; }
  CVector3 operator-(const CVector3& v) const { return CVector3(*this) -= v; }
  CVector3 operator*(Real factor) const { return CVector3(*this) *= factor; }
  CVector3 operator/(Real divisor) const { return CVector3(*this) /= divisor; }
  CVector3 operator-() const { return CVector3(-m_fX, -m_fY, -m_fZ); }
  friend CVector3 operator*(Real factor, const CVector3& v) { return v * factor; }

  bool operator==(const CVector3& v) const { return m_fX == v.m_fX && m_fY == v.m_fY && m_fZ == v.m_fZ; }
  bool operator!=(const CVector3& v) const { return !(*this == v); }
  // True of all three coordinates: for corners of boxes.
  bool operator<(const CVector3& v) const { return m_fX < v.m_fX && m_fY < v.m_fY && m_fZ < v.m_fZ; }
  bool operator<=(const CVector3& v) const { return m_fX <= v.m_fX && m_fY <= v.m_fY && m_fZ <= v.m_fZ; }
  bool operator>(const CVector3& v) const { return v < *this; }
  bool operator>=(const CVector3& v) const { return v <= *this; }

  operator CMatrix<1, 3>() const {
    const Real all[] = {m_fX, m_fY, m_fZ};
    return CMatrix<1, 3>(all);
  }
  operator CMatrix<3, 1>() const {
    const Real all[] = {m_fX, m_fY, m_fZ};
    return CMatrix<3, 1>(all);
  }

  friend std::ostream& operator<<(std::ostream& out, const CVector3& v) {
    return out << v.m_fX << "," << v.m_fY << "," << v.m_fZ;
  }
  friend std::istream& operator>>(std::istream& in, CVector3& v) {
    Real xyz[3];
    ParseValues<Real>(in, 3, xyz, ',');
    v.Set(xyz[0], xyz[1], xyz[2]);
    return in;
  }

 private:
  Real m_fX, m_fY, m_fZ;
};

inline Real SquareDistance(const CVector3& a, const CVector3& b) {
  return (a - b).SquareLength();
}
inline Real Distance(const CVector3& a, const CVector3& b) {
  return (a - b).Length();
}

}  // namespace argos

#endif
