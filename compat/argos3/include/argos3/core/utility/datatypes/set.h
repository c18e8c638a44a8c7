// Ordered lists without doubles.
#ifndef TANDEM_ARGOS3_SET_H
#define TANDEM_ARGOS3_SET_H
#include <algorithm>
#include <functional>
#include <vector>

#include <argos3/core/utility/datatypes/datatypes.h>

namespace argos {

/// Of the smallest first.
template <class T, class C = std::less<T> >
class CSet {
 public:
  typedef T value_type;
  typedef typename std::vector<T>::iterator iterator;
  typedef typename std::vector<T>::const_iterator const_iterator;

  bool empty() const { return m_vecElements.empty(); }
  size_t size() const { return m_vecElements.size(); }
  T& first() { return m_vecElements.front(); }
  const T& first() const { return m_vecElements.front(); }
  T& last() { return m_vecElements.back(); }
  const T& last() const { return m_vecElements.back(); }
  void clear() { m_vecElements.clear(); }
  void insert(const T& element) {
    const iterator at = Place(element);
    if (at == m_vecElements.end() || C()(element, *at)) m_vecElements.insert(at, element);
  }
  void erase(const T& element) {
    const iterator at = find(element);
    if (at != m_vecElements.end()) m_vecElements.erase(at);
  }
  void erase(iterator& at) { at = m_vecElements.erase(at); }
  bool exists(const T& element) const { return const_cast<CSet*>(this)->find(element) != const_cast<CSet*>(this)->end(); }
  iterator begin() { return m_vecElements.begin(); }
  iterator end() { return m_vecElements.end(); }
  const_iterator begin() const { return m_vecElements.begin(); }
  const_iterator end() const { return m_vecElements.end(); }
  iterator find(const T& element) {
    const iterator at = Place(element);
    return at != m_vecElements.end() && !C()(element, *at) ? at : m_vecElements.end();
  }

 private:
  iterator Place(const T& element) {
    return std::lower_bound(m_vecElements.begin(), m_vecElements.end(), element, C());
  }
  std::vector<T> m_vecElements;
};

}  // namespace argos

#endif
