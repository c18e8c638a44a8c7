// Constants and longer functions of the facade's geometry.
#include <argos3/core/utility/math/plane.h>
#include <argos3/core/utility/math/quaternion.h>
#include <argos3/core/utility/math/ray3.h>
#include <cmath>

namespace argos {

constinit const CRadians CRadians::PI{ARGOS_PI};
constinit const CRadians CRadians::TWO_PI{2.0 * ARGOS_PI};
constinit const CRadians CRadians::PI_OVER_TWO{ARGOS_PI / 2.0};
constinit const CRadians CRadians::PI_OVER_THREE{ARGOS_PI / 3.0};
constinit const CRadians CRadians::PI_OVER_FOUR{ARGOS_PI / 4.0};
constinit const CRadians CRadians::PI_OVER_SIX{ARGOS_PI / 6.0};
constinit const CRadians CRadians::ZERO{};
const CRange<CRadians> CRadians::SIGNED_RANGE(CRadians(-ARGOS_PI), CRadians(ARGOS_PI));
const CRange<CRadians> CRadians::UNSIGNED_RANGE(CRadians(0.0), CRadians(2.0 * ARGOS_PI));
constinit const Real CRadians::RADIANS_TO_DEGREES = 180.0 / ARGOS_PI;

constinit const CVector2 CVector2::X{1.0, 0.0};
constinit const CVector2 CVector2::Y{0.0, 1.0};
constinit const CVector2 CVector2::ZERO{};
constinit const CVector3 CVector3::X{1.0, 0.0, 0.0};
constinit const CVector3 CVector3::Y{0.0, 1.0, 0.0};
constinit const CVector3 CVector3::Z{0.0, 0.0, 1.0};
constinit const CVector3 CVector3::ZERO{};

CVector3& CVector3::Rotate(const CQuaternion& q) {
  const CQuaternion turned = q * CQuaternion(0.0, m_fX, m_fY, m_fZ) * q.Conjugate();
  Set(turned.GetX(), turned.GetY(), turned.GetZ());
  return *this;
}

CQuaternion& CQuaternion::FromEulerAngles(const CRadians& z, const CRadians& y, const CRadians& x) {
  return *this = CQuaternion(z, CVector3::Z) * CQuaternion(y, CVector3::Y) * CQuaternion(x, CVector3::X);
}

void CQuaternion::ToEulerAngles(CRadians& z, CRadians& y, CRadians& x) const {
  const Real sine = 2.0 * (m_fW * m_fY - m_fX * m_fZ);
  y = ASin(sine);
  if (std::fabs(sine) < 1.0 - 1e-12) {
    z = ATan2(2.0 * (m_fW * m_fZ + m_fX * m_fY), 1.0 - 2.0 * (m_fY * m_fY + m_fZ * m_fZ));
    x = ATan2(2.0 * (m_fW * m_fX + m_fY * m_fZ), 1.0 - 2.0 * (m_fX * m_fX + m_fY * m_fY));
  } else {  // z and x turn about the same axis: all of it is z's
    z = 2.0 * ATan2(m_fZ, m_fW);
    z.SignedNormalize();
    x = CRadians();
  }
}

CQuaternion& CQuaternion::BetweenTwoVectors(const CVector3& from, const CVector3& to) {
  const Real lengths = from.Length() * to.Length();
  const Real cosine = from.DotProduct(to);
  if (cosine <= -lengths * (1.0 - 1e-12)) {  // opposite: half a turn about any axis across
    CVector3 axis =
        CVector3(from).CrossProduct(std::fabs(from.GetX()) < 0.5 * from.Length() ? CVector3::X : CVector3::Y);
    return FromAngleAxis(CRadians::PI, axis.Normalize());
  }
  const CVector3 across = CVector3(from).CrossProduct(to);
  Set(lengths + cosine, across.GetX(), across.GetY(), across.GetZ());
  return Normalize();
}

CQuaternion::operator CRotationMatrix3() const {
  const CVector3 x = CVector3(CVector3::X).Rotate(*this), y = CVector3(CVector3::Y).Rotate(*this),
                 z = CVector3(CVector3::Z).Rotate(*this);
  return CRotationMatrix3(x.GetX(), y.GetX(), z.GetX(), x.GetY(), y.GetY(), z.GetY(), x.GetZ(), y.GetZ(), z.GetZ());
}

void CRotationMatrix3::SetFromAngles(const CRadians& x, const CRadians& y, const CRadians& z) {
  *this = CQuaternion().FromEulerAngles(z, y, x);
}

CRotationMatrix3::operator CQuaternion() const {
  const CRotationMatrix3& m = *this;
  CRadians z = ATan2(m(3), m(0)), y = ASin(-m(6)), x = ATan2(m(7), m(8));
  if (std::fabs(m(6)) >= 1.0 - 1e-12) {
    z = ATan2(-m(1), m(4));
    x = CRadians();
  }
  return CQuaternion().FromEulerAngles(z, y, x);
}

void CPlane::SetFromThreePoints(const CVector3& a, const CVector3& b, const CVector3& c) {
  m_cPosition = a;
  m_cNormal = (b - a).CrossProduct(c - a).Normalize();
}

bool CPlane::Intersects(Real& t, const CRay3& ray) const {
  const Real along = m_cNormal.DotProduct(ray.GetEnd() - ray.GetStart());
  if (along == 0.0) return false;
  t = m_cNormal.DotProduct(m_cPosition - ray.GetStart()) / along;
  return t >= 0.0 && t <= 1.0;
}

bool CRay3::Intersects(const CPlane& plane, CVector3& point) const {
  Real t = 0.0;
  if (!plane.Intersects(t, *this)) return false;
  GetPoint(point, t);
  return true;
}

}  // namespace argos
