// Pieces of straight lines in space.
#ifndef TANDEM_ARGOS3_RAY3_H
#define TANDEM_ARGOS3_RAY3_H
#include <cmath>
#include <iostream>

#include <argos3/core/utility/math/vector3.h>

namespace argos {

class CPlane;

/// From a start to an end; t = 0 is the start, 1 the end.
class CRay3 {
 public:
  CRay3() {}
  CRay3(const CVector3& start, const CVector3& end) : m_cStart(start), m_cEnd(end) {}
  CRay3(const CVector3& start, const CVector3& direction, Real length) { Set(start, direction, length); }

  const CVector3& GetStart() const { return m_cStart; }
  const CVector3& GetEnd() const { return m_cEnd; }
  CVector3& GetStart() { return m_cStart; }
  CVector3& GetEnd() { return m_cEnd; }
  void SetLength(Real length) {
    CVector3 direction;
    GetDirection(direction);
    Set(m_cStart, direction, length);
  }
  void SetStart(const CVector3& start) { m_cStart = start; }
  void SetEnd(const CVector3& end) { m_cEnd = end; }
  void Set(const CVector3& start, const CVector3& end) {
    m_cStart = start;
    m_cEnd = end;
  }
  /// `direction` has the length 1.
  void Set(const CVector3& start, const CVector3& direction, Real length) { Set(start, start + direction * length); }

  void GetDirection(CVector3& buffer) const { buffer = (m_cEnd - m_cStart).Normalize(); }
  void GetInverseDirection(CVector3& buffer) const { buffer = (m_cStart - m_cEnd).Normalize(); }
  Real GetLength() const { return (m_cEnd - m_cStart).Length(); }
  CVector3& ToVector(CVector3& buffer) const {
    buffer = m_cEnd - m_cStart;
    return buffer;
  }
  void GetPoint(CVector3& point, Real t) const { point = m_cStart + (m_cEnd - m_cStart) * t; }
  /// From the start to the point of t.
  Real GetDistance(Real t) const { return std::fabs(t) * GetLength(); }
  /// `point`: where, when it does.
  bool Intersects(const CPlane& plane, CVector3& point) const;

  friend std::ostream& operator<<(std::ostream& out, const CRay3& ray) {
    return out << ray.m_cStart << " -> " << ray.m_cEnd;
  }

 private:
  CVector3 m_cStart, m_cEnd;
};

}  // namespace argos

#endif
