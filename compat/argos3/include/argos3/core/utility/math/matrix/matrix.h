// Small matrices.
#ifndef TANDEM_ARGOS3_MATRIX_H
#define TANDEM_ARGOS3_MATRIX_H
#include <algorithm>
#include <iostream>

#include <argos3/core/utility/configuration/argos_exception.h>
#include <argos3/core/utility/datatypes/datatypes.h>
#include <argos3/core/utility/math/general.h>

namespace argos {

/// Row by row. A new one holds zeros.
template <UInt32 ROWS, UInt32 COLS>
class CMatrix {
 public:
  CMatrix() { SetZero(); }
  CMatrix(const Real* values) { Set(values); }
  CMatrix(const CMatrix&) = default;
  CMatrix& operator=(const CMatrix&) = default;

  Real& operator()(UInt32 row, UInt32 column) { return m_pfValues[Index(row, column)]; }
  Real operator()(UInt32 row, UInt32 column) const { return m_pfValues[Index(row, column)]; }
  Real& operator()(UInt32 i) { return m_pfValues[i]; }
  Real operator()(UInt32 i) const { return m_pfValues[i]; }

  void Set(const Real* values) { std::copy(values, values + ROWS * COLS, m_pfValues); }
  void SetZero() { std::fill(m_pfValues, m_pfValues + ROWS * COLS, 0.0); }
  CMatrix<COLS, ROWS> GetTransposed() const {
    CMatrix<COLS, ROWS> out;
    for (UInt32 i = 0; i < ROWS; ++i)
      for (UInt32 j = 0; j < COLS; ++j) out(j, i) = (*this)(i, j);
    return out;
  }
  template <UInt32 SMROWS, UInt32 SMCOLS>
  void GetSubMatrix(CMatrix<SMROWS, SMCOLS>& part, UInt32 first_row, UInt32 first_column) const {
    for (UInt32 i = 0; i < SMROWS; ++i)
      for (UInt32 j = 0; j < SMCOLS; ++j) part(i, j) = (*this)(first_row + i, first_column + j);
  }

  bool operator==(const CMatrix& other) const {
    for (UInt32 i = 0; i < ROWS * COLS; ++i)
      if (!DoubleEq(m_pfValues[i], other.m_pfValues[i])) return false;
    return true;
  }
  bool operator!=(const CMatrix& other) const { return !(*this == other); }
  CMatrix& operator+=(const CMatrix& other) {
    for (UInt32 i = 0; i < ROWS * COLS; ++i) m_pfValues[i] += other.m_pfValues[i];
    return *this;
  }
  CMatrix& operator-=(const CMatrix& other) {
    for (UInt32 i = 0; i < ROWS * COLS; ++i) m_pfValues[i] -= other.m_pfValues[i];
    return *this;
  }
  CMatrix& operator*=(Real factor) {
    for (UInt32 i = 0; i < ROWS * COLS; ++i) m_pfValues[i] *= factor;
    return *this;
  }
  CMatrix& operator*=(const CMatrix<COLS, COLS>& other) { return *this = *this * other; }
  CMatrix operator+(const CMatrix& other) const { return CMatrix(*this) += other; }
  CMatrix operator-(const CMatrix& other) const { return CMatrix(*this) -= other; }
  CMatrix operator-() const { return CMatrix(*this) *= -1.0; }
  template <UInt32 OTHER>
  CMatrix<ROWS, OTHER> operator*(const CMatrix<COLS, OTHER>& other) const {
    CMatrix<ROWS, OTHER> out;
    for (UInt32 i = 0; i < ROWS; ++i)
      for (UInt32 j = 0; j < OTHER; ++j)
        for (UInt32 k = 0; k < COLS; ++k) out(i, j) += (*this)(i, k) * other(k, j);
    return out;
  }

  friend std::ostream& operator<<(std::ostream& out, const CMatrix& matrix) {
    for (UInt32 i = 0; i < ROWS * COLS; ++i)
      out << matrix.m_pfValues[i] << ((i + 1) % COLS == 0 ? "\n" : " ");
    return out;
  }

 protected:
  UInt32 Index(UInt32 row, UInt32 column) const {
    ARGOS_ASSERT(row < ROWS && column < COLS, "no element " << row << "," << column << " in a matrix of " << ROWS << " by " << COLS)
    return row * COLS + column;
  }
  Real m_pfValues[ROWS * COLS];
};

}  // namespace argos

#endif
