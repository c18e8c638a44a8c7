// Rotations of a plane as matrices.
#ifndef TANDEM_ARGOS3_ROTATIONMATRIX2_H
#define TANDEM_ARGOS3_ROTATIONMATRIX2_H
#include <argos3/core/utility/math/angles.h>
#include <argos3/core/utility/math/matrix/squarematrix.h>
#include <argos3/core/utility/math/vector2.h>

namespace argos {

class CRotationMatrix2 : public CSquareMatrix<2> {
 public:
  CRotationMatrix2() { SetIdentityMatrix(); }
  CRotationMatrix2(const CMatrix<2, 2>& matrix) : CSquareMatrix<2>(matrix) {}
  CRotationMatrix2(const CRadians& angle) { SetFromAngle(angle); }
  CRotationMatrix2(Real a, Real b, Real c, Real d) { SetFromValues(a, b, c, d); }

  void SetFromMatrix(const CMatrix<2, 2>& matrix) { CMatrix<2, 2>::operator=(matrix); }
  void SetFromAngle(const CRadians& angle) { SetFromValues(Cos(angle), -Sin(angle), Sin(angle), Cos(angle)); }
  void SetFromValues(Real a, Real b, Real c, Real d) {
    const Real all[] = {a, b, c, d};
    Set(all);
  }
  using CMatrix<2, 2>::operator*;
  CVector2 operator*(const CVector2& v) const {
    return CVector2((*this)(0) * v.GetX() + (*this)(1) * v.GetY(), (*this)(2) * v.GetX() + (*this)(3) * v.GetY());
  }
};

}  // namespace argos

#endif
