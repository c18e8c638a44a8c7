// Intervals of ordered values.
#ifndef TANDEM_ARGOS3_RANGE_H
#define TANDEM_ARGOS3_RANGE_H
#include <cmath>
#include <iostream>
#include <type_traits>

#include <argos3/core/utility/configuration/argos_exception.h>
#include <argos3/core/utility/datatypes/datatypes.h>
#include <argos3/core/utility/string_utilities.h>

namespace argos {

namespace tandem_detail {

/// a / b as a number, also of angles; 0 where b is 0.
template <typename T>
typename std::enable_if<std::is_arithmetic<T>::value, Real>::type Ratio(const T& a, const T& b) {
  return b == T(0) ? 0.0 : static_cast<Real>(a) / static_cast<Real>(b);
}
template <typename T>
typename std::enable_if<!std::is_arithmetic<T>::value, Real>::type Ratio(const T& a, const T& b) {
  return b == T() ? 0.0 : a / b;
}

}  // namespace tandem_detail

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
  /// Where `v` lies in the interval, 0 to 1; 0 in one without length.
  Real NormalizeValue(const T& v) const {
    T inside(v);
    TruncValue(inside);
    return tandem_detail::Ratio<T>(inside - m_tMin, GetSpan());
  }
  template <typename U>
  void MapValueIntoRange(U& out, const T& v, const CRange<U>& range) const {
    out = static_cast<U>(NormalizeValue(v) * range.GetSpan() + range.GetMin());
  }
  /// Adds or takes away whole spans until `v` lies inside. Nothing where that leads nowhere: without a span, or of a
  /// value that is not finite.
  void WrapValue(T& v) const {
    if (WithinMinBoundIncludedMaxBoundIncluded(v)) return;
    const bool above = m_tMax < v;
    const Real spans = std::ceil(above ? tandem_detail::Ratio<T>(v - m_tMax, GetSpan())
                                       : tandem_detail::Ratio<T>(m_tMin - v, GetSpan()));
    if (!(spans > 0.0 && std::isfinite(spans))) return;
    const T way = static_cast<T>(spans * GetSpan());
    v = above ? v - way : v + way;
    TruncValue(v);  // rounding
  }

  bool operator==(const CRange& other) const { return m_tMin == other.m_tMin && m_tMax == other.m_tMax; }
  bool operator!=(const CRange& other) const { return !(*this == other); }

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
