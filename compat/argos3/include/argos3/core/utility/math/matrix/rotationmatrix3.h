// Rotations of space as matrices.
#ifndef TANDEM_ARGOS3_ROTATIONMATRIX3_H
#define TANDEM_ARGOS3_ROTATIONMATRIX3_H
#include <argos3/core/utility/math/angles.h>
#include <argos3/core/utility/math/matrix/squarematrix.h>
#include <argos3/core/utility/math/vector3.h>

namespace argos {

class CQuaternion;

class CRotationMatrix3 : public CSquareMatrix<3> {
 public:
  CRotationMatrix3() { SetIdentityMatrix(); }
  CRotationMatrix3(const CMatrix<3, 3>& matrix) : CSquareMatrix<3>(matrix) {}
  CRotationMatrix3(const CRadians& z, const CRadians& y, const CRadians& x) { SetFromAngles(x, y, z); }
  CRotationMatrix3(Real a, Real b, Real c, Real d, Real e, Real f, Real g, Real h, Real i) {
    SetFromValues(a, b, c, d, e, f, g, h, i);
  }

  void SetFromMatrix(const CMatrix<3, 3>& matrix) { CMatrix<3, 3>::operator=(matrix); }
  /// As CQuaternion::FromEulerAngles.
  void SetFromAngles(const CRadians& x, const CRadians& y, const CRadians& z);
  void SetFromValues(Real a, Real b, Real c, Real d, Real e, Real f, Real g, Real h, Real i) {
    const Real all[] = {a, b, c, d, e, f, g, h, i};
    Set(all);
  }
  operator CQuaternion() const;
  using CMatrix<3, 3>::operator*;
  CVector3 operator*(const CVector3& v) const {
    const CRotationMatrix3& m = *this;
    return CVector3(m(0) * v.GetX() + m(1) * v.GetY() + m(2) * v.GetZ(), m(3) * v.GetX() + m(4) * v.GetY() + m(5) * v.GetZ(),
                    m(6) * v.GetX() + m(7) * v.GetY() + m(8) * v.GetZ());
  }
};

}  // namespace argos

#endif
