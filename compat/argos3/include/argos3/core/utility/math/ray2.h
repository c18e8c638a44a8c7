// Pieces of straight lines in a plane.
#ifndef TANDEM_ARGOS3_RAY2_H
#define TANDEM_ARGOS3_RAY2_H
#include <cmath>
#include <iostream>

#include <argos3/core/utility/math/vector2.h>

namespace argos {

/// From a start to an end; t = 0 is the start, 1 the end.
class CRay2 {
 public:
  CRay2() {}
  CRay2(const CVector2& start, const CVector2& end) : m_cStart(start), m_cEnd(end) {}
  CRay2(const CVector2& start, const CVector2& direction, Real length) { Set(start, direction, length); }

  const CVector2& GetStart() const { return m_cStart; }
  const CVector2& GetEnd() const { return m_cEnd; }
  void SetStart(const CVector2& start) { m_cStart = start; }
  void SetEnd(const CVector2& end) { m_cEnd = end; }
  void Set(const CVector2& start, const CVector2& end) {
    m_cStart = start;
    m_cEnd = end;
  }
  /// `direction` has the length 1.
  void Set(const CVector2& start, const CVector2& direction, Real length) { Set(start, start + direction * length); }

  void GetDirection(CVector2& buffer) const { buffer = (m_cEnd - m_cStart).Normalize(); }
  void GetInverseDirection(CVector2& buffer) const { buffer = (m_cStart - m_cEnd).Normalize(); }
  Real GetLength() const { return (m_cEnd - m_cStart).Length(); }
  void ToVector(CVector2& buffer) const {
    buffer = m_cEnd - m_cStart;
  }
  void GetPoint(CVector2& point, Real t) const { point = m_cStart + (m_cEnd - m_cStart) * t; }
  /// From the start to the point of t.
  Real GetDistance(Real t) const { return std::fabs(t) * GetLength(); }
  /// False for parallel ones.
  bool Intersects(const CRay2& ray) const {
    const CVector2 mine = m_cEnd - m_cStart, other = ray.m_cEnd - ray.m_cStart, between = ray.m_cStart - m_cStart;
    const Real cross = mine.CrossProduct(other);
    if (std::fabs(cross) < 1e-12) return false;
    const Real here = between.CrossProduct(other) / cross, there = between.CrossProduct(mine) / cross;
    return here >= 0.0 && here <= 1.0 && there >= 0.0 && there <= 1.0;
  }

  friend std::ostream& operator<<(std::ostream& out, const CRay2& ray) {
    return out << ray.m_cStart << " -> " << ray.m_cEnd;
  }

 private:
  CVector2 m_cStart, m_cEnd;
};

}  // namespace argos

#endif
