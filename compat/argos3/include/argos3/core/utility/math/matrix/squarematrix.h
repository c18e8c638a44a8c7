// Square matrices.
#ifndef TANDEM_ARGOS3_SQUAREMATRIX_H
#define TANDEM_ARGOS3_SQUAREMATRIX_H
#include <cmath>

#include <argos3/core/utility/math/matrix/matrix.h>

namespace argos {

template <UInt32 DIM>
class CSquareMatrix : public CMatrix<DIM, DIM> {
 public:
  CSquareMatrix() {}
  CSquareMatrix(const CMatrix<DIM, DIM>& other) : CMatrix<DIM, DIM>(other) {}
  CSquareMatrix(const Real* values) : CMatrix<DIM, DIM>(values) {}

  void SetIdentityMatrix() {
    this->SetZero();
    for (UInt32 i = 0; i < DIM; ++i) (*this)(i, i) = 1.0;
  }
  bool IsIdentity() const {
    CSquareMatrix identity;
    identity.SetIdentityMatrix();
    return *this == identity;
  }
  /// By elimination.
  Real GetDeterminant() const {
    CMatrix<DIM, DIM> m(*this);
    Real determinant = 1.0;
    for (UInt32 c = 0; c < DIM; ++c) {
      UInt32 pivot = c;
      for (UInt32 r = c + 1; r < DIM; ++r)
        if (std::fabs(m(r, c)) > std::fabs(m(pivot, c))) pivot = r;
      if (m(pivot, c) == 0.0) return 0.0;
      if (pivot != c) {
        for (UInt32 k = 0; k < DIM; ++k) std::swap(m(c, k), m(pivot, k));
        determinant = -determinant;
      }
      determinant *= m(c, c);
      for (UInt32 r = c + 1; r < DIM; ++r) {
        const Real factor = m(r, c) / m(c, c);
        for (UInt32 k = c; k < DIM; ++k) m(r, k) -= factor * m(c, k);
      }
    }
    return determinant;
  }
};

}  // namespace argos

#endif
