// Places and headings in a plane.
#ifndef TANDEM_ARGOS3_POSE2_H
#define TANDEM_ARGOS3_POSE2_H
#include <iostream>

#include <argos3/core/utility/math/vector2.h>

namespace argos {

class CPose2 {
 public:
  CPose2() {}
  CPose2(const CVector2& position, const CRadians& orientation) : m_cPosition(position), m_cOrientation(orientation) {}
  CPose2(Real x, Real y, Real heading) : m_cPosition(x, y), m_cOrientation(heading) {}

  const CVector2& GetPosition() const { return m_cPosition; }
  const CRadians& GetOrientation() const { return m_cOrientation; }
  void Rotate(const CRadians& angle) { m_cOrientation += angle; }
  /// By an offset in its own frame.
  void Translate(const CVector2& offset) { m_cPosition = *this * offset; }
  CVector2 operator*(const CVector2& point) const { return m_cPosition + CVector2(point).Rotate(m_cOrientation); }
  bool operator==(const CPose2& p) const { return m_cPosition == p.m_cPosition && m_cOrientation == p.m_cOrientation; }
  bool operator!=(const CPose2& p) const { return !(*this == p); }

  friend std::ostream& operator<<(std::ostream& out, const CPose2& p) {
    return out << "Position(" << p.m_cPosition << ") Orientation(" << p.m_cOrientation << ")";
  }

 private:
  CVector2 m_cPosition;
  CRadians m_cOrientation;
};

}  // namespace argos

#endif
