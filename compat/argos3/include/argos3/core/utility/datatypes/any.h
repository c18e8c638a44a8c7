// A value of any type.
#ifndef TANDEM_ARGOS3_ANY_H
#define TANDEM_ARGOS3_ANY_H
#include <memory>
#include <typeinfo>

#include <argos3/core/utility/configuration/argos_exception.h>

namespace argos {

class CAny {
 public:
  CAny() {}
  template <typename T>
  CAny(const T& value) : m_pcHeld(new SHeld<T>(value)) {}
  CAny(const CAny& other) : m_pcHeld(other.m_pcHeld ? other.m_pcHeld->Clone() : nullptr) {}
  template <typename T>
  CAny& operator=(const T& value) {
    m_pcHeld.reset(new SHeld<T>(value));
    return *this;
  }
  CAny& operator=(const CAny& other) {
    if (this != &other) m_pcHeld.reset(other.m_pcHeld ? other.m_pcHeld->Clone() : nullptr);
    return *this;
  }
  CAny& swap(CAny& other) {
    m_pcHeld.swap(other.m_pcHeld);
    return *this;
  }
  /// Null when it holds something else.
  template <typename T>
  T* Get() const {
    SHeld<T>* const held = dynamic_cast<SHeld<T>*>(m_pcHeld.get());
    return held == nullptr ? nullptr : &held->Value;
  }

 private:
  struct SAnything {
    virtual ~SAnything() {}
    virtual SAnything* Clone() const = 0;
  };
  template <typename T>
  struct SHeld : SAnything {
    explicit SHeld(const T& value) : Value(value) {}
    SAnything* Clone() const override { return new SHeld(Value); }
    T Value;
  };
  std::unique_ptr<SAnything> m_pcHeld;
};

/// @throws CARGoSException when it holds something else
template <typename T>
T& any_cast(const CAny& any) {
  T* const value = any.Get<T>();
  if (value == nullptr) THROW_ARGOSEXCEPTION("a CAny does not hold a " << typeid(T).name())
  return *value;
}

}  // namespace argos

#endif
