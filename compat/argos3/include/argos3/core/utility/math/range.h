// Intervals of ordered values.
#ifndef TANDEM_ARGOS3_RANGE_H
#define TANDEM_ARGOS3_RANGE_H
#include <iostream>

#include <argos3/core/utility/configuration/argos_exception.h>
#include <argos3/core/utility/datatypes/datatypes.h>
#include <argos3/core/utility/string_utilities.h>

namespace argos {

/// In text "min:max".
template <typename T>
class CRange {
 public:
  CRange(const T& min = T(), const T& max = T()) : m_tMin(min), m_tMax(max) { Check(); }

  T GetMin() const { return m_tMin; }
  T GetMax() const { return m_tMax; }
  T GetSpan() const { return m_tMax - m_tMin; }
  void SetMin(const T& min) { Set(min, m_tMax); }
  void SetMax(const T& max) { Set(m_tMin, max); }
  void Set(const T& min, const T& max) {
    m_tMin = min;
    m_tMax = max;
    Check();
  }

  bool WithinMinBoundIncludedMaxBoundIncluded(const T& v) const { return m_tMin <= v && v <= m_tMax; }
  bool WithinMinBoundIncludedMaxBoundExcluded(const T& v) const { return m_tMin <= v && v < m_tMax; }
  bool WithinMinBoundExcludedMaxBoundIncluded(const T& v) const { return m_tMin < v && v <= m_tMax; }
  bool WithinMinBoundExcludedMaxBoundExcluded(const T& v) const { return m_tMin < v && v < m_tMax; }

  void TruncValue(T& v) const {
    if (m_tMax < v) v = m_tMax;
    if (v < m_tMin) v = m_tMin;
  }
  /// Where `v` lies in the interval, 0 to 1.
  Real NormalizeValue(const T& v) const {
    T inside(v);
    TruncValue(inside);
    return static_cast<Real>(inside - m_tMin) / static_cast<Real>(GetSpan());
  }
  template <typename U>
  void MapValueIntoRange(U& out, const T& v, const CRange<U>& range) const {
    out = static_cast<U>(NormalizeValue(v) * range.GetSpan() + range.GetMin());
  }
  /// Adds or takes away whole spans until `v` lies inside.
  void WrapValue(T& v) const {
    const T span(m_tMax - m_tMin);
    while (v > m_tMax) v -= span;
    while (v < m_tMin) v += span;
  }

  friend std::ostream& operator<<(std::ostream& out, const CRange& range) {
    return out << range.m_tMin << ":" << range.m_tMax;
  }
  friend std::istream& operator>>(std::istream& in, CRange& range) {
    T bounds[2];
    ParseValues<T>(in, 2, bounds, ':');
    range.Set(bounds[0], bounds[1]);
    return in;
  }

 private:
  void Check() const {
    ARGOS_ASSERT(m_tMin <= m_tMax, "the range " << m_tMin << ":" << m_tMax << " ends before it begins")
  }

  T m_tMin;
  T m_tMax;
};

}  // namespace argos

#endif
