// Rotations in space.
#ifndef TANDEM_ARGOS3_QUATERNION_H
#define TANDEM_ARGOS3_QUATERNION_H
#include <cmath>
#include <iostream>

#include <argos3/core/utility/math/matrix/rotationmatrix3.h>
#include <argos3/core/utility/math/vector3.h>

namespace argos {

/// w, x, y, z. In text Euler angles in degrees, "z,y,x".
class CQuaternion {
 public:
  constexpr CQuaternion() : m_fW(1.0), m_fX(0.0), m_fY(0.0), m_fZ(0.0) {}
  constexpr CQuaternion(Real w, Real x, Real y, Real z) : m_fW(w), m_fX(x), m_fY(y), m_fZ(z) {}
  CQuaternion(const CRadians& angle, const CVector3& axis) { FromAngleAxis(angle, axis); }
  CQuaternion(const CVector3& from, const CVector3& to) { BetweenTwoVectors(from, to); }

  constexpr Real GetW() const { return m_fW; }
  constexpr Real GetX() const { return m_fX; }
  constexpr Real GetY() const { return m_fY; }
  constexpr Real GetZ() const { return m_fZ; }
  void SetW(Real w) { m_fW = w; }
  void SetX(Real x) { m_fX = x; }
  void SetY(Real y) { m_fY = y; }
  void SetZ(Real z) { m_fZ = z; }
  void Set(Real w, Real x, Real y, Real z) {
    m_fW = w;
    m_fX = x;
    m_fY = y;
    m_fZ = z;
  }

  CQuaternion Conjugate() const { return CQuaternion(m_fW, -m_fX, -m_fY, -m_fZ); }
  /// Of a quaternion of length 1.
  CQuaternion Inverse() const { return Conjugate(); }
  Real SquareLength() const { return m_fW * m_fW + m_fX * m_fX + m_fY * m_fY + m_fZ * m_fZ; }
  Real Length() const { return std::sqrt(SquareLength()); }
  CQuaternion& Normalize() {
    const Real scale = 1.0 / Length();
    Set(m_fW * scale, m_fX * scale, m_fY * scale, m_fZ * scale);
    return *this;
  }

  /// `axis` has the length 1.
  CQuaternion& FromAngleAxis(const CRadians& angle, const CVector3& axis) {
    const Real s = Sin(angle * 0.5);
    Set(Cos(angle * 0.5), s * axis.GetX(), s * axis.GetY(), s * axis.GetZ());
    return *this;
  }
  /// Without a rotation: 0 about Z.
  void ToAngleAxis(CRadians& angle, CVector3& axis) const {
    const Real s = std::sqrt(m_fX * m_fX + m_fY * m_fY + m_fZ * m_fZ);
    if (s > 0.0) {
      angle = 2.0 * ATan2(s, m_fW);
      axis.Set(m_fX / s, m_fY / s, m_fZ / s);
    } else {
      angle = CRadians();
      axis.Set(0.0, 0.0, 1.0);
    }
  }
  /// Turns about z first, then about the new y, then about the new x.
  CQuaternion& FromEulerAngles(const CRadians& z, const CRadians& y, const CRadians& x);
  void ToEulerAngles(CRadians& z, CRadians& y, CRadians& x) const;
  /// The shortest rotation that turns `from` into the direction of `to`.
  CQuaternion& BetweenTwoVectors(const CVector3& from, const CVector3& to);

  bool operator==(const CQuaternion& q) const {
    return m_fW == q.m_fW && m_fX == q.m_fX && m_fY == q.m_fY && m_fZ == q.m_fZ;
  }
  bool operator!=(const CQuaternion& q) const { return !(*this == q); }
  CQuaternion& operator+=(const CQuaternion& q) {
    Set(m_fW + q.m_fW, m_fX + q.m_fX, m_fY + q.m_fY, m_fZ + q.m_fZ);
    return *this;
  }
  CQuaternion& operator-=(const CQuaternion& q) {
    Set(m_fW - q.m_fW, m_fX - q.m_fX, m_fY - q.m_fY, m_fZ - q.m_fZ);
    return *this;
  }
  /// The rotation by `q`, then by what it was.
  CQuaternion& operator*=(const CQuaternion& q) {
    Set(m_fW * q.m_fW - m_fX * q.m_fX - m_fY * q.m_fY - m_fZ * q.m_fZ,
        m_fW * q.m_fX + m_fX * q.m_fW + m_fY * q.m_fZ - m_fZ * q.m_fY,
        m_fW * q.m_fY - m_fX * q.m_fZ + m_fY * q.m_fW + m_fZ * q.m_fX,
        m_fW * q.m_fZ + m_fX * q.m_fY - m_fY * q.m_fX + m_fZ * q.m_fW);
    return *this;
  }
  CQuaternion operator+(const CQuaternion& q) const { return CQuaternion(*this) += q; }
  CQuaternion operator-(const CQuaternion& q) const { return CQuaternion(*this) -= q; }
  CQuaternion operator*(const CQuaternion& q) const { return CQuaternion(*this) *= q; }
  operator CRotationMatrix3() const;

  friend std::ostream& operator<<(std::ostream& out, const CQuaternion& q) {
    CRadians z, y, x;
    q.ToEulerAngles(z, y, x);
    return out << ToDegrees(z).GetValue() << "," << ToDegrees(y).GetValue() << "," << ToDegrees(x).GetValue();
  }
  friend std::istream& operator>>(std::istream& in, CQuaternion& q) {
    Real zyx[3];
    ParseValues<Real>(in, 3, zyx, ',');
    q.FromEulerAngles(ToRadians(CDegrees(zyx[0])), ToRadians(CDegrees(zyx[1])), ToRadians(CDegrees(zyx[2])));
    return in;
  }

 private:
  Real m_fW, m_fX, m_fY, m_fZ;
};

}  // namespace argos

#endif
