// Planes in space.
#ifndef TANDEM_ARGOS3_PLANE_H
#define TANDEM_ARGOS3_PLANE_H
#include <argos3/core/utility/math/vector3.h>

namespace argos {

class CRay3;

/// A point and a normal.
class CPlane {
 public:
  CPlane() : m_cNormal(0.0, 0.0, 1.0) {}
  CPlane(const CVector3& position, const CVector3& normal) : m_cPosition(position), m_cNormal(normal) {}
  CPlane(const CVector3& a, const CVector3& b, const CVector3& c) { SetFromThreePoints(a, b, c); }

  const CVector3& GetPosition() const { return m_cPosition; }
  void SetPosition(const CVector3& position) { m_cPosition = position; }
  const CVector3& GetNormal() const { return m_cNormal; }
  void SetNormal(const CVector3& normal) { m_cNormal = normal; }
  void SetFromThreePoints(const CVector3& a, const CVector3& b, const CVector3& c);
  /// `t`: where on the ray, when it does.
  bool Intersects(Real& t, const CRay3& ray) const;

 private:
  CVector3 m_cPosition, m_cNormal;
};

}  // namespace argos

#endif
